// What a scene says of a model's inputs: which effects it calls for and why, what materials have in
// common, and that wrong values are told where they stand.
#include "analyze/toy_facts.h"

#include <cmath>
#include <limits>
#include <random>

using namespace lobe;
using namespace lobe::tests;
using analyze::InputFact;
using analyze::SceneFacts;
using analyze::SurfaceUse;
using Catch::Contains;

namespace {

scene::Complaint only_complaint(const scene::Material& material)
{
    const auto result = found(scene_of({material}));
    REQUIRE_FALSE(result.facts);
    REQUIRE(result.complaints.size() == 1);
    CHECK(result.complaints[0].is_error);
    return result.complaints[0];
}

}  // namespace

TEST_CASE("what nothing sets is at its default, and calls for nothing")
{
    const SceneFacts facts = facts_of(scene_of({plain("a"), plain("b")}));
    CHECK(facts.materials.size() == 2);
    CHECK(facts.materials[0].coverage == Approx(0.5));
    CHECK_FALSE(is_on(facts, 0));
    CHECK(facts.effects[0].why == "no material calls for it");
    const InputFact& gain = facts.input(facts.materials[0], "gain");
    CHECK(gain.is_default);
    CHECK(gain.value() == std::vector<double>{1});
    const auto called = facts.called();
    CHECK(called.constants.at("gain") == std::vector<double>{1});
    CHECK(called.off == std::set<std::string>{"Coat", "Gain"});
}

TEST_CASE("an effect is on where some value lets it be, component by component")
{
    const auto on = [](const scene::Material& material) {
        return is_on(facts_of(scene_of({material})), 0);
    };
    CHECK(on(with("gain", constant({4}))));
    CHECK(on(with("tint", constant({1, 1, 0.5}))));
    CHECK_FALSE(on(with("tint", constant({1, 1, 1}))));
    CHECK(on(with("gain", between({1}, {2}))));  // 1 is among them, and so are others
    CHECK(on(with("gain", between({2}, {4}))));
    scene::Material balanced = with("gain", constant({4}));
    balanced.parameters["tint"] = constant({0.25, 0.25, 0.25});
    CHECK_FALSE(on(balanced));
}

TEST_CASE("constants are decimals, not doubles")
{
    // 0.1 * 3 is 0.30000000000000004 in doubles.
    scene::Material material = with("width", constant({0.1}));
    material.parameters["gain"] = constant({3});
    CHECK_FALSE(is_on(facts_of(scene_of({material})), 1));
    material.parameters["gain"] = constant({3.0000001});
    CHECK(is_on(facts_of(scene_of({material})), 1));
}

TEST_CASE("why an effect is on is the value that called for it, and where that stands")
{
    scene::Material material = plain("wax");
    material.parameters["gain"] = constant({4}, "/materials/1/extras/lobe/parameters/gain");
    const SceneFacts facts = facts_of(scene_of({plain("a"), material}));
    CHECK(facts.effects[0].why == "gain = 4");
    CHECK(facts.effects[0].called_by == "/materials/1/extras/lobe/parameters/gain");
    CHECK(facts.effects[0].materials == std::vector<std::size_t>{1});
}

TEST_CASE("an extension of a parameter's name is its value")
{
    scene::Material material = plain("car");
    material.extensions["clearcoat"] = constant({0.5}, "/materials/0/extensions");
    const SceneFacts facts = facts_of(scene_of({material}));
    CHECK(is_on(facts, 2));
    CHECK(facts.not_modeled.empty());
    // What the model's own words say goes first.
    material.parameters["clearcoat"] = constant({0});
    CHECK_FALSE(is_on(facts_of(scene_of({material})), 2));
}

TEST_CASE("extensions that no parameter takes are told once, where they do something")
{
    scene::Material velvet = plain("velvet");
    velvet.extensions["sheen_color"] = constant({0.5, 0.2, 0.4});
    velvet.extensions["sheen_roughness"] = constant({0.5});
    scene::Material off = plain("off");
    off.extensions["transmission"] = constant({0});
    const auto result = found(scene_of({velvet, velvet, off}));
    REQUIRE(result.facts);
    CHECK(result.facts->not_modeled == std::vector<std::string>{"KHR_materials_sheen"});
    REQUIRE(result.complaints.size() == 1);
    CHECK_FALSE(result.complaints[0].is_error);
    CHECK(result.complaints[0].pointer == "/materials/0");
}

