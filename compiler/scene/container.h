// A `.glb` file: the JSON and the binary chunk inside. Any other bytes are JSON themselves.
#pragma once

#include "scene/complaints.h"

#include <optional>
#include <string_view>

namespace lobe::scene {

struct Container {
    std::string_view json;                   ///< a part of the file's bytes
    std::optional<std::string_view> binary;  ///< likewise
};

/// Nothing after a complaint.
std::optional<Container> open_container(std::string_view bytes, Complaints& complaints);

}  // namespace lobe::scene
