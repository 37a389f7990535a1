// A residual module is what a person would have written for that scene alone: nothing of what is
// off, no parameter that nothing reads, packings of what is left.
#include "build.h"
#include "models.h"
#include "optimize/inline.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/residual.h"
#include "optimize/rewrite.h"
#include "values.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::Called;
using optimize::Residual;
using optimize::residual;

namespace {

using Names = std::vector<std::string>;

const Module& callisto()
{
    static const Module module = read_model("../models/callisto.lobe");
    return module;
}

/// Nothing is called for but these parameters, in these ranges, with their effects.
Called only(const Module& module, const optimize::Limits& ranges, const Names& on)
{
    Called called;
    called.ranges = ranges;
    for (const Parameter& parameter : module.parameters)
        if (!ranges.contains(parameter.name))
            called.constants[parameter.name] = parameter.default_value;
    for (const Effect& effect : module.effects)
        if (std::ranges::count(on, effect.name) == 0) called.off.insert(effect.name);
    return called;
}

Names names_of(const std::vector<Parameter>& parameters)
{
    Names names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    return names;
}

Names functions_of(const Module& module)
{
    Names names;
    for (const Function& function : module.functions) names.push_back(function.name);
    return names;
}

bool has(const Names& names, const std::string& name)
{
    return std::ranges::count(names, name) > 0;
}

int count(const Module& module, Op op)
{
    int found = 0;
    for (const FunctionId id : module.reachable(module.roots()))
        for (const ExprId expr : module[id].graph.ids())
            found += module[id].graph[expr].op == op ? 1 : 0;
    return found;
}

/// Whether two outputs compute the same expression of the same inputs.
bool same_output(const Module& a, const std::string& x, const Module& b, const std::string& y)
{
    Function f = optimize::inline_calls(a, a.find(x).value());
    const Function g = optimize::inline_calls(b, b.find(y).value());
    f.name = g.name;
    INFO(dump(f.graph) << "and\n" << dump(g.graph));
    CHECK(optimize::same_function(f, g));
    return optimize::same_function(f, g);
}

}  // namespace

TEST_CASE("a scene that calls for nothing gets the base model that a person writes")
{
    const Residual left = residual(callisto(), only(callisto(), {}, {}), "callisto");
    REQUIRE(verify(left.module).value_or("") == "");
    CHECK(left.off.size() == callisto().effects.size());
    CHECK(left.left.empty());
    CHECK(left.fixed.empty());
    CHECK(left.absent == names_of(callisto().parameters));
    CHECK(left.module.effects.empty());
    CHECK(left.module.packings.empty());
    CHECK(left.module.engines.empty());
    REQUIRE(left.module.models.size() == 1);
    CHECK(left.module.models[0].name == "callisto");
    // The second lobe is gone, and with it the term that mixed two.
    CHECK(functions_of(left.module) == Names{"F_Callisto", "proxima_cos", "D_GGX", "V_SmithGGX",
                                             "lobe_ggx", "specular_cos", "callisto_diffuse",
                                             "callisto_specular"});

    const Module emitted = optimize::optimize(left.module);
    CHECK_FALSE(optimize::illegal(emitted));
    const Module base = optimize::optimize(read_model("data/residual/base.lobe"));
    CHECK(same_output(emitted, "callisto_diffuse", base, "base_diffuse"));
    CHECK(same_output(emitted, "callisto_specular", base, "base_specular"));
}

TEST_CASE("effects that are off take their parameters with them")
{
    const optimize::Limits ranges{{"retroreflection", {1, 8}}};
    const Residual left =
        residual(callisto(), only(callisto(), ranges, {"Retroreflection"}), "callisto");
    REQUIRE(verify(left.module).value_or("") == "");
    CHECK(left.left == Names{"retroreflection"});
    CHECK(left.fixed == Names{"retroreflection_falloff", "retroreflection_tint",
                              "retroreflection_tangent_falloff"});
    CHECK(left.off ==
          Names{"Diffuse Fresnel", "Smooth Terminator", "Specular Fresnel", "Dual Specular"});
    REQUIRE(left.module.effects.size() == 1);
    CHECK(left.module.effects[0].name == "Retroreflection");
    CHECK(left.module.parameters.size() == callisto().parameters.size());
    const Names functions = functions_of(left.module);
    for (const char* gone : {"alpha_f", "alpha_s", "c2", "lambert_cos", "callisto_lambert_diffuse",
                             "decode_diffuse_fresnel", "unpack_smooth_terminator"})
        CHECK_FALSE(has(functions, gone));
    for (const char* kept : {"blend_weight", "decode_retroreflection", "unpack_retroreflection"})
        CHECK(has(functions, kept));

    // 5 r(0.75) = 2.5 is two products and a root.
    const Module emitted = optimize::optimize(left.module);
    CHECK_FALSE(optimize::illegal(emitted));
    CHECK(count(emitted, Op::power) == 0);
    CHECK(count(emitted, Op::guarded_power) == 0);
}

