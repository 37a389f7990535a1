// Lights: what they may be made of, what a module lists of them, and where they meet models.
#include "check/checking.h"

#include <catch2/catch.hpp>

using namespace lobe;
using lobe::tests::check_text;
using lobe::tests::inputs_of;
using lobe::tests::value_at;

namespace {

const std::string lamp = R"(
light lamp(e: emitter) {
  direction  = e.l
  irradiance = 1 / (e.distance_squared + 1)
}
)";

}  // namespace

TEST_CASE("a light is its outputs, over the fields that each asks for", "[check][light]")
{
    const auto checked = check_text(R"(
/// A lamp.
light lamp(e: emitter, s: surface) {
  let near = 1 / (e.distance_squared + 1)
  direction  = e.l
  irradiance = near * (1 - e.inverse_range / 4096)
  /// Along the ray.
  specular_direction = normalize(e.r + e.axis * e.half_length)
  specular_gain      = s.alpha * near + dot(e.n, e.v) * e.radius
}
)");
    REQUIRE(checked.errors() == "");
    CHECK(checked.warnings() == "");
    CHECK(checked.module->models.empty());
    CHECK(checked.module->shadings.empty());
    REQUIRE(checked.module->lights.size() == 1);
    const ir::Model& light = checked.module->lights[0];
    CHECK(light.name == "lamp");
    CHECK(light.doc == "A lamp.");
    REQUIRE(light.outputs.size() == 4);
    CHECK(inputs_of(checked.function("lamp_direction")) == "to_light");
    CHECK(inputs_of(checked.function("lamp_irradiance")) == "to_light inverse_range");
    CHECK(inputs_of(checked.function("lamp_specular_direction")) == "axis half_length v n");
    CHECK(inputs_of(checked.function("lamp_specular_gain")) == "to_light radius v n roughness");
    CHECK(checked.function("lamp_direction").quantity == ir::Quantity::direction);
    CHECK(checked.function("lamp_specular_direction").doc == "Along the ray.");
    // Its outputs are what the module is for.
    CHECK(checked.module->roots().size() == 4);
}

TEST_CASE("the fields of an emitter follow from its vectors", "[check][light]")
{
    const auto checked = check_text(R"(
/// Its square.
term squared(e: emitter) -> float = e.distance_squared
/// Towards it.
term toward(e: emitter) -> direction = e.l
/// Mirrored.
term mirrored(e: emitter) -> direction = e.r
)");
    REQUIRE(checked.errors() == "");
    const auto value = [&](const char* name, const std::vector<double>& point, int component) {
        return value_at(*checked.module, checked.function(name), point, component);
    };
    CHECK(value("squared", {1, 2, 2}, 0) == 9);
    CHECK(value("toward", {0, 3, 4}, 1) == Approx(0.6));
    CHECK(value("toward", {0, 3, 4}, 2) == Approx(0.8));
    CHECK(value("toward", {0, 0, 0}, 0) == 0);
    // v = (0.6, 0, 0.8), n = z
    CHECK(value("mirrored", {0.6, 0, 0.8, 0, 0, 1}, 0) == Approx(-0.6));
    CHECK(value("mirrored", {0.6, 0, 0.8, 0, 0, 1}, 2) == Approx(0.8));
}

TEST_CASE("an emitter's v and n are the geometry's", "[check][light]")
{
    const auto checked = check_text(R"(
/// Before the emitter.
term before(g: geometry, e: emitter) -> float = g.cos_i + dot(e.v, g.v) + e.radius
/// Behind it.
term behind(e: emitter, g: geometry) -> float = g.cos_i + dot(e.v, g.v) + e.radius
)");
    REQUIRE(checked.errors() == "");
    CHECK(inputs_of(checked.function("before")) == "v cos_i radius");
    CHECK(inputs_of(checked.function("behind")) == "radius v cos_i");
}

