// Fixed parameters leave no trace: an effect that is off is absent, and Callisto at its defaults
// is its base model.
#include "build.h"
#include "models.h"
#include "optimize/inline.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/specialize.h"
#include "optimize/truth.h"
#include "values.h"

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::Settings;
using optimize::specialize;

namespace {

/// root(x) = lerp(1, lobe(x, width), gain), lobe(x, w) = x ^ (5 w)
struct Example {
    Module module = empty_module();
    FunctionId lobe;
    FunctionId root;

    Example()
    {
        module.parameters.push_back(
            {"width", Type::scalar, Quantity::number, {0, 1}, {0.5}, "", "", "", "test", {}});
        module.parameters.push_back(
            {"gain", Type::scalar, Quantity::number, {0, 1}, {0}, "", "", "", "test", {}});
        Term callee{"lobe"};
        const ExprId x = callee.argument("x");
        const ExprId w = callee.argument("w");
        lobe = callee.in(module,
                         callee.op(Op::guarded_power, {x, callee.multiply(callee.number("5"), w)}));
        Term caller{"root"};
        const ExprId y = caller.argument("y");
        const ExprId width = caller.parameter(module, 0);
        const ExprId gain = caller.parameter(module, 1);
        root = caller.in(
            module,
            caller.op(Op::lerp, {caller.number("1"), caller.call(module, lobe, {y, width}), gain}));
        set_roots(module, {root});
    }
};

}  // namespace

TEST_CASE("an effect that is off is absent")
{
    const Example example;
    const Module module = specialize(example.module, {{"gain", {0}}});
    REQUIRE_FALSE(verify(module));
    const Function& root = module[example.root];
    CHECK(root.graph.is_literal(root.result, 1));
    REQUIRE(root.inputs.size() == 1);  // its own argument; the parameters are gone
    CHECK(root.inputs[0].name == "y");
}

TEST_CASE("a constant that all callers pass becomes part of the callee")
{
    const Example example;
    const Module module = specialize(example.module, {{"width", {0.5}}});
    REQUIRE_FALSE(verify(module));
    const Function& lobe = module[example.lobe];
    REQUIRE(lobe.inputs.size() == 1);
    const auto operands = lobe.graph.operands(lobe.result);
    CHECK(lobe.graph.is_literal(operands[1], 2.5));
    // And so legalize has an exponent to spell.
    const Module legal = optimize::legalize(module);
    CHECK(legal[example.lobe].graph[legal[example.lobe].result].op == Op::multiply);
}

TEST_CASE("callers that disagree on a constant get bodies of their own")
{
    Module module = empty_module();
    Term callee{"scaled"};
    const ExprId x = callee.argument("x");
    const FunctionId id = callee.in(module, callee.multiply(x, callee.argument("by", 0, 4)));
    Term caller{"root"};
    const ExprId y = caller.argument("y");
    const FunctionId root =
        caller.in(module, caller.add(caller.call(module, id, {y, caller.number("2")}),
                                     caller.call(module, id, {y, caller.number("3")})));
    set_roots(module, {root});
    const Module special = specialize(module, {});
    REQUIRE_FALSE(verify(special));
    const Graph& graph = special[root].graph;
    for (const ExprId expr : graph.ids()) CHECK(graph[expr].op != Op::call);
    const auto points = Points<double>{{"y", {0, 0.25, 1}}};
    CHECK(values(special, root, points) == std::vector<double>{0, 1.25, 5});
}

TEST_CASE("a setting is the decimal it was written as")
{
    const Example example;
    const Module module = specialize(example.module, {{"gain", {0.1}}});
    bool found = false;
    for (const Literal& literal : module[example.root].graph.literals())
        found |= literal.text == "0.1";
    CHECK(found);
}

TEST_CASE("settings that are none change nothing")
{
    const Example example;
    const Module expected = optimize::simplify(example.module);
    CHECK(optimize::same_graphs(specialize(example.module, {}), expected));
    CHECK(optimize::same_graphs(specialize(example.module, {{"unknown", {1}}}), expected));
    CHECK(optimize::same_graphs(specialize(example.module, {{"gain", {1, 1, 1}}}), expected));
}

TEST_CASE("a setting gives the value that the parameter would have had")
{
    const Example example;
    const Settings settings{{"width", {0.75}}, {"gain", {0.5}}};
    const Module module = specialize(example.module, settings);
    Points<double> points{{"y", {0, 0.125, 0.5, 1}}};
    const auto special = values(module, example.root, points);
    points["width"] = {0.75, 0.75, 0.75, 0.75};
    points["gain"] = {0.5, 0.5, 0.5, 0.5};
    CHECK(special == values(example.module, example.root, points));
}

