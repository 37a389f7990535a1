// What a scene says of surfaces is true of everything that it can show, exact where it is constant.
#include "analyze/residual/reach.h"
#include "analyze/toy_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace lobe;
using namespace lobe::tests;
using analyze::InputFact;
using analyze::SceneFacts;

namespace {

/// A picture of one row whose channels hold these texels.
scene::Image image_of(const std::vector<float>& texels)
{
    scene::Image image;
    for (scene::ChannelFacts& channel : image.channels)
        channel = {
            *std::min_element(texels.begin(), texels.end()),
            *std::max_element(texels.begin(), texels.end()),
            std::all_of(texels.begin(), texels.end(), [](float t) { return t == 0 || t == 1; })};
    return image;
}

scene::Value textured(scene::Value value, std::size_t image, bool is_filtered = true)
{
    value.texture = scene::Texture{};
    value.texture->image = image;
    value.texture->is_filtered = is_filtered;
    for (std::size_t k = 0; k < value.low.size(); ++k) value.channels.push_back(0);
    return value;
}

}  // namespace

TEST_CASE("a surface is glTF's")
{
    SECTION("of what is no metal")
    {
        const SceneFacts facts = facts_of(scene_of({plain("a")}));
        CHECK(range_of(facts, "f0") == ir::Range{0.04, 0.04});
        CHECK(range_of(facts, "diffuse_color") == ir::Range{0.5, 0.5});
        CHECK(range_of(facts, "metallic") == ir::Range{0, 0});
    }
    SECTION("of metal")
    {
        scene::Material metal = plain("metal");
        metal.metallic = constant({1});
        const SceneFacts facts = facts_of(scene_of({metal}));
        CHECK(range_of(facts, "f0") == ir::Range{0.5, 0.5});
        CHECK(range_of(facts, "diffuse_color") == ir::Range{0, 0});
    }
    SECTION("of anything between")
    {
        scene::Material any = plain("any");
        any.metallic = between({0}, {1});
        const SceneFacts facts = facts_of(scene_of({any}));
        CHECK(range_of(facts, "f0") == ir::Range{0.04, 0.5});
        CHECK(range_of(facts, "diffuse_color") == ir::Range{0, 0.5});
    }
    SECTION("with an index of refraction and a specular strength")
    {
        scene::Material glass = plain("glass");
        glass.extensions["ior"] = constant({2});  // (1/3)^2
        glass.extensions["specular"] = constant({0.5});
        const SceneFacts facts = facts_of(scene_of({glass}));
        CHECK(range_of(facts, "f0").low == Approx(1.0 / 18));
        CHECK(facts.materials[0].inputs.at("f0").is_constant());
    }
    SECTION("never smoother than the language knows")
    {
        scene::Material mirror = plain("mirror");
        mirror.roughness = constant({0});
        CHECK(range_of(facts_of(scene_of({mirror})), "roughness") == ir::Range{0x1p-6, 0x1p-6});
    }
}

TEST_CASE("a texture gives the range of its texels times the factor")
{
    scene::Scene scene = scene_of({with("gain", textured(constant({4}), 0))});
    scene.images.push_back(image_of({0.25F, 0.5F, 0.75F}));
    CHECK(range_of(facts_of(scene), "gain") == ir::Range{1, 3});

    SECTION("decoded where it is sRGB")
    {
        scene.images[0].linear[0] = {0.125F, 0.5F, false};
        scene.materials[0].parameters["gain"].is_srgb = true;
        CHECK(range_of(facts_of(scene), "gain") == ir::Range{0.5, 2});
    }
    SECTION("with an offset")
    {
        scene.materials[0].parameters["gain"].offset = {1};
        CHECK(range_of(facts_of(scene), "gain") == ir::Range{2, 4});
    }
}

namespace {

/// Shown by a mesh whose vertices have colors between these.
scene::Scene shown_with(scene::Material material, const scene::Vector3& least,
                        const scene::Vector3& greatest)
{
    scene::Scene scene = scene_of({std::move(material)});
    scene::Mesh mesh;
    mesh.pointer = "/meshes/0/primitives/0";
    mesh.least_color = least;
    mesh.greatest_color = greatest;
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, {}, 1});
    return scene;
}

}  // namespace

TEST_CASE("colors of vertices multiply the base color")
{
    scene::Material white = plain("white");
    white.base_color = constant({1, 1, 1, 1});
    const SceneFacts plain_white = facts_of(shown_with(white, {1, 1, 1}, {1, 1, 1}));
    CHECK(plain_white.called().constants.contains("diffuse_color"));

    const SceneFacts facts = facts_of(shown_with(white, {0.25F, 0.5F, 1}, {0.5F, 0.5F, 1}));
    const InputFact& color = facts.materials[0].inputs.at("diffuse_color");
    // One number, and what rounding in a shader can make of a range.
    CHECK(color.components[1] == ir::Range{0.5, 0.5});
    CHECK(color.components[2] == ir::Range{1, 1});
    CHECK(color.components[0].low <= 0.25);
    CHECK(color.components[0].high >= 0.5);
    CHECK(color.components[0].high < 0.5 * (1 + 0x1p-20));
    CHECK_FALSE(facts.called().constants.contains("diffuse_color"));
    CHECK(facts.called().ranges.at("diffuse_color").low <= 0.25);

    // A second mesh without colors shows the material as it is.
    scene::Scene both = shown_with(white, {0.25F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F});
    both.meshes.emplace_back();
    both.instances.push_back({1, {}, 1});
    CHECK(range_of(facts_of(both), "diffuse_color").high == 1);

    scene::Material unset = plain("unset");
    unset.base_color.is_given = false;
    const SceneFacts named = facts_of(shown_with(unset, {0, 0, 0}, {1, 1, 1}));
    CHECK(named.materials[0].inputs.at("diffuse_color").called_by ==
          "/meshes/0/primitives/0/attributes/COLOR_0");
}