TEST_CASE("a packing carries what is left, in the bits that it had")
{
    const optimize::Limits ranges{{"retroreflection", {1, 8}}, {"smooth_terminator", {0, 0.5}}};
    const Residual left = residual(
        callisto(), only(callisto(), ranges, {"Retroreflection", "Smooth Terminator"}), "callisto");
    REQUIRE(verify(left.module).value_or("") == "");
    REQUIRE(left.module.packings.size() == 1);
    const Packing& packing = left.module.packings[0];
    const Packing& before = callisto().packings[0];
    REQUIRE(packing.fields.size() == 2);
    CHECK(packing.channels.size() == 2);
    CHECK(packing.parameters.size() == 2);
    for (const Field& field : packing.fields) {
        const auto same = std::ranges::find(before.fields, field.parameter, &Field::parameter);
        REQUIRE(same != before.fields.end());
        CHECK(field.slots == same->slots);
        CHECK(left.module[field.decode].name == callisto()[same->decode].name);
        CHECK(optimize::same_function(left.module[field.decode], callisto()[same->decode]));
        CHECK(optimize::same_function(left.module[field.encode], callisto()[same->encode]));
    }
    // Any code may be read, so guards stay for all that codes mean.
    CHECK(left.module.parameters[packing.fields[0].parameter].range ==
          callisto().parameters[packing.fields[0].parameter].range);
    REQUIRE(left.module.engines.size() == 1);
    CHECK(left.module.engines[0].pins.size() == 1);
    REQUIRE(left.module.engines[0].node);
    CHECK(left.module.engines[0].node->parameters.size() == 1);
    CHECK_FALSE(optimize::illegal(optimize::optimize(left.module)));
}

TEST_CASE("surface fields may be constants")
{
    Called called = only(callisto(), {}, {});
    called.constants["roughness"] = {0.5};
    called.constants["f0"] = {0.04, 0.04, 0.04};
    const Residual left = residual(callisto(), called, "callisto");
    REQUIRE(verify(left.module).value_or("") == "");
    const Function& specular = left.module[left.module.find("callisto_specular").value()];
    for (const Input& input : specular.inputs) CHECK(input.origin == Origin::geometry);
    CHECK_FALSE(optimize::illegal(optimize::optimize(left.module)));
}

TEST_CASE("exponents are what they are on paper")
{
    // 5 r(0.7) = 3, which no arithmetic of doubles makes of 0.7; 5 r(0.95) is one half.
    Called called = only(callisto(), {{"retroreflection", {1, 8}}}, {"Retroreflection"});
    called.constants["retroreflection_falloff"] = {0.7};
    called.constants["retroreflection_tangent_falloff"] = {0.95};
    const Module emitted = optimize::optimize(residual(callisto(), called, "callisto").module);
    CHECK_FALSE(optimize::illegal(emitted));
    CHECK(count(emitted, Op::power) == 0);
    CHECK(count(emitted, Op::guarded_power) == 0);
    CHECK(count(emitted, Op::exp2) == 0);
}

TEST_CASE("an effect whose condition holds on paper is off")
{
    // 0.1 * 10 == 1, although no double is 0.1.
    Called called = only(callisto(), {}, {"Retroreflection"});
    called.constants["retroreflection"] = {10};
    called.constants["retroreflection_tint"] = {0.1, 0.1, 0.1};
    const Residual left = residual(callisto(), called, "callisto");
    CHECK(left.off.size() == callisto().effects.size());
    CHECK_FALSE(has(functions_of(left.module), "alpha_r"));
}

TEST_CASE("an effect that shares a parameter with one that is on stays")
{
    const Module module = read_text(R"(
module test
param gain : float in [0, 4] = 0
param first : unit = 0
param second : unit = 0
effect "First" off when gain * first == 0
effect "Second" off when gain * second == 0
model test(g: geometry) {
  diffuse = (1 + gain * first * g.cos_o + gain * second * g.cos_i) * g.cos_i
}
)");
    Called called;
    called.ranges = {{"gain", {1, 4}}, {"second", {0.5, 1}}};
    called.off = {"First"};
    const Residual left = residual(module, called, "test");
    REQUIRE(verify(left.module).value_or("") == "");
    CHECK(left.off == Names{"First"});
    CHECK(left.left == Names{"gain", "second"});
    CHECK(left.absent == Names{"first"});
    CHECK(left.settings == optimize::Settings{{"first", {0}}});

    // Had both a default that is on, nothing could be said.
    Module other = module;
    other.parameters[1].default_value = {1};
    const Residual stays = residual(other, called, "test");
    CHECK(stays.off.empty());
    CHECK(stays.left == Names{"gain", "first", "second"});
}

