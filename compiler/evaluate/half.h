// binary16, as doubles that happen to be halves.
#pragma once

#include "evaluate/run.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lobe::evaluate {

constexpr double largest_half = 65504;
constexpr double least_normal_half = 0x1p-14;

/// The nearest half, ties to even; from 65520 on infinite. Flushing makes every result below
/// 2^-14 zero, after rounding.
inline double round_to_half(double value, HalfMode mode)
{
    const double size = std::abs(value);
    if (!(size < 65520)) return value != value ? value : std::copysign(HUGE_VAL, value);
    // A half has 11 significant bits, and no bit below 2^-24. Adding and subtracting 1.5 * 2^52
    // of these last bits leaves the nearest multiple of them.
    const double bounded = size < least_normal_half ? least_normal_half : size;
    const std::uint64_t binade = std::bit_cast<std::uint64_t>(bounded) & 0x7ff0000000000000U;
    const double last_bit = std::bit_cast<double>(binade) * 0x1p-10;
    const double magic = last_bit * 0x1.8p52;
    const double rounded = (size + magic) - magic;
    if (mode == HalfMode::flush_denormals && rounded < least_normal_half)
        return std::copysign(0.0, value);
    return std::copysign(rounded, value);
}

}  // namespace lobe::evaluate