TEST_CASE("float products with colors of vertices lie in the ranges")
{
    std::mt19937 random{3};
    std::uniform_real_distribution<float> unit{0, 1};
    for (int trial = 0; trial < 2000; ++trial) {
        const double factor = static_cast<double>(unit(random));
        const float texel = unit(random);
        const float low = unit(random);
        const float high = low + (1 - low) * unit(random);
        scene::Material material = plain("m");
        material.base_color = textured(constant({factor, factor, factor, 1}), 0);
        scene::Scene scene = shown_with(material, {low, low, low}, {high, high, high});
        scene.images.push_back(image_of({0.5F * texel, texel}));
        const ir::Range range = range_of(facts_of(scene), "diffuse_color");
        for (const float color : {low, high})
            for (const float t : {0.5F * texel, texel}) {
                const float value = static_cast<float>(factor) * t * color;
                CAPTURE(factor, t, color, range.low, range.high);
                REQUIRE(static_cast<double>(value) >= range.low);
                REQUIRE(static_cast<double>(value) <= range.high);
            }
    }
}

TEST_CASE("a mask of 0 and 1 is binary where no filter blends its texels")
{
    const auto metallic = [](const std::vector<float>& texels, bool is_filtered, double factor) {
        scene::Material material = plain("m");
        material.metallic = textured(constant({factor}), 0, is_filtered);
        scene::Scene scene = scene_of({material});
        scene.images.push_back(image_of(texels));
        const SceneFacts facts = facts_of(scene);
        CHECK(facts.called().binary.contains("metallic") ==
              facts.materials[0].inputs.at("metallic").is_binary);
        return facts.materials[0].inputs.at("metallic").is_binary;
    };
    CHECK(metallic({0, 1, 1}, false, 1));
    CHECK_FALSE(metallic({0, 1, 1}, true, 1));
    CHECK_FALSE(metallic({0, 0.5F, 1}, false, 1));
    CHECK_FALSE(metallic({0, 1}, false, 0.5));
    CHECK(metallic({0, 1}, true, 0));  // 0 everywhere
}

TEST_CASE("what a shader computes in float lies in the ranges")
{
    // Factors and texels are rounded to float, and so is their product.
    std::mt19937 random{1};
    std::uniform_real_distribution<double> unit{0, 1};
    for (int trial = 0; trial < 2000; ++trial) {
        const double low = 8 * unit(random) * unit(random);
        const double high = low + (8 - low) * unit(random);
        const auto texel = static_cast<float>(unit(random));
        scene::Scene scene = scene_of({with("gain", textured(between({low}, {high}), 0))});
        scene.images.push_back(image_of({0.125F * texel, texel}));
        const ir::Range range = range_of(facts_of(scene), "gain");
        for (const double factor : {low, high})
            for (const float t : {0.125F * texel, texel}) {
                const float value = static_cast<float>(factor) * t;
                CAPTURE(low, high, texel, range.low, range.high, value);
                REQUIRE(static_cast<double>(value) >= range.low);
                REQUIRE(static_cast<double>(value) <= range.high);
            }
    }
}

TEST_CASE("ranges are told, and promised, in few digits around them")
{
    const SceneFacts facts = facts_of(scene_of(
        {with("gain", between({static_cast<double>(0.3F)}, {static_cast<double>(0.7F)}))}));
    // In floats 0.30000001192..., 0.699999988...
    CHECK(range_of(facts, "gain").low == static_cast<double>(0.3F));
    CHECK(facts.called().ranges.at("gain") == ir::Range{0.3, 0.7});
    CHECK(facts.effects[0].why == "gain in [0.3, 0.7]");

    std::mt19937 random{4};
    std::uniform_real_distribution<double> exponent{-30, 30};
    for (int trial = 0; trial < 10'000; ++trial) {
        const double size = std::exp2(exponent(random));
        const ir::Range range{trial % 2 == 0 ? size : -size, 2 * size};
        const ir::Range told = analyze::in_digits(range);
        CAPTURE(range.low, range.high);
        REQUIRE(told.low <= range.low);
        REQUIRE(told.high >= range.high);
        // Within one of the sixth digit, which is at most 1e-5 of the number.
        REQUIRE(range.low - told.low <= 1e-5 * std::abs(range.low));
        REQUIRE(told.high - range.high <= 1e-5 * std::abs(range.high));
        REQUIRE(std::stod(fmt::format("{:.6g}", told.low)) == told.low);
        REQUIRE(std::stod(fmt::format("{:.6g}", told.high)) == told.high);
    }
    CHECK(analyze::in_digits({0, 1}) == ir::Range{0, 1});
    CHECK(analyze::in_digits({0.999999999, 9.9999999}) == ir::Range{0.999999, 10});
}
