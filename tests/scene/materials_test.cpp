// What materials, lights and environments give.
#include "scene/reading.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace lobe;
using namespace lobe::tests;
using nlohmann::json;
using scene::Light;
using scene::Material;
using scene::Scene;

namespace {

using Numbers = std::vector<double>;

/// The first material, of a file that has one picture behind texture 0.
Material material(const std::string& text)
{
    json document = empty_document();
    document["images"] = {{{"uri", "one.png"}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"] = json::array({json::parse(text)});
    return read_clean(document, {{"one.png", slurp("plates_color.png")}}).materials.at(0);
}

Light light(const std::string& text)
{
    json document = empty_document();
    document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({json::parse(text)});
    document["nodes"] = json::parse(R"([{"extensions": {"KHR_lights_punctual": {"light": 0}},
                                         "translation": [1, 2, 3]}])");
    document["scenes"] = json::parse(R"([{"nodes": [0]}])");
    return read_clean(document).lights.at(0);
}

}  // namespace

TEST_CASE("factors are read, and defaults filled in")
{
    const auto plain = material("{}");
    CHECK(plain.pointer == "/materials/0");
    CHECK(plain.base_color.low == Numbers{1, 1, 1, 1});
    CHECK(plain.base_color.offset == Numbers{0, 0, 0, 0});
    CHECK(plain.emissive.low == Numbers{0, 0, 0});
    CHECK_FALSE(plain.metallic.is_given);
    CHECK(plain.alpha == Material::Alpha::opaque);
    CHECK_FALSE(plain.double_sided);

    const auto given = material(R"({"name": "x", "doubleSided": true, "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0,
                                 "roughnessFactor": 0.25}})");
    CHECK(given.name == "x");
    CHECK(given.double_sided);
    CHECK(given.alpha == Material::Alpha::blend);
    CHECK(given.base_color.low == Numbers{0.1, 0.2, 0.3, 0.4});
    CHECK(given.base_color.high == given.base_color.low);
    CHECK(given.base_color.pointer == "/materials/0/pbrMetallicRoughness/baseColorFactor");
    CHECK(given.metallic.low == Numbers{0});
    CHECK(given.metallic.is_given);
    CHECK(given.roughness.low == Numbers{0.25});
}

TEST_CASE("textures multiply, channel by channel")
{
    const auto textured = material(R"({
        "pbrMetallicRoughness": {
          "baseColorTexture": {"index": 0, "texCoord": 2, "extensions": {"KHR_texture_transform":
              {"offset": [0.25, 0.5], "rotation": 1.5, "scale": [4, 2], "texCoord": 1}}},
          "metallicRoughnessTexture": {"index": 0}, "roughnessFactor": 0.5},
        "emissiveTexture": {"index": 0}, "emissiveFactor": [0.5, 1, 1],
        "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0}})");
    REQUIRE(textured.base_color.texture);
    CHECK(textured.base_color.channels == std::vector<int>{0, 1, 2, 3});
    CHECK(textured.base_color.is_srgb);
    CHECK(textured.base_color.texture->coordinates == 1);
    CHECK(textured.base_color.texture->offset == std::array<double, 2>{0.25, 0.5});
    CHECK(textured.base_color.texture->scale == std::array<double, 2>{4, 2});
    CHECK(textured.base_color.texture->rotation == 1.5);
    CHECK(textured.base_color.pointer == "/materials/0/pbrMetallicRoughness/baseColorTexture");
    CHECK(textured.metallic.channels == std::vector<int>{2});
    CHECK(textured.metallic.low == Numbers{1});
    CHECK_FALSE(textured.metallic.is_srgb);
    CHECK(textured.roughness.channels == std::vector<int>{1});
    CHECK(textured.roughness.low == Numbers{0.5});
    CHECK(textured.roughness.texture);
    CHECK(textured.emissive.channels == std::vector<int>{0, 1, 2});
    CHECK(textured.emissive.is_srgb);
    CHECK(textured.normal_map);
    CHECK(textured.normal_scale == 0.5);
    CHECK(textured.occlusion_map);
}

