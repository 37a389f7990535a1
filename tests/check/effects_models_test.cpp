// Effects, models, and what a module lists of them.
#include "check/checking.h"

#include <catch2/catch.hpp>

using namespace lobe;
using lobe::tests::check_text;
using lobe::tests::inputs_of;
using lobe::tests::value_at;

TEST_CASE("an effect's condition is a function over parameters", "[check][effect]")
{
    const auto checked = check_text(R"(
param gain : float in [0, 4] = 1
param tint : color = (1, 1, 1)
/// Doubles.
term doubled(x: float in [0, 4]) -> float = 2 * x
effect "Tint" off when gain * tint == 1
effect "Gain" off when doubled(gain) == 0 or gain > 3
)");
    REQUIRE(checked.errors() == "");
    REQUIRE(checked.module->effects.size() == 2);
    const ir::Effect& tint = checked.module->effects[0];
    CHECK(tint.name == "Tint");
    CHECK(tint.condition == "gain * tint == 1");
    const ir::Function& function = (*checked.module)[tint.off_when];
    CHECK(function.name == "effect_1");
    CHECK(function.type() == ir::Type::boolean);
    CHECK(inputs_of(function) == "gain tint");
    CHECK(value_at(*checked.module, function, {1, 1, 1, 1}) == 1);
    CHECK(value_at(*checked.module, function, {2, 0.5, 0.5, 0.5}) == 1);
    CHECK(value_at(*checked.module, function, {1, 1, 0.5, 1}) == 0);
    // Conditions are no part of what is emitted.
    for (const ir::FunctionId root : checked.module->roots())
        CHECK((*checked.module)[root].name == "doubled");
}

TEST_CASE("each output is a function with what it uses", "[check][model]")
{
    const auto checked = check_text(R"(
param gain : float in [0, 4] = 1
/// The model.
model m(g: geometry, s: surface) {
  let gate = if g.cos_i > 0 then 1 else 0
  let only_specular = gain * g.cos_h
  diffuse = s.diffuse_color * g.cos_i * gate
  /// The highlight.
  specular = s.f0 * only_specular * gate
}
)");
    REQUIRE(checked.errors() == "");
    CHECK(checked.warnings() == "");
    REQUIRE(checked.module->models.size() == 1);
    const ir::Model& model = checked.module->models[0];
    CHECK(model.name == "m");
    CHECK(model.doc == "The model.");
    REQUIRE(model.outputs.size() == 2);
    CHECK(model.outputs[1].name == "specular");
    const ir::Function& diffuse = checked.function("m_diffuse");
    const ir::Function& specular = checked.function("m_specular");
    CHECK(diffuse.kind == ir::Function::Kind::output);
    CHECK(inputs_of(diffuse) == "cos_i diffuse_color");
    CHECK(inputs_of(specular) == "cos_i cos_h f0 gain");
    CHECK(diffuse.doc == "The model.");
    CHECK(specular.doc == "The highlight.");
    CHECK(specular.formula == "s.f0 * only_specular * gate");
}

TEST_CASE("what is wrong with a model's lets is said once", "[check][model]")
{
    CHECK(check_text(R"(
model m(g: geometry) {
  let a = missing
  let b = 1 / g.cos_i
  diffuse = a * b
  specular = b * b
  other = a
}
)")
              .errors() == "E0301 E0501");
}

TEST_CASE("an output is a number or a color", "[check][model]")
{
    CHECK(check_text("model m(g: geometry) {\n  diffuse = g.cos_i > 0\n}").errors() == "E0401");
    CHECK(check_text("model m(g: geometry) {\n  diffuse = g\n}").errors() == "E0401");
    CHECK(check_text("model m(g: geometry, h: geometry) {\n  diffuse = g.cos_i\n}").errors() ==
          "E0406");
}

TEST_CASE("parameters are listed as declared", "[check][parameter]")
{
    const auto checked = check_text(R"(
tier base, full
/// How strong.
/// In linear units.
param gain : float in [0, 2^8] = 1 full "Gain"
param tint : color in [0, 4] = 0.5
param steps : int in [1, 8] = 4
param enabled : bool = true
param offset : float2 in [-1, 1] = (-1/2, pi/4)
)");
    REQUIRE(checked.errors() == "");
    const auto& parameters = checked.module->parameters;
    REQUIRE(parameters.size() == 5);
    CHECK(parameters[0].doc == "How strong.\nIn linear units.");
    CHECK(parameters[0].label == "Gain");
    CHECK(parameters[0].tier == "full");
    CHECK(parameters[0].range == ir::Range{0, 256});
    CHECK(parameters[1].default_value == std::vector<double>{0.5, 0.5, 0.5});
    CHECK(parameters[1].range == ir::Range{0, 4});
    CHECK(parameters[2].quantity == ir::Quantity::integer);
    CHECK(parameters[3].default_value == std::vector<double>{1});
    CHECK(parameters[4].default_value == std::vector<double>{-0.5, 3.141592653589793 / 4});
    CHECK(checked.module->tiers == std::vector<std::string>{"base", "full"});
}
