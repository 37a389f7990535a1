// The compute shader that runs one function, and nothing but it, at many points.
#include "emit/frame.h"
#include "emit/listing.h"

#include <fmt/format.h>

namespace lobe::emit {
namespace {

/// The statement that reads an input's components from the points, `at` floats into one.
std::string load(const Dialect& dialect, const ir::Input& input, const std::string& name, int at,
                 int stride, bool half)
{
    const std::string_view type = dialect.type(input.type);
    std::vector<std::string> floats;
    for (int i = 0; i < ir::components(input.type); ++i)
        floats.push_back(fmt::format("harness_points[harness_index * {}u + {}u]", stride, at + i));
    std::string value = fmt::format("{}", fmt::join(floats, ", "));
    if (input.type == ir::Type::boolean)
        value += " != 0.0";
    else if (floats.size() > 1 || half)
        value = fmt::format("{}({})", type, value);
    return fmt::format("{} {} = {};", type, name, value);
}

std::vector<Record> stores(const ir::Function& function, const std::string& result, bool half)
{
    const int count = ir::components(function.type());
    std::vector<Record> records;
    for (int i = 0; i < count; ++i) {
        std::string value = result;
        if (count > 1) value += fmt::format(".{}", "xyzw"[i]);
        if (function.type() == ir::Type::boolean)
            value += " ? 1.0 : 0.0";
        else if (half)
            value = fmt::format("float({})", value);
        records.push_back({{{"outputs", std::to_string(count)},
                            {"component", std::to_string(i)},
                            {"value", std::move(value)}},
                           {}});
    }
    return records;
}

}  // namespace

Harness harness(const ir::Module& module, const Sources& sources, ir::FunctionId function,
                const Target& target, Precision precision)
{
    const Dialect& language = dialect(target, precision);
    const bool half = precision == Precision::float16 && target.language != Language::hlsl;
    Listing listing{module,
                    sources,
                    language,
                    module.reachable({function}),
                    function_prefix(module, target),
                    {"harness_points", "harness_results", "harness_count", "harness_thread",
                     "harness_index", "harness_result", "HarnessPoints", "HarnessResults",
                     "HarnessPush"}};

    const ir::Function entry = ir::entry_point(module, function);
    Harness result;
    for (const ir::Input& input : entry.inputs) result.inputs += ir::components(input.type);
    result.outputs = ir::components(entry.type());

    Scope scope = listing.scope();
    std::vector<std::string> loads;
    int at = 0;
    for (const ir::Input& input : entry.inputs) {
        scope.inputs.push_back(scope.namer.unique(input_name(language, input)));
        loads.push_back(load(language, input, scope.inputs.back(), at, result.inputs, half));
        at += ir::components(input.type);
    }
    Record values;
    values.lists["functions"] = listing.functions();
    Body body = listing.write(scope, entry.graph, {entry.result});
    body.locals.push_back({fmt::format("{} harness_result = {};", language.type(entry.type()),
                                       body.results.front().text),
                           module[function].span});
    values.lists["loads"] = lines(loads);
    values.lists["statements"] = listing.statements(body.locals);
    values.lists["stores"] = stores(entry, "harness_result", half);
    values.lists["helpers"] = listing.helpers();

    std::string path = "harness/glsl.comp";
    if (target.language == Language::hlsl) {
        path = "harness/hlsl.hlsl";
        values.lists["prelude"] = target.name == "ue4" ? lines({unreal_prelude()}) : lines({});
    } else {
        // The text of older versions is good in the versions that have compute shaders.
        const bool es = target.language == Language::essl;
        values.texts["version"] = es ? "#version 310 es" : "#version 450";
        std::vector<std::string> extensions;
        if (half)
            extensions.emplace_back(
                "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require");
        if (es) extensions.emplace_back("precision highp float;\nprecision highp int;");
        values.lists["extensions"] = lines(extensions);
    }
    const Rendered rendered = render_embedded(path, values);
    result.artifact = {fmt::format("{}/{}/harness/{}{}", module.name, target.name,
                                   module[function].name,
                                   target.language == Language::hlsl ? ".hlsl" : ".comp"),
                       rendered.text, listing.origins(rendered.marks)};
    return result;
}

}  // namespace lobe::emit
