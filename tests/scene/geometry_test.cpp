// Accessors, primitives and nodes: what stands where.
#include "scene/reading.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

using namespace lobe;
using namespace lobe::tests;
using nlohmann::json;
using scene::Vector3;

namespace {

/// A scene of one node with one mesh, whose only primitive has these positions.
json with_positions(const std::vector<float>& positions)
{
    json document = empty_document();
    document["scenes"] = {{{"nodes", {0}}}};
    document["nodes"] = {{{"mesh", 0}}};
    const auto accessor =
        add_accessor(document, pack(positions), 5126, "VEC3", positions.size() / 3);
    document["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", accessor}}}}}}}};
    return document;
}

json& primitive(json& document) { return document["meshes"][0]["primitives"][0]; }

const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

std::vector<std::uint32_t> triangles(const json& document)
{
    return read_clean(document).meshes.at(0).triangles;
}

/// What an attribute's first element is, from the bytes of four of them.
template <typename Number>
std::vector<float> coordinates(std::vector<Number> numbers, int type, bool normalized)
{
    json document = with_positions(square);
    document["extensionsUsed"] = {"KHR_mesh_quantization"};
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    numbers.resize(8);
    primitive(document)["attributes"]["TEXCOORD_1"] =
        add_accessor(document, pack(numbers), type, "VEC2", 4, normalized);
    const auto scene = read_clean(document);
    const auto& uv = scene.meshes.at(0).coordinates[1].at(0);
    return {uv[0], uv[1]};
}

}  // namespace

TEST_CASE("every component type is read, and normalized as the format has it")
{
    using Floats = std::vector<float>;
    CHECK(coordinates<float>({0.25F, -3}, 5126, false) == Floats{0.25F, -3});
    CHECK(coordinates<std::uint8_t>({255, 51}, 5121, true) == Floats{1, 0.2F});
    CHECK(coordinates<std::uint8_t>({255, 51}, 5121, false) == Floats{255, 51});
    CHECK(coordinates<std::int8_t>({-128, 127}, 5120, true) == Floats{-1, 1});
    CHECK(coordinates<std::int8_t>({-128, 127}, 5120, false) == Floats{-128, 127});
    CHECK(coordinates<std::uint16_t>({65535, 13107}, 5123, true) == Floats{1, 0.2F});
    CHECK(coordinates<std::int16_t>({-32768, 32767}, 5122, true) == Floats{-1, 1});
    CHECK(coordinates<std::int16_t>({-32768, 32767}, 5122, false) == Floats{-32768, 32767});
}

TEST_CASE("integers need the extension")
{
    json document = with_positions(square);
    primitive(document)["attributes"]["TEXCOORD_0"] =
        add_accessor(document, pack<std::int8_t>({0, 0, 0, 0, 0, 0, 0, 0}), 5120, "VEC2", 4, true);
    CHECK(told(read(document).complaints) ==
          "error /meshes/0/primitives/0/attributes/TEXCOORD_0: TEXCOORD_0 takes no accessor of "
          "this type (integers need `KHR_mesh_quantization` in `extensionsRequired`)\n");
}

TEST_CASE("elements may stand apart, and begin inside a view")
{
    json document = with_positions(square);
    // Position, then four bytes that belong to nothing, behind four more.
    std::vector<float> bytes{-1};
    for (std::size_t vertex = 0; vertex < 4; ++vertex) {
        bytes.insert(bytes.end(), square.begin() + static_cast<std::ptrdiff_t>(3 * vertex),
                     square.begin() + static_cast<std::ptrdiff_t>(3 * vertex + 3));
        if (vertex < 3) bytes.push_back(-1);
    }
    const auto accessor = add_accessor(document, pack(bytes), 5126, "VEC3", 4);
    document["bufferViews"][1]["byteStride"] = 16;
    document["accessors"][accessor]["byteOffset"] = 4;
    primitive(document)["attributes"]["POSITION"] = accessor;
    const auto scene = read_clean(document);
    CHECK(scene.meshes[0].positions ==
          std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
}

TEST_CASE("sparse values replace those of the view, or zeros")
{
    json document = with_positions(square);
    add_accessor(document, pack<std::uint8_t>({1, 3}), 5121, "SCALAR", 2);
    add_accessor(document, pack<float>({5, 6, 7, 8, 9, 10}), 5126, "VEC3", 2);
    json& accessor = document["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", 1}, {"componentType", 5121}}},
                          {"values", {{"bufferView", 2}}}};
    CHECK(read_clean(document).meshes[0].positions ==
          std::vector<Vector3>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}, {8, 9, 10}});
    accessor.erase("bufferView");
    CHECK(read_clean(document).meshes[0].positions ==
          std::vector<Vector3>{{0, 0, 0}, {5, 6, 7}, {0, 0, 0}, {8, 9, 10}});
}

