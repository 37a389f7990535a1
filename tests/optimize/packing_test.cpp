// What packs and unpacks comes through every pass: under its ids, with its inputs, with its values;
// and what it calls is not fitted to what the model alone passes.
#include "build.h"
#include "emit/packings.h"
#include "evaluate/run.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/specialize.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;

namespace {

double value(const Module& module, FunctionId id, const std::vector<double>& inputs,
             std::size_t component = 0)
{
    const evaluate::Tape tape = evaluate::compile(module, module[id]);
    REQUIRE(tape.inputs.size() == inputs.size());
    std::vector<const double*> in;
    for (const double& input : inputs) in.push_back(&input);
    std::vector<double> results(tape.outputs.size());
    std::vector<double*> out;
    for (double& result : results) out.push_back(&result);
    evaluate::run(tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out}, 1);
    return results[component];
}

/// Every id of a packing names the function that it named before, and signatures are as before.
void check_same_functions(const Module& before, const Module& after)
{
    const Packing& packing = after.packings[0];
    REQUIRE(packing.fields.size() == before.packings[0].fields.size());
    const auto same = [&](FunctionId id, FunctionId was) {
        CHECK(id == was);
        CHECK(after[id].name == before[id].name);
        CHECK(after[id].kind == Function::Kind::storage);
        REQUIRE(after[id].inputs.size() == before[id].inputs.size());
        for (std::size_t i = 0; i < after[id].inputs.size(); ++i) {
            CHECK(after[id].inputs[i].name == before[id].inputs[i].name);
            CHECK(after[id].inputs[i].origin == before[id].inputs[i].origin);
        }
    };
    for (std::size_t i = 0; i < packing.fields.size(); ++i) {
        same(packing.fields[i].encode, before.packings[0].fields[i].encode);
        same(packing.fields[i].decode, before.packings[0].fields[i].decode);
        for (int code = 0; code <= packing.fields[i].last_code(); ++code) {
            const double was = value(before, packing.fields[i].decode, {double(code)});
            const double is = value(after, packing.fields[i].decode, {double(code)});
            // A product in another order is at most some roundings off.
            CHECK(std::abs(is - was) <= 0x1p-48 * std::abs(was));
            CHECK(value(after, packing.fields[i].encode, {is}) == code);
        }
    }
    for (std::size_t i = 0; i < packing.channels.size(); ++i)
        same(packing.channels[i].pack, before.packings[0].channels[i].pack);
    for (std::size_t i = 0; i < packing.parameters.size(); ++i)
        same(packing.parameters[i].unpack, before.packings[0].parameters[i].unpack);
}

}  // namespace

TEST_CASE("every pass keeps what packs and unpacks", "[packing]")
{
    const Module checked = checked_skin().module;
    const Module simple = optimize::simplify(checked);
    // Codes past the high end of power, log2 and linear with a pivot do not come back: leave them.
    const auto check = [&](const Module& after) {
        REQUIRE_FALSE(verify(after));
        Module reached = after;
        Module before = checked;
        for (std::size_t i : {0u, 4u, 8u}) {
            reached.packings[0].fields[i].bits = 1;
            before.packings[0].fields[i].bits = 1;
        }
        check_same_functions(before, reached);
    };
    check(simple);
    check(optimize::stabilize(simple));
    check(optimize::legalize(optimize::stabilize(simple)));
    check(optimize::optimize(checked));
    CHECK_FALSE(optimize::illegal(optimize::optimize(checked)));
    check(optimize::narrow(checked, {{"gain", {0, 4}}, {"tint", {0.5, 1}}}));
}

TEST_CASE("a value past its range has the last code, whatever the optimizer knows", "[packing]")
{
    const Module module = packed_skin().module;
    for (const Field& field : module.packings[0].fields) {
        const double low = value(module, field.encode, {field.range.low});
        const double high = value(module, field.encode, {field.range.high});
        CHECK(value(module, field.encode, {field.range.low - 1000}) == low);
        CHECK(value(module, field.encode, {field.range.high + 1000}) == high);
    }
}

TEST_CASE("a fixed parameter is no input of its channel any more", "[packing]")
{
    const Module checked = checked_skin().module;
    const Module fixed = optimize::optimize(optimize::specialize(checked, {{"falloff", {0.5}}}));
    REQUIRE_FALSE(verify(fixed));
    const Packing& packing = fixed.packings[0];
    // c.a, d.r, d.g, …: falloff shares d.g with roughening.
    const Function& pack = fixed[packing.channels[2].pack];
    CHECK(pack.name == "pack_d_g");
    REQUIRE(pack.inputs.size() == 1);
    CHECK(pack.inputs[0].name == "roughening");
    CHECK(value(fixed, packing.channels[2].pack, {1}) ==
          value(checked, packing.channels[2].pack, {0.5, 1}));
    // What is stored is unpacked as before.
    CHECK(value(fixed, packing.parameters[1].unpack, {0.8}) ==
          value(checked, packing.parameters[1].unpack, {0.8}));
}

TEST_CASE("what a code calls is not fitted to what the model passes", "[packing]")
{
    // gain(x, scale) = x * scale, guarded(x) = x^x: the model calls them with 2 and with [1, 2].
    Module module = empty_module();
    module.parameters.push_back(
        {"p", Type::scalar, Quantity::number, {1, 2}, {1}, "", "", "", "test", {}});
    Term scaled{"scaled"};
    const ExprId x = scaled.argument("x", 0, 1000);
    const ExprId scale = scaled.argument("scale", 0, 1000);
    const FunctionId scaled_id = scaled.in(module, scaled.multiply(x, scale));
    Term raised{"raised"};
    const ExprId base = raised.argument("base", 0, 1000);
    const FunctionId raised_id = raised.in(module, raised.op(Op::guarded_power, {base, base}));
    Term root{"root"};
    const ExprId p = root.parameter(module, 0);
    const FunctionId root_id =
        root.in(module, root.add(root.call(module, scaled_id, {p, root.number("2")}),
                                 root.call(module, raised_id, {p})));
    Term pack{"pack"};
    const ExprId read = pack.argument("read", 0, 1000);
    const FunctionId pack_id =
        pack.in(module, pack.add(pack.call(module, scaled_id, {read, pack.number("3")}),
                                 pack.call(module, raised_id, {read})));
    set_roots(module, {root_id});
    Packing packing;
    packing.channels = {{0, pack_id}};
    module.packings.push_back(packing);

    const Module special = optimize::optimize(optimize::specialize(module, {{"q", {0}}}));
    CHECK(value(special, pack_id, {2}) == 3 * 2 + 4);
    const Module narrow = optimize::optimize(optimize::narrow(module, {{"p", {1, 1.5}}}));
    // 0^0 is 1; with the model's range alone the guard would be gone.
    CHECK(value(narrow, pack_id, {0}) == 1);
    const Function& kept = narrow[raised_id];
    CHECK(kept.inputs[0].range == Range{0, 1000});
    CHECK(kept.graph[kept.result].op == Op::guarded_power);
}
