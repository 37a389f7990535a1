// What a SPIR-V module declares of itself, as far as running it needs.
//
// A driver trusts its caller: an entry point that is not there, or words that are no SPIR-V, may
// take the process down. So they are looked for first.
#pragma once

#include "device/vulkan.h"

#include <cstdint>
#include <span>

namespace lobe::device {

struct Declared {
    bool has_entry = false;      ///< a compute shader of the name that was asked for
    bool needs_float16 = false;  ///< arithmetic
};

/// Nothing if the words are no SPIR-V.
std::optional<Declared> declared_by(std::span<const std::uint32_t> spirv, std::string_view entry);

}  // namespace lobe::device