TEST_CASE("numbers in buffers are finite")
{
    for (const float bad :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        json document = with_positions({0, 0, 0, 1, bad, 0, 0, 1, 0});
        CHECK(told(read(document).complaints) == "error /accessors/0: element 1 is not finite\n");
    }
}

TEST_CASE("lists, strips and fans become triangles; points and lines none")
{
    using Indices = std::vector<std::uint32_t>;
    json document = with_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0});
    CHECK(triangles(document) == Indices{0, 1, 2});  // two vertices are left over
    primitive(document)["mode"] = 5;
    CHECK(triangles(document) == Indices{0, 1, 2, 1, 3, 2, 2, 3, 4});
    primitive(document)["mode"] = 6;
    CHECK(triangles(document) == Indices{1, 2, 0, 2, 3, 0, 3, 4, 0});
    for (const int mode : {0, 1, 2, 3}) {
        primitive(document)["mode"] = mode;
        CHECK(triangles(document).empty());
    }
    primitive(document)["mode"] = 5;
    primitive(document)["indices"] =
        add_accessor(document, pack<std::uint32_t>({0, 1, 2, 2, 3, 4}), 5125, "SCALAR", 6);
    CHECK(triangles(document) == Indices{0, 1, 2, 2, 4, 3});  // two without an area are left out
}

TEST_CASE("an index past the vertices is told, also the one that would restart a strip")
{
    json document = with_positions(square);
    primitive(document)["indices"] =
        add_accessor(document, pack<std::uint8_t>({0, 1, 255}), 5121, "SCALAR", 3);
    CHECK(told(read(document).complaints) ==
          "error /meshes/0/primitives/0/indices: index 255 at 2 is past the 4 vertices\n");
}

TEST_CASE("colors of three components are opaque")
{
    json document = with_positions(square);
    primitive(document)["attributes"]["COLOR_0"] =
        add_accessor(document, std::string(12, '\xFF'), 5121, "VEC3", 4, true);
    CHECK(read_clean(document).meshes[0].colors ==
          std::vector<std::array<float, 4>>(4, {1, 1, 1, 1}));
}

TEST_CASE("what colors of vertices hold is known without the colors")
{
    json document = with_positions(square);
    const auto first = read(document, {}, {.geometry = false});
    REQUIRE(first.scene);
    CHECK(first.scene->meshes[0].least_color == scene::Vector3{1, 1, 1});
    const std::vector<std::uint8_t> bytes{0, 51, 255, 102, 51, 255, 51, 255, 255, 0, 0, 255};
    primitive(document)["attributes"]["COLOR_0"] =
        add_accessor(document, pack<std::uint8_t>(bytes), 5121, "VEC3", 4, true);
    const auto result = read(document, {}, {.geometry = false});
    REQUIRE(result.scene);
    const scene::Mesh& mesh = result.scene->meshes[0];
    CHECK(mesh.colors.empty());
    CHECK(mesh.least_color == scene::Vector3{0, 0, 1});
    CHECK(mesh.greatest_color == scene::Vector3{0.4F, 1, 1});
    CHECK_FALSE(mesh.has_tangents);
}

