// Scenes for tests.
#include "scene/reading.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace lobe::tests {

using nlohmann::json;

namespace {

std::optional<std::string> bytes_of(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    if (!file) return std::nullopt;
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

const std::string folder = "data/scenes/";

}  // namespace

scene::ReadScene read_bytes(std::string_view bytes, const Files& files,
                            const scene::ReadOptions& options)
{
    const scene::Fetch fetch = [&](const std::string& path) {
        const auto found = files.find(path);
        if (found == files.end()) return scene::Fetched{std::nullopt, "no such file"};
        return scene::Fetched{found->second, ""};
    };
    return scene::read_gltf(bytes, "test.gltf", fetch, options);
}

scene::ReadScene read(const json& document, const Files& files, const scene::ReadOptions& options)
{
    return read_bytes(document.dump(), files, options);
}

scene::Scene read_clean(const json& document, const Files& files, const scene::ReadOptions& options)
{
    auto result = read(document, files, options);
    REQUIRE(told(result.complaints) == "");
    REQUIRE(result.scene);
    return std::move(*result.scene);
}

std::string slurp(const std::string& name)
{
    auto bytes = bytes_of(folder + name);
    INFO(name);
    REQUIRE(bytes);
    return std::move(*bytes);
}

scene::ReadScene read_file(const std::string& name, const scene::ReadOptions& options)
{
    const scene::Fetch fetch = [](const std::string& path) {
        auto bytes = bytes_of(folder + path);
        return scene::Fetched{bytes, bytes ? "" : "no such file"};
    };
    return scene::read_gltf(slurp(name), folder + name, fetch, options);
}

std::string told(const std::vector<scene::Complaint>& complaints)
{
    std::string text;
    for (const scene::Complaint& complaint : complaints)
        text += fmt::format("{} {}: {}{}\n", complaint.is_error ? "error" : "note",
                            complaint.pointer, complaint.message,
                            complaint.help.empty() ? "" : fmt::format(" ({})", complaint.help));
    return text;
}

std::string base64(std::string_view bytes)
{
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t bits = 0;
        for (std::size_t byte = 0; byte < 3; ++byte)
            bits = bits << 8U |
                   (at + byte < bytes.size() ? static_cast<unsigned char>(bytes[at + byte]) : 0U);
        for (std::size_t digit = 0; digit < 4; ++digit)
            text.push_back(at + digit > bytes.size()
                               ? '='
                               : digits[bits >> static_cast<unsigned>(6 * (3 - digit)) & 63U]);
    }
    return text;
}

json empty_document() { return {{"asset", {{"version", "2.0"}}}}; }

std::size_t add_accessor(json& document, std::string_view bytes, int component_type,
                         std::string_view type, std::size_t count, bool normalized)
{
    json& buffers = document["buffers"];
    json& views = document["bufferViews"];
    json& accessors = document["accessors"];
    buffers.push_back({{"byteLength", bytes.size()},
                       {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    views.push_back({{"buffer", buffers.size() - 1}, {"byteLength", bytes.size()}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", component_type},
                         {"type", type},
                         {"count", count},
                         {"normalized", normalized}});
    return accessors.size() - 1;
}

json one_of_everything()
{
    json document = json::parse(R"({
      "asset": {"version": "2.0", "minVersion": "2.0"},
      "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_ior", "KHR_texture_transform"],
      "extensionsRequired": ["KHR_texture_transform"],
      "scene": 0,
      "scenes": [{"nodes": [0], "extensions": {"EXT_lights_image_based": {"light": 0}}}],
      "nodes": [
        {"children": [1, 2], "translation": [0, 1, 0], "rotation": [0, 0, 0, 1], "scale": [2, 2, 2]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}
      ],
      "cameras": [
        {"type": "perspective",
         "perspective": {"yfov": 0.7, "znear": 0.1, "zfar": 10, "aspectRatio": 1.5}},
        {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 5}}
      ],
      "extensions": {
        "KHR_lights_punctual": {"lights": [
          {"type": "spot", "color": [1, 0.5, 0], "intensity": 3, "range": 4,
           "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
          {"type": "point", "extras": {"lobe": {"radius": 0.5, "length": 1}}}
        ]},
        "EXT_lights_image_based": {"lights": [
          {"intensity": 2, "rotation": [0, 1, 0, 0],
           "irradianceCoefficients": [[1, 1, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0],
                                      [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]],
           "specularImageSize": 1, "specularImages": [[0, 0, 0, 0, 0, 0]]}
        ]}
      },
      "materials": [
        {"name": "first",
         "pbrMetallicRoughness": {
           "baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
           "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {
             "KHR_texture_transform": {"offset": [0, 0], "scale": [1, 1], "rotation": 1}}}},
         "normalTexture": {"index": 0, "scale": 1}, "occlusionTexture": {"index": 0, "strength": 1},
         "emissiveFactor": [1, 1, 1], "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true,
         "extensions": {"KHR_materials_ior": {"ior": 1.4}},
         "extras": {"lobe": {
           "parameters": {
             "constant": 2, "color": [1, 0.5, 0.25], "ranged": {"min": 0, "max": 1},
             "shown": {"texture": {"index": 0, "channel": "g"}, "scale": 2, "offset": 1}},
           "layers": [{"material": 1, "weight": 0.5}]}}},
        {}
      ],
      "textures": [{"source": 0, "sampler": 0}],
      "samplers": [{"wrapS": 33071, "wrapT": 10497}],
      "images": [{"uri": "one.png"}],
      "meshes": [{"primitives": [
        {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": 4}]}]
    })");
    add_accessor(document, pack<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 5126, "VEC3", 3);
    add_accessor(document, pack<std::uint8_t>({0, 0, 255, 0, 0, 255}), 5121, "VEC2", 3, true);
    add_accessor(document, pack<std::uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
    return document;
}

}  // namespace lobe::tests