TEST_CASE("an effect that is said to be off is off at every value")
{
    std::mt19937 random{2};
    std::uniform_real_distribution<double> unit{0, 1};
    int off = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const auto pick = [&] { return std::floor(4 * unit(random)) / 2; };
        const double low = pick();
        const double high = unit(random) < 0.5 ? low : std::max(low, pick());
        scene::Components tint;
        for (int k = 0; k < 3; ++k) tint.push_back(std::min(pick(), 1.0));
        if (unit(random) < 0.7) tint = {tint[0], tint[0], tint[0]};
        scene::Material material = with("gain", between({low}, {high}));
        material.parameters["tint"] = constant(tint);
        const SceneFacts facts = facts_of(scene_of({material}));
        bool holds = true;
        for (const double gain : {low, (low + high) / 2, high})
            for (const double component : tint) holds = holds && gain * component == 1;
        // Halves and their products are exact, so that what holds at all is seen to hold.
        CAPTURE(low, high, tint[0], tint[1], tint[2]);
        REQUIRE(is_on(facts, 0) == !holds);
        off += holds ? 1 : 0;
    }
    CHECK(off > 20);
}

TEST_CASE("what materials have in common")
{
    scene::Material a = with("gain", constant({2}));
    scene::Material b = with("gain", constant({4}));
    a.parameters["width"] = b.parameters["width"] = constant({0.25});
    b.base_color = constant({0.25, 0.5, 1, 1});
    const SceneFacts facts = facts_of(scene_of({a, b}));

    const auto both = facts.called();
    CHECK(both.constants.at("width") == std::vector<double>{0.25});
    CHECK(both.ranges.at("gain") == ir::Range{2, 4});
    CHECK(both.ranges.at("diffuse_color") == ir::Range{0.25, 1});
    CHECK_FALSE(both.constants.contains("gain"));
    CHECK_FALSE(both.off.contains("Gain"));

    // A shared shader takes the surface from outside, but for what removes code.
    const auto first = facts.called({0});
    CHECK(first.constants.at("gain") == std::vector<double>{2});
    CHECK(first.constants.at("metallic") == std::vector<double>{0});
    CHECK_FALSE(first.constants.contains("roughness"));
    const auto alone = facts.called({0}, SurfaceUse::fixed);
    CHECK(alone.constants.at("roughness") == std::vector<double>{0.5});
    CHECK(alone.constants.at("diffuse_color") == std::vector<double>{0.5, 0.5, 0.5});
}

TEST_CASE("a layered material is whatever a blend of its layers can be")
{
    scene::Material ground = plain("ground");
    scene::Material snow = plain("snow");
    snow.parameters["gain"] = constant({3});
    snow.metallic = constant({1});
    snow.roughness = constant({1});
    ground.layers.push_back({1, between({0}, {1})});
    const SceneFacts facts = facts_of(scene_of({ground, snow}));
    CHECK(facts.has_layers);
    CHECK(range_of(facts, "gain") == ir::Range{1, 3});
    CHECK(range_of(facts, "roughness") == ir::Range{0.5, 1});
    // Half of each: metallic 0.5 of base color 0.5.
    CHECK(range_of(facts, "f0").high >= 0.27);
    CHECK_FALSE(facts.materials[0].inputs.at("metallic").is_binary);
    CHECK(facts.materials[0].calls[0]);
}