TEST_CASE("nodes nest: moved, turned and scaled, or by a matrix")
{
    json document = with_positions(square);
    const double half = std::sqrt(0.5);
    document["nodes"] = json::parse(R"([{"children": [1], "scale": [2, 2, 2]},
        {"mesh": 0, "children": [2]}, {"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}])");
    document["nodes"][1]["translation"] = {0, 0, 1};
    document["nodes"][1]["rotation"] = {0, 0, half, half};  // x to y
    const auto scene = read_clean(document);
    REQUIRE(scene.instances.size() == 2);
    const auto at = [&](std::size_t instance, const std::array<double, 3>& point) {
        const auto& m = scene.instances[instance].world;
        std::array<double, 3> moved{};
        for (std::size_t row = 0; row < 3; ++row)
            moved[row] =
                m[row] * point[0] + m[4 + row] * point[1] + m[8 + row] * point[2] + m[12 + row];
        return moved;
    };
    // Two roundings of sqrt(1/2) enter each product.
    const double rounding = 8 * std::numeric_limits<double>::epsilon();
    const auto first = at(0, {1, 0, 0});
    CHECK(first[0] == Approx(0).margin(rounding));
    CHECK(first[1] == Approx(2).margin(rounding));
    CHECK(first[2] == 2);
    const auto second = at(1, {1, 0, 0});
    CHECK(second[0] == Approx(0).margin(5 * rounding));
    CHECK(second[1] == Approx(12).margin(5 * rounding));
    // One triangle of half a square meter under a scale of 2.
    CHECK(scene.instances[1].area == Approx(2).epsilon(rounding));
    CHECK(scene.coverage()[0] == Approx(4).epsilon(rounding));
}

TEST_CASE("areas are of the world, also where axes are scaled apart")
{
    json document = with_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    document["nodes"][0]["scale"] = {3, 5, -7};
    CHECK(read_clean(document).instances[0].area == 7.5);
    document["nodes"][0]["scale"] = {0, 5, 1};
    CHECK(read_clean(document).instances[0].area == 0);
    CHECK(read_clean(document).coverage() == std::vector<double>{1});  // no area: all the same
}

TEST_CASE("only the default scene is shown, else the first")
{
    json document = with_positions(square);
    document["nodes"] = json::parse(R"([{}, {"mesh": 0}])");
    document["scenes"] = json::parse(R"([{"nodes": [0]}, {"nodes": [1, 0]}])");
    CHECK(read_clean(document).instances.empty());
    document["scene"] = 1;
    CHECK(read_clean(document).instances.size() == 1);
}

TEST_CASE("very many nodes in one line are placed")
{
    constexpr std::size_t count = 300'000;
    std::string text = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)";
    for (std::size_t node = 0; node + 1 < count; ++node)
        text += R"({"children":[)" + std::to_string(node + 1) + "]},";
    const auto line = read_bytes(text + "{}]}");
    CHECK(told(line.complaints) == "");
    const auto ring = read_bytes(text + R"({"children":[0]}]})");
    CHECK_FALSE(ring.scene);
    CHECK(ring.complaints.at(0).message == "this node is its own ancestor, or below one that is");
}

TEST_CASE("without geometry areas are still known")
{
    const auto whole = read_file("mixed.gltf");
    const auto facts = read_file("mixed.gltf", {.geometry = false});
    REQUIRE(facts.scene);
    CHECK(facts.scene->coverage() == whole.scene->coverage());
    CHECK(facts.scene->meshes[0].positions.empty());
    CHECK(facts.scene->meshes[0].triangles.empty());
    CHECK_FALSE(whole.scene->meshes[0].triangles.empty());
}

TEST_CASE("a primitive without a material has the format's default, behind the file's")
{
    json document = with_positions(square);
    document["materials"] = json::parse(R"([{"name": "unused"}])");
    const auto scene = read_clean(document);
    REQUIRE(scene.materials.size() == 2);
    CHECK(scene.meshes[0].material == 1);
    CHECK(scene.shown_materials() == std::vector<std::size_t>{1});
    CHECK(scene.coverage() == std::vector<double>{0, 0.5});
}
