// The scenes of tests/data/scenes, and the limits on what a scene may be.
#include "scene/reading.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

using namespace lobe;
using namespace lobe::tests;
using nlohmann::json;

TEST_CASE("every scene of ours is read without a complaint, and shows its materials")
{
    std::set<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator{"data/scenes"}) {
        const auto path = file.path();
        if (path.extension() == ".gltf" || path.extension() == ".glb")
            names.insert(path.filename().string());
    }
    CHECK(names.size() >= 15);
    for (const std::string& name : names) {
        CAPTURE(name);
        const auto result = read_file(name);
        CHECK(told(result.complaints) == "");
        REQUIRE(result.scene);
        const auto& scene = *result.scene;
        CHECK(scene.shown_materials().size() == scene.materials.size());
        CHECK(scene.cameras.size() == 1);
        CHECK((scene.lights.empty() == scene.environment.has_value()));
    }
}

TEST_CASE("the spheres' area is that of spheres, less what their facets cut off")
{
    const auto scene = *read_file("mixed.gltf").scene;
    for (const double area : scene.coverage()) {
        // Facets of 32 x 16 lose at most 1 - cos(pi / 16) of either direction.
        CHECK(area < 4 * std::numbers::pi);
        CHECK(area > 4 * std::numbers::pi * (1 - 2 * (1 - std::cos(std::numbers::pi / 16))));
    }
}

TEST_CASE("a .glb file is the same scene as its .gltf twin")
{
    const auto apart = *read_file("textured.gltf").scene;
    const auto together = *read_file("textured.glb").scene;
    REQUIRE(apart.images.size() == together.images.size());
    for (std::size_t index = 0; index < apart.images.size(); ++index)
        CHECK(apart.images[index].pixels->rgba == together.images[index].pixels->rgba);
    CHECK(apart.coverage() == together.coverage());
    CHECK(apart.meshes[0].positions == together.meshes[0].positions);
    CHECK(apart.meshes[0].tangents == together.meshes[0].tangents);
    CHECK(apart.meshes[0].tangents.size() == apart.meshes[0].positions.size());
    CHECK(apart.materials[1].parameters.at("retroreflection").low ==
          together.materials[1].parameters.at("retroreflection").low);
}

TEST_CASE("a textured scene gives masks and ranges")
{
    const auto scene = *read_file("textured.gltf").scene;
    const auto& plates = scene.materials[0];
    const auto& surface = scene.images[plates.metallic.texture->image];
    CHECK(surface.channels[2].only_ends);
    CHECK_FALSE(surface.channels[1].only_ends);
    CHECK(surface.channels[1].low == 64.0F / 255);
    CHECK(surface.channels[1].high == 191.0F / 255);
    const auto& gain = scene.materials[1].parameters.at("retroreflection");
    CHECK(gain.low == std::vector<double>{4});
    CHECK(gain.offset == std::vector<double>{1});
    // 0.2 + 0.7 (1 +- 1) / 2, to a half of a step of 16 bits.
    const auto& channel = scene.images[gain.texture->image].channels[0];
    CHECK(channel.low == Approx(0.2).margin(0.5 / 65535));
    CHECK(channel.high == Approx(0.9).margin(0.5 / 65535));
}

TEST_CASE("everything in one small file: strip, sparse, stride, quantized")
{
    const auto scene = *read_file("small.glb").scene;
    const auto& mesh = scene.meshes.at(0);
    CHECK(mesh.positions[0] == scene::Vector3{-1, -1, 0});
    CHECK(mesh.positions[3] == scene::Vector3{1, 0, 0});  // sparse
    CHECK(mesh.normals[4] == scene::Vector3{0, 0, 1});
    CHECK(mesh.triangles.size() == 12);
    CHECK(mesh.coordinates[0][0] == std::array<float, 2>{0, 1});
    CHECK(scene.cameras[0].half_height == 3);
    CHECK_FALSE(scene.materials[0].base_color.texture->repeats_u);
    CHECK(scene.materials[0].base_color.texture->repeats_v);
    CHECK(scene.images[0].channels[0].only_ends);
}

TEST_CASE("sizes above a limit are told before anything is made of them")
{
    const auto with = [](const scene::Limits& limits) {
        return told(read_file("mixed.gltf", {.limits = limits}).complaints);
    };
    scene::Limits limits;
    limits.file_bytes = 100;
    CHECK(with(limits).ends_with("bytes are above the limit of 100\n"));
    limits = {};
    limits.file_bytes = 10'000;
    CHECK(with(limits) == "error /buffers/0/uri: 25956 bytes are above the limit of 10000\n");
    limits = {};
    limits.materials = 5;
    CHECK(with(limits) == "error /materials: 6 materials are above the limit of 5\n");
    limits = {};
    limits.nodes = 7;
    CHECK(with(limits) == "error /nodes: 8 nodes are above the limit of 7\n");
    limits = {};
    limits.vertices = 561 * 5;
    CHECK(with(limits) ==
          "error /meshes/5/primitives/0: with this primitive's 561 vertices all are "
          "above the limit of 2805\n");
    limits = {};
    limits.triangles = 960 * 5;
    CHECK(with(limits) == "error /meshes/5/primitives/0: with this primitive's triangles all are "
                          "above the limit of 4800\n");
    limits = {};
    limits.instances = 5;
    CHECK(with(limits) == "error /nodes/5/mesh: with this mesh more than 5 primitives are shown\n");
}

TEST_CASE("an accessor without bytes is no way around the limits")
{
    json document = empty_document();
    document["accessors"] = json::parse(
        R"([{"componentType": 5126, "type": "VEC3", "count": 1000000000000},
            {"componentType": 5125, "type": "SCALAR", "count": 1000000000000},
            {"componentType": 5126, "type": "VEC3", "count": 3}])");
    document["meshes"] = json::parse(R"([{"primitives": [{"attributes": {"POSITION": 0}},
                                         {"attributes": {"POSITION": 2}, "indices": 1}]}])");
    CHECK(
        told(read(document).complaints) ==
        "error /meshes/0/primitives/0: with this primitive's 1000000000000 vertices all are above "
        "the limit of 33554432\n"
        "error /meshes/0/primitives/1: with this primitive's triangles all are above the limit of "
        "67108864\n");
}

TEST_CASE("many nodes that distort one mesh are limited by what measuring them costs")
{
    json document = json::parse(slurp("base_only.gltf"));
    for (int node = 0; node < 3; ++node) document["nodes"][node]["scale"] = {1, 2, 1};
    const Files files{{"sphere.bin", slurp("sphere.bin")}};
    CHECK(read(document, files).scene);
    scene::Limits limits;
    limits.distorted_triangles = 960 * 2;
    CHECK(told(read(document, files, {.limits = limits}).complaints) ==
          "error : more than 1920 triangles are shown under scales that differ by axis\n");
}

TEST_CASE("no callback for files is as good as no files")
{
    const auto result = scene::read_gltf(slurp("base_only.gltf"), "a.gltf", nullptr);
    CHECK(
        told(result.complaints) ==
        "error /buffers/0/uri: this buffer cannot be read: `sphere.bin`: no files are read here\n");
}