TEST_CASE("ratified extensions are read under names of their own")
{
    const auto result = read_file("extensions.gltf");
    REQUIRE(told(result.complaints) == "");
    const auto& materials = result.scene->materials;
    const auto value = [&](std::size_t index, const std::string& name) {
        return materials[index].extensions.at(name).low;
    };
    CHECK(value(0, "anisotropy") == Numbers{0.6});
    CHECK(value(0, "anisotropy_rotation") == Numbers{0.5});
    CHECK(value(0, "ior") == Numbers{1.8});
    CHECK(value(1, "clearcoat") == Numbers{1});
    CHECK(value(1, "clearcoat_roughness") == Numbers{0.1});
    CHECK(value(1, "specular") == Numbers{0.7});
    CHECK(value(1, "specular_color") == Numbers{1, 0.9, 0.8});
    CHECK(value(2, "iridescence") == Numbers{0.8});
    CHECK(value(2, "iridescence_ior") == Numbers{1.4});
    CHECK(value(2, "iridescence_thickness_minimum") == Numbers{100});
    CHECK_FALSE(materials[2].extensions.at("iridescence_thickness_minimum").is_given);
    CHECK(value(2, "iridescence_thickness_maximum") == Numbers{500});
    CHECK(value(3, "sheen_color") == Numbers{0.5, 0.2, 0.4});
    CHECK(value(3, "sheen_roughness") == Numbers{0.5});
    CHECK(value(4, "transmission") == Numbers{0.9});
    CHECK(value(4, "thickness") == Numbers{0.5});
    CHECK(value(4, "attenuation_distance") == Numbers{2});
    CHECK(value(4, "attenuation_color") == Numbers{0.8, 0.9, 1});
    CHECK(value(4, "dispersion") == Numbers{0.1});
    CHECK(materials[5].is_unlit);
    CHECK(materials[6].emissive.low == Numbers{5, 4, 2.5});
    CHECK(materials[6].extensions.empty());
    CHECK(materials[3].extensions.size() == 2);
}

TEST_CASE("an unlimited distance is none, and a turned direction is any")
{
    const auto volume = material(R"({"extensions": {"KHR_materials_volume": {}}})");
    CHECK(volume.extensions.contains("thickness"));
    CHECK_FALSE(volume.extensions.contains("attenuation_distance"));
    const auto turned = material(R"({"extensions": {"KHR_materials_anisotropy":
        {"anisotropyRotation": 1, "anisotropyTexture": {"index": 0}}}})");
    const auto& rotation = turned.extensions.at("anisotropy_rotation");
    CHECK(rotation.low == Numbers{1 - std::numbers::pi});
    CHECK(rotation.high == Numbers{1 + std::numbers::pi});
}

TEST_CASE("a model's own parameters are constants, ranges and textures")
{
    const auto given = material(R"({"extras": {"other": 1, "lobe": {"parameters": {
        "a": 2, "b": [1, 0.5, 0.25], "c": {"min": -1, "max": 3}, "d": {"min": [0, 0], "max": 2},
        "e": {"texture": {"index": 0, "channel": "g", "texCoord": 1}},
        "f": {"texture": {"index": 0, "channels": "rgb", "srgb": true}, "scale": 2,
              "offset": [0, 0.5, 1]}}}}})");
    const auto& parameters = given.parameters;
    CHECK(parameters.size() == 6);
    CHECK(parameters.at("a").low == Numbers{2});
    CHECK(parameters.at("a").pointer == "/materials/0/extras/lobe/parameters/a");
    CHECK(parameters.at("a").is_given);
    CHECK(parameters.at("b").high == Numbers{1, 0.5, 0.25});
    CHECK(parameters.at("c").low == Numbers{-1});
    CHECK(parameters.at("c").high == Numbers{3});
    CHECK(parameters.at("d").low == Numbers{0, 0});
    CHECK(parameters.at("d").high == Numbers{2, 2});
    CHECK(parameters.at("e").channels == std::vector<int>{1});
    CHECK(parameters.at("e").low == Numbers{1});
    CHECK(parameters.at("e").texture->coordinates == 1);
    CHECK_FALSE(parameters.at("e").is_srgb);
    CHECK(parameters.at("f").channels == std::vector<int>{0, 1, 2});
    CHECK(parameters.at("f").low == Numbers{2, 2, 2});
    CHECK(parameters.at("f").offset == Numbers{0, 0.5, 1});
    CHECK(parameters.at("f").is_srgb);
}

TEST_CASE("extras of other programs are nobody's business")
{
    CHECK(material(R"({"extras": 3})").parameters.empty());
    CHECK(material(R"({"extras": {"lobes": {"parameters": 3}}})").parameters.empty());
}

TEST_CASE("layers are materials with weights, and shown with what they cover")
{
    const auto result = read_file("layers.gltf");
    REQUIRE(told(result.complaints) == "");
    Scene scene = *result.scene;
    const auto& layers = scene.materials[0].layers;
    REQUIRE(layers.size() == 2);
    CHECK(layers[0].material == 1);
    CHECK(layers[0].weight.low == Numbers{0.35});
    CHECK(layers[1].material == 2);
    CHECK(layers[1].weight.texture);
    CHECK(scene.shown_materials() == std::vector<std::size_t>{0, 1, 2});
    scene.instances.resize(1);
    CHECK(scene.shown_materials() == std::vector<std::size_t>{0, 1, 2});
    scene.materials[0].layers.resize(1);
    CHECK(scene.shown_materials() == std::vector<std::size_t>{0, 1});
}

