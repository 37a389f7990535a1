// Scenes for tests: read from texts, with the files that they name given beside them.
#pragma once

#include "scene/gltf.h"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::tests {

using Files = std::map<std::string, std::string>;

/// What reading these bytes gives.
scene::ReadScene read_bytes(std::string_view bytes, const Files& files = {},
                            const scene::ReadOptions& options = {});
scene::ReadScene read(const nlohmann::json& document, const Files& files = {},
                      const scene::ReadOptions& options = {});
/// The scene; a complaint fails the test.
scene::Scene read_clean(const nlohmann::json& document, const Files& files = {},
                        const scene::ReadOptions& options = {});
/// A scene of tests/data/scenes, by its file's name.
scene::ReadScene read_file(const std::string& name, const scene::ReadOptions& options = {});
/// Bytes of a file in tests/data/scenes.
std::string slurp(const std::string& name);

/// A document with one of everything, without a complaint: two nodes, a triangle, a material with
/// textures and extensions, a camera, a light and an environment.
nlohmann::json one_of_everything();
/// The least document: a version.
nlohmann::json empty_document();

/// Every complaint as `error /pointer: message (help)`, one per line.
std::string told(const std::vector<scene::Complaint>& complaints);

std::string base64(std::string_view bytes);
/// Bytes of numbers in a row, little-endian.
template <typename Number>
std::string pack(const std::vector<Number>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}
/// Adds a buffer with these bytes, a view of it all and an accessor, and gives the accessor's
/// index.
std::size_t add_accessor(nlohmann::json& document, std::string_view bytes, int component_type,
                         std::string_view type, std::size_t count, bool normalized = false);

}  // namespace lobe::tests
