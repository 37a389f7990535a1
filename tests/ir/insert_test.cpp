// Functions between others: whatever named a function names it still.
#include "ir/insert.h"
#include "ir/packings.h"

#include <catch2/catch.hpp>

namespace lobe::tests {
namespace {

using ir::FunctionId;

ir::Function constant(const std::string& name)
{
    ir::Function function;
    function.name = name;
    function.result = function.graph.literal("1");
    return function;
}

/// Two calls that differ in nothing but what they call, and a name.
ir::Function caller(const std::string& name, FunctionId a, FunctionId b)
{
    ir::Function function;
    function.name = name;
    const auto first = function.graph.call(a, ir::Type::scalar, {});
    function.graph.set_name(first, "first");
    const auto second = function.graph.call(b, ir::Type::scalar, {});
    function.result = function.graph.apply(ir::Op::subtract, {first, second});
    return function;
}

/// Everything in a module that names a function, by the name of the function.
std::vector<std::string> references(const ir::Module& module)
{
    std::vector<std::string> result;
    const auto add = [&](const std::string& what, FunctionId id) {
        result.push_back(what + ": " + (id.valid() ? module[id].name : "nothing"));
    };
    for (const ir::Function& function : module.functions) {
        if (function.name.starts_with("inserted")) continue;
        add(function.name + " is a form of", function.form_of);
        for (const ir::ExprId id : function.graph.ids())
            if (function.graph[id].op == ir::Op::call)
                add(function.name + " calls as '" + function.graph.name_of(id) + "'",
                    FunctionId{function.graph[id].aux});
    }
    for (const ir::Effect& effect : module.effects) add("off when", effect.off_when);
    for (const ir::Model& model : module.models)
        for (const auto& output : model.outputs) add("output", output.function);
    for (const ir::Packing& packing : module.packings) {
        for (const auto& output : packing.model.outputs) add("packed output", output.function);
        for (const ir::Field& field : packing.fields) {
            add("code's encode", field.code.encode);
            add("code's decode", field.code.decode);
            add("encode", field.encode);
            add("decode", field.decode);
        }
        for (const auto& channel : packing.channels) add("pack", channel.pack);
        for (const auto& parameter : packing.parameters) add("unpack", parameter.unpack);
    }
    return result;
}

}  // namespace

TEST_CASE("a function between others moves everything that names a function", "[ir]")
{
    ir::Module module;
    module.name = "m";
    module.parameters = {scalar("gain", {0, 1}, 1)};
    module.functions = {constant("one"), constant("other")};
    module.functions.push_back(constant("form"));
    module.functions.back().kind = ir::Function::Kind::form;
    module.functions.back().form_of = FunctionId{1};
    module.functions.push_back(caller("difference", FunctionId{0}, FunctionId{1}));
    ir::Effect effect;
    effect.off_when = FunctionId{1};
    module.effects = {effect};
    ir::Model model;
    model.outputs = {{"diffuse", FunctionId{3}}};
    module.models = {model};
    ir::Field stored = field(0, 8, {0, 1});
    stored.code.encode = FunctionId{0};
    stored.code.decode = FunctionId{1};
    ir::Packing packing = laid_out(module, {stored});
    packing.model = model;
    ir::build_functions(module, packing, plain_gbuffer(1));
    module.gbuffers = {plain_gbuffer(1)};
    packing.supported = ir::Configurations(1, true);
    packing.gbuffer = module.gbuffers[0].name;
    module.packings = {packing};
    const auto before = references(module);

    std::vector<ir::Insertion> insertions;
    for (std::size_t i = 0; i < module.functions.size(); ++i)
        for (const char* copy : {"a", "b"})
            insertions.push_back({FunctionId{i}, constant("inserted" + std::to_string(i) + copy)});
    insertions[6].function = caller("inserted3a", FunctionId{0}, FunctionId{2});
    insertions[6].function.form_of = FunctionId{1};
    const ir::Module after = insert_functions(module, insertions);

    CHECK(references(after) == before);
    REQUIRE(after.functions.size() == 3 * module.functions.size());
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        CHECK(after.functions[3 * i].name == module.functions[i].name);
        CHECK(after.functions[3 * i + 1].name == "inserted" + std::to_string(i) + "a");
        CHECK(after.functions[3 * i + 2].name == "inserted" + std::to_string(i) + "b");
    }
    // What is inserted speaks of functions as they were before.
    const ir::Function& inserted = after.functions[10];
    CHECK(after[inserted.form_of].name == "other");
    const auto operands = inserted.graph.operands(inserted.result);
    CHECK(after.functions[inserted.graph[operands[0]].aux].name == "one");
    CHECK(after.functions[inserted.graph[operands[1]].aux].name == "form");
}

}  // namespace lobe::tests
