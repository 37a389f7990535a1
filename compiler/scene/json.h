// JSON text to a tree of values that is safe to walk: no deeper than a limit, no member twice,
// every number finite. A complaint names the pointer of the value that was being read.
#pragma once

#include "scene/complaints.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string_view>

namespace lobe::scene {

/// glTF needs nine levels; `extras` may need more.
constexpr std::size_t deepest_json = 64;

/// The tree, or nothing after a complaint. Bytes after the value are an error, a byte order mark
/// too, as glTF has it.
std::optional<nlohmann::json> parse_json(std::string_view text, Complaints& complaints);

/// `name` as a part of a JSON pointer, with its slash.
Pointer operator/(const Pointer& parent, std::string_view name);
Pointer operator/(const Pointer& parent, std::size_t index);

}  // namespace lobe::scene