TEST_CASE("terms pass an emitter on", "[check][light]")
{
    const auto checked = check_text(R"(
/// Of one.
term inner(e: emitter, x: unit) -> float = e.radius * x
/// Of the same.
term outer(x: unit, e: emitter) -> float = inner(e, x) + e.half_length
)");
    REQUIRE(checked.errors() == "");
    CHECK(inputs_of(checked.function("outer")) == "x radius half_length");
}

TEST_CASE("a light has a direction and an irradiance, and nothing unknown", "[check][light]")
{
    CHECK(check_text("light a(e: emitter) { direction = e.l }").errors() == "E0410");
    CHECK(check_text("light a(e: emitter) { irradiance = 1 }").errors() == "E0410");
    CHECK(check_text("light a(e: emitter) {\n direction = e.l\n irradiance = 1\n color = 1\n}")
              .errors() == "E0410");
    CHECK(
        check_text("light a(e: emitter) {\n direction = e.to_light\n irradiance = 1\n}").errors() ==
        "E0401");
    CHECK(check_text("light a(e: emitter) {\n direction = e.l\n irradiance = e.l\n}").errors() ==
          "E0401");
    CHECK(check_text("light a(e: emitter) {\n direction = e.l\n irradiance = 1 / e.radius\n}")
              .errors() == "E0501");
}

TEST_CASE("emitters are for lights, geometries for models", "[check][light]")
{
    CHECK(check_text("model m(e: emitter) { diffuse = e.radius }").errors() == "E0406");
    CHECK(check_text("light a(g: geometry) {\n direction = g.l\n irradiance = 1\n}").errors() ==
          "E0406");
    CHECK(check_text("light a(e: emitter, x: unit) {\n direction = e.l\n irradiance = x\n}")
              .errors() == "E0406");
    CHECK(check_text("param e : emitter = 1").errors() == "E0406");
    CHECK(check_text("term f(e: emitter) -> float = e.position").errors() == "E0309");
    CHECK(check_text("term f(e: emitter) -> float = e + 1").errors() != "");
    CHECK(check_text(lamp + "term f(x: unit) -> float = lamp").errors() == "E0409");
    CHECK(check_text(lamp + "term f(x: unit) -> float = lamp(x)").errors() == "E0407");
    CHECK(check_text(lamp + "term lamp_direction(x: unit) -> unit = x").errors() == "E0302");
}

TEST_CASE("every model of a module meets every light of it", "[check][light]")
{
    const auto checked = check_text(lamp + R"(
light other(e: emitter) {
  direction  = e.axis
  irradiance = 1
}
model a(g: geometry) { diffuse = g.cos_i }
model b(g: geometry) { specular = g.cos_h }
)");
    REQUIRE(checked.errors() == "");
    std::vector<std::string> pairs;
    for (const ir::Shading& shading : checked.module->shadings)
        pairs.push_back(shading.model.name + " " + shading.light.name);
    CHECK(pairs == std::vector<std::string>{"a lamp", "a other", "b lamp", "b other"});
}

TEST_CASE("an import is enough for them to meet", "[check][light]")
{
    const std::map<std::string, std::string> others{
        {"lamps", "module lamps\n" + lamp + R"(
light unasked(e: emitter) {
  direction  = e.l
  irradiance = 1
}
)"},
        {"paint", "module paint\nparam gain : unit = 1\n"
                  "model matte(g: geometry) { diffuse = gain * g.cos_i }\n"}};
    const auto checked = check_text("import paint { matte }\nimport lamps { lamp }\n", others);
    REQUIRE(checked.errors() == "");
    // Both imports are used.
    CHECK(checked.warnings() == "");
    REQUIRE(checked.module->shadings.size() == 1);
    CHECK(checked.module->shadings[0].model.name == "matte");
    CHECK(checked.module->shadings[0].light.name == "lamp");
    CHECK(checked.module->models.empty());
    CHECK(checked.module->lights.empty());
    CHECK(checked.module->roots().empty());
    CHECK(!checked.module->find("unasked_direction"));
    CHECK(checked.module->parameters.size() == 1);

    CHECK(check_text("import lamps { lamp }\n", others).warnings() == "W0301");
}