TEST_CASE("what is 0 or 1 chooses between colors")
{
    const Module module = read_text(R"(
module test
param rim : unit = 0
term blended(from: color, to: color, weight: unit) -> color = lerp(from, to, weight^2)
model test(g: geometry, s: surface) {
  diffuse = blended(s.diffuse_color, s.f0, s.metallic) * g.cos_i
  specular = lerp(s.f0, s.diffuse_color, rim) * g.cos_i
}
)");
    Called called;
    called.binary = {"metallic"};
    const Residual left = residual(module, called, "test");
    REQUIRE(verify(left.module).value_or("") == "");
    CHECK(count(left.module, Op::lerp) == 1);  // of the rim, which is anything
    CHECK(count(left.module, Op::select) == 1);
    CHECK(count(left.module, Op::power) + count(left.module, Op::guarded_power) == 0);
    const FunctionId before = module.find("test_diffuse").value();
    const FunctionId after = left.module.find("test_diffuse").value();
    for (const double metallic : {0.0, 1.0}) {
        const Points<double> points{{"metallic", {metallic}},
                                    {"diffuse_color.r", {0.25}},
                                    {"diffuse_color.g", {0.5}},
                                    {"diffuse_color.b", {0.75}},
                                    {"f0.r", {0.125}},
                                    {"f0.g", {0.0625}},
                                    {"f0.b", {1}},
                                    {"cos_i", {0.5}}};
        CHECK(values(module, before, points) == values(left.module, after, points));
    }
}

TEST_CASE("an effect that is left out on purpose has its defaults, whatever the constants say")
{
    Called called =
        only(callisto(), {{"smooth_terminator", {0, 0.5}}, {"smooth_terminator_length", {0.5, 1}}},
             {"Smooth Terminator"});
    called.constants["specular_fresnel_falloff"] = {0.25};
    const Residual left = residual(callisto(), called, "callisto");
    REQUIRE(verify(left.module).value_or("") == "");
    CHECK(has(left.off, "Specular Fresnel"));
    CHECK(left.settings.at("specular_fresnel_falloff") == std::vector<double>{0.5});
}

TEST_CASE("a formula says what the parameters are that it names and that are gone")
{
    const Residual left = residual(
        callisto(),
        [] {
            Called called = only(callisto(), {{"smooth_terminator_length", {0.25, 0.5}}},
                                 {"Smooth Terminator"});
            called.constants["smooth_terminator"] = {0.6};
            return called;
        }(),
        "callisto");
    const std::string formula = left.module[*left.module.find("c2")].formula;
    CHECK(
        formula.ends_with("), where smooth_terminator = 0.6, smooth_terminator_tint = (1, 1, 1)"));
    // What is still an input says its range elsewhere, and so do functions without parameters.
    CHECK(left.module[*left.module.find("alpha_s")].formula ==
          callisto()[*callisto().find("alpha_s")].formula);
}

TEST_CASE("ranges that are handed on stay, and computed ones have few digits")
{
    Called called;
    called.ranges = {{"roughness", {0.3, 0.7}}, {"f0", {0.04, 0.04}}};
    const Module narrowed = residual(callisto(), called, "callisto").module;
    const auto range = [&](const char* function, const char* input) {
        for (const Input& each : narrowed[*narrowed.find(function)].inputs)
            if (each.name == input) return each.range;
        FAIL("no such input");
        return Range{};
    };
    CHECK(range("F_Callisto", "f0") == Range{0.04, 0.04});
    const Range alpha = range("proxima_cos", "alpha");
    CHECK(alpha.low <= 0.09);
    CHECK(alpha.high >= 0.49);
    // A float's rounding each of the factor and the product, and one of the sixth digit.
    CHECK(alpha.low >= 0.09 * (1 - 4 * 0x1p-23 - 1e-5));
    CHECK(alpha.high <= 0.49 * (1 + 4 * 0x1p-23 + 1e-5));
    CHECK(std::stod(fmt::format("{:.6g}", alpha.low)) == alpha.low);
}
