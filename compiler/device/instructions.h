// AMD's instructions, counted in a disassembly.
#pragma once

#include <string_view>

namespace lobe::device {

struct VectorInstructions {
    int plain = 0;
    int transcendental = 0;
};

/// Vector instructions of a listing with one instruction per line, the mnemonic first. A packed
/// one counts once, as do two that are issued together (`v_dual_mul_f32 ... :: v_dual_add_f32`).
VectorInstructions count_vector_instructions(std::string_view assembly);

}  // namespace lobe::device