TEST_CASE("Callisto at its defaults is exactly Lambert, GGX and Schlick")
{
    const Module callisto = read_model("../models/callisto.lobe");
    const Module base = read_text(R"(
module base
import microfacet { D_GGX, V_SmithGGX, F_Schlick, Diffuse_Lambert }
model callisto_lambert(g: geometry, s: surface) {
  diffuse = if g.cos_i > 0 and g.cos_o > 0 then Diffuse_Lambert(s.diffuse_color) * g.cos_i else 0
  specular = if g.cos_i > 0 and g.cos_o > 0
    then D_GGX(s.roughness^2, g) * V_SmithGGX(s.roughness^2, g) * F_Schlick(s.f0, g.cos_d) * g.cos_i
    else 0
}
)");
    const Module special = specialize(callisto, optimize::defaults(callisto));
    REQUIRE_FALSE(verify(special));
    const Module left = optimize::optimize(special);
    const Module right = optimize::optimize(base);
    CHECK_FALSE(optimize::illegal(left));
    for (const char* name : {"callisto_lambert_diffuse", "callisto_lambert_specular"}) {
        CAPTURE(name);
        const Function a = optimize::inline_calls(left, left.find(name).value());
        const Function b = optimize::inline_calls(right, right.find(name).value());
        INFO(dump(a.graph) << "and\n" << dump(b.graph));
        CHECK(optimize::same_function(a, b));
    }
}

TEST_CASE("at the defaults every effect of Callisto is known to be off, and its code is gone")
{
    const Module callisto = read_model("../models/callisto.lobe");
    const Module special = specialize(callisto, optimize::defaults(callisto));
    REQUIRE(special.effects.size() == callisto.effects.size());
    for (const Effect& effect : special.effects) {
        CAPTURE(effect.name);
        const Function& condition = special[effect.off_when];
        CHECK(optimize::truth(condition.graph, condition.result) == true);
    }
    // Only the base terms are left to call.
    std::vector<std::string> left;
    for (const FunctionId id : special.reachable(special.roots())) left.push_back(special[id].name);
    for (const char* gone : {"alpha_f", "alpha_r", "blend_weight", "c1", "c2", "alpha_s"}) {
        CAPTURE(gone);
        CHECK(std::find(left.begin(), left.end(), gone) == left.end());
    }
}

TEST_CASE("with one effect on, the others stay absent")
{
    const Module callisto = read_model("../models/callisto.lobe");
    Settings settings = optimize::defaults(callisto);
    settings.erase("smooth_terminator");
    const Module special = optimize::optimize(specialize(callisto, settings));
    CHECK_FALSE(optimize::illegal(special));
    std::vector<std::string> left;
    for (const FunctionId id : special.reachable(special.roots())) left.push_back(special[id].name);
    const auto has = [&](const char* name) {
        return std::find(left.begin(), left.end(), name) != left.end();
    };
    CHECK(has("c2"));
    CHECK_FALSE(has("c1"));
    CHECK_FALSE(has("blend_weight"));
}

TEST_CASE("when a scene narrows a range, the guard goes")
{
    const Module callisto = read_model("../models/callisto.lobe");
    const auto guards = [](const Module& module) {
        const Module legal = optimize::optimize(module);
        CHECK_FALSE(optimize::illegal(legal));
        const Function& function = legal[legal.find("blend_weight").value()];
        int found = 0;
        for (const ExprId id : function.graph.ids()) {
            const Op op = function.graph[id].op;
            const bool held =
                op == Op::log2 && function.graph[function.graph.operands(id)[0]].op == Op::maximum;
            found += op == Op::guarded_power || held ? 1 : 0;
        }
        return found;
    };
    CHECK(guards(callisto) == 2);  // a falloff of 1 makes the exponent 0
    optimize::Limits limits;
    for (const char* name :
         {"diffuse_fresnel_falloff", "retroreflection_falloff", "diffuse_fresnel_tangent_falloff"})
        limits[name] = {0, 0.75};
    CHECK(guards(optimize::narrow(callisto, limits)) == 1);  // one caller may still pass 0
    limits["retroreflection_tangent_falloff"] = {0, 0.75};
    CHECK(guards(optimize::narrow(callisto, limits)) == 0);
}

TEST_CASE("ranges only become narrower, and roots' arguments keep theirs")
{
    const Example example;
    const Module wider = optimize::narrow(example.module, {{"width", {-1, 9}}});
    CHECK(wider.parameters[0].range == Range{0, 1});
    const Module apart = optimize::narrow(example.module, {{"width", {2, 3}}});
    CHECK(apart.parameters[0].range == Range{0, 1});
    const Module half = optimize::narrow(example.module, {{"width", {0.25, 0.5}}});
    CHECK(half[example.root].inputs[1].range == Range{0.25, 0.5});
    CHECK(half[example.lobe].inputs[1].range == Range{0.25, 0.5});
    CHECK(half[example.root].inputs[0].range == Range{0, 1});
}
