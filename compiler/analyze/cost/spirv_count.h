// How much arithmetic a SPIR-V module asks for, whatever hardware runs it.
#pragma once

#include <cstdint>
#include <span>

namespace lobe::analyze {

/// Floating-point arithmetic, comparisons and choices of every function, one per component of
/// their results: a multiplication of two vec3 is three, a dot product of them is five. Loads,
/// conversions and the composition of vectors are none.
int count_arithmetic(std::span<const std::uint32_t> spirv);

}  // namespace lobe::analyze