TEST_CASE("layers of layers are part of the blend, and of its colors")
{
    scene::Material ground = plain("ground");
    scene::Material snow = plain("snow");
    scene::Material ice = plain("ice");
    ice.parameters["gain"] = constant({3});
    ice.base_color = constant({1, 1, 1, 1});
    ground.layers.push_back({1, constant({0.5})});
    snow.layers.push_back({2, constant({0.5})});
    const SceneFacts facts = facts_of(scene_of({ground, snow, ice}));
    CHECK(range_of(facts, "gain") == ir::Range{1, 3});
    CHECK(range_of(facts, "diffuse_color") == ir::Range{0.5, 1});
    CHECK(facts.materials[0].calls[0]);

    // Deeper than a stack of calls may be.
    std::vector<scene::Material> tower(20'000, plain("m"));
    for (std::size_t i = 0; i + 1 < tower.size(); ++i)
        tower[i].layers.push_back({i + 1, constant({0.5})});
    tower.back().parameters["gain"] = constant({5});
    CHECK(range_of(facts_of(scene_of(std::move(tower))), "gain").high == 5);
}

TEST_CASE("what a model does not take is an error where it stands")
{
    const std::string here = "/materials/0/extras/lobe/parameters/gain";
    SECTION("outside of the declared range")
    {
        const auto complaint = only_complaint(with("gain", constant({300}, here)));
        CHECK(complaint.pointer == here);
        CHECK(complaint.message == "300 is outside of [0, 8]");
        CHECK(complaint.help == "`gain` is declared in [0, 8]; its default is 1");
    }
    SECTION("outside with a range")
    {
        CHECK(only_complaint(with("gain", between({1}, {9}, here))).message ==
              "it reaches 9, which is outside of [0, 8]");
    }
    SECTION("of another name")
    {
        const auto complaint = only_complaint(with("gian", constant({1}, here)));
        CHECK_THAT(complaint.message, Contains("no parameter `gian`"));
        CHECK(complaint.help == "did you mean `gain`?");
    }
    SECTION("of another size")
    {
        CHECK(only_complaint(with("tint", constant({1}, here))).message ==
              "`tint` takes 3 numbers; here are 1");
        CHECK(only_complaint(with("gain", constant({1, 1}, here))).message ==
              "`gain` takes 1 number; here are 2");
    }
    SECTION("not a number")
    {
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            CHECK(only_complaint(with("gain", constant({bad}, here))).message ==
                  "`gain` is not finite");
    }
    SECTION("no whole number")
    {
        CHECK(only_complaint(with("steps", constant({1.5}, here))).message ==
              "`steps` is a whole number; got 1.5");
    }
}

TEST_CASE("many mistakes are told up to a hundred")
{
    std::vector<scene::Material> materials(250, with("gain", constant({300})));
    const auto result = found(scene_of(std::move(materials)));
    CHECK_FALSE(result.facts);
    REQUIRE(result.complaints.size() == 101);
    CHECK(result.complaints.back().message == "150 more like these");
}

TEST_CASE("a scene without a lit material is refused")
{
    const auto nothing = found(scene_of({}));
    CHECK_FALSE(nothing.facts);
    REQUIRE(nothing.complaints.size() == 1);
    CHECK(nothing.complaints[0].message == "no material to shade");
    scene::Material sign = plain("sign");
    sign.is_unlit = true;
    const auto unlit = found(scene_of({sign}));
    CHECK_FALSE(unlit.facts);
    CHECK_THAT(unlit.complaints[0].help, Contains("unlit"));
    const auto mixed = found(scene_of({sign, plain("a")}));
    REQUIRE(mixed.facts);
    CHECK(mixed.facts->materials.size() == 1);
    CHECK(mixed.facts->materials[0].coverage == 1);
}

TEST_CASE("light functions know what the lights of their name give")
{
    using Kind = scene::Light::Kind;
    const auto light = [](Kind kind, double radius, std::optional<double> range) {
        scene::Light out;
        out.kind = kind;
        out.radius = radius;
        out.range = range;
        out.length = kind == Kind::tube ? 3 : 0;
        return out;
    };
    scene::Scene scene = scene_of({plain("a")});
    scene.lights = {light(Kind::directional, 0, {}), light(Kind::point, 0, {}),
                    light(Kind::point, 0, {}),       light(Kind::sphere, 0.25, 4),
                    light(Kind::sphere, 0.5, {}),    light(Kind::tube, 0, 2)};
    scene.lights.push_back(light(Kind::spot, 0, 8));
    scene.lights.back().inner_cone = 0;
    const SceneFacts facts = facts_of(scene);
    CHECK(facts.light_names ==
          std::vector<std::string>{"directional", "punctual", "sphere", "spot", "tube"});
    CHECK(facts.emitters.at("directional").ranges.empty());
    const optimize::Called& point = facts.emitters.at("punctual");
    CHECK(point.constants == optimize::Settings{{"inverse_range", {0}}});
    const optimize::Called& sphere = facts.emitters.at("sphere");
    CHECK(sphere.constants.empty());
    CHECK(sphere.ranges.at("radius") == ir::Range{25, 50});
    CHECK(sphere.ranges.at("inverse_range").low == 0);
    CHECK(sphere.ranges.at("inverse_range").high >= 1.0 / 400);
    CHECK(sphere.ranges.at("inverse_range").high < 1.0 / 399);
    CHECK(facts.emitters.at("tube").ranges.at("half_length") == ir::Range{150, 150});
    CHECK_FALSE(facts.emitters.at("tube").ranges.contains("radius"));
    const optimize::Called& spot = facts.emitters.at("spot");
    CHECK(spot.constants == optimize::Settings{{"cos_inner", {1}}});
    // A host computes the cosine in float.
    const ir::Range outer = spot.ranges.at("cos_outer");
    const auto in_float = static_cast<double>(std::cos(static_cast<float>(0.7853981633974483)));
    CHECK(outer.low <= in_float);
    CHECK(outer.high >= in_float);
}

TEST_CASE("lights are counted by kind")
{
    scene::Scene scene = scene_of({plain("a")});
    for (const auto kind :
         {scene::Light::Kind::point, scene::Light::Kind::tube, scene::Light::Kind::point}) {
        scene::Light light;
        light.kind = kind;
        scene.lights.push_back(light);
    }
    scene.lights[2].range = 5;
    const SceneFacts facts = facts_of(scene);
    REQUIRE(facts.lights.size() == 2);
    CHECK(facts.lights[0].kind == scene::Light::Kind::point);
    CHECK(facts.lights[0].count == 2);
    CHECK(facts.lights[0].ranged);
    CHECK(facts.lights[1].kind == scene::Light::Kind::tube);
    CHECK_FALSE(facts.lights[1].ranged);
}