TEST_CASE("layers of layers end")
{
    constexpr int count = 50'000;
    const auto document = [](const std::string& last) {
        std::string text = R"({"asset":{"version":"2.0"},"materials":[)";
        for (int index = 1; index < count; ++index)
            text += R"({"extras":{"lobe":{"layers":[{"weight":0.5,"material":)" +
                    std::to_string(index) + "}]}}},";
        return text + last + "]}";
    };
    CHECK(read_bytes(document("{}")).scene);
    const std::string back = R"({"extras":{"lobe":{"layers":[{"weight":0.5,"material":9999}]}}})";
    CHECK(told(read_bytes(document(back)).complaints) ==
          "error /materials/0/extras/lobe/layers: these layers lead to a material that lies over "
          "itself\n");
}

TEST_CASE("lights have the units and defaults of the format")
{
    const auto point = light(R"({"type": "point"})");
    CHECK(point.kind == Light::Kind::point);
    CHECK(point.color == scene::Color{1, 1, 1});
    CHECK(point.intensity == 1);
    CHECK_FALSE(point.range);
    CHECK(point.world[12] == 1);
    CHECK(point.world[13] == 2);
    CHECK(point.world[14] == 3);
    CHECK(point.pointer == "/extensions/KHR_lights_punctual/lights/0");

    const auto spot = light(R"({"type": "spot", "range": 5, "spot": {}})");
    CHECK(spot.kind == Light::Kind::spot);
    CHECK(spot.range == 5);
    CHECK(spot.inner_cone == 0);
    CHECK(spot.outer_cone == std::numbers::pi / 4);
    CHECK(light(R"({"type": "spot", "spot": {"outerConeAngle": 1.5707964}})").outer_cone ==
          std::numbers::pi / 2);

    CHECK(light(R"({"type": "directional"})").kind == Light::Kind::directional);
    const auto sphere = light(R"({"type": "point", "extras": {"lobe": {"radius": 0.5}}})");
    CHECK(sphere.kind == Light::Kind::sphere);
    CHECK(sphere.radius == 0.5);
    const auto tube = light(R"({"type": "point", "extras": {"lobe": {"radius": 1, "length": 2}}})");
    CHECK(tube.kind == Light::Kind::tube);
    CHECK(tube.length == 2);
}

TEST_CASE("lights are those of the shown nodes, as often as these carry them")
{
    const auto result = read_file("lights.gltf");
    REQUIRE(result.scene);
    std::vector<Light::Kind> kinds;
    for (const Light& each : result.scene->lights) kinds.push_back(each.kind);
    using enum Light::Kind;
    CHECK(kinds == std::vector<Light::Kind>{directional, point, spot, sphere, tube});
    json document = json::parse(slurp("lights.gltf"));
    document["scenes"][0]["nodes"] = {4};
    CHECK(read_clean(document, {{"sphere.bin", slurp("sphere.bin")}}).lights.size() == 1);
}

TEST_CASE("an environment is read with its mips and harmonics")
{
    const auto result = read_file("environment.gltf");
    REQUIRE(told(result.complaints) == "");
    const auto& environment = result.scene->environment;
    REQUIRE(environment);
    CHECK(environment->name == "noon");
    CHECK(environment->specular_size == 16);
    REQUIRE(environment->specular.size() == 5);
    CHECK(environment->specular[4][5] == 29);
    CHECK(result.scene->images[29].width == 1);
    CHECK(result.scene->images[0].pixels->rgba.size() == 16 * 16 * 4);
    // The sky is brighter above than below: the coefficient of y is positive.
    CHECK(environment->irradiance[1][2] > 0);
    CHECK(environment->rotation == std::array<double, 4>{0, 0, 0, 1});
}

TEST_CASE("a hundred thousand materials are read, and one more is not")
{
    std::string text = R"({"asset":{"version":"2.0"},"materials":[{})";
    const std::string next = R"(,{"extras":{"lobe":{"parameters":{"gain":3,"tint":[1,0.5,0.5]}}}})";
    for (int index = 1; index < 100'000; ++index) text += next;
    const auto most = read_bytes(text + "]}");
    REQUIRE(most.scene);
    CHECK(most.scene->materials.size() == 100'000);
    CHECK(told(read_bytes(text + next + "]}").complaints) ==
          "error /materials: 100001 materials are above the limit of 100000\n");
}
