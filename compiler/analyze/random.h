// Random numbers that are the same on every compiler and platform: a counter-based stream.
//
// No distribution of the standard library, whose results are not specified, and no function of
// libm but the exactly rounded square root.
#pragma once

#include <cmath>
#include <cstdint>

namespace lobe::analyze {

/// One independent stream per key. [Steele14] SplitMix64.
class Random {
public:
    explicit Random(std::uint64_t key) : state_(mix(key + golden)) {}

    std::uint64_t bits()
    {
        state_ += golden;
        return mix(state_);
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    /// Uniform in [low, high].
    double between(double low, double high) { return low + (high - low) * unit(); }

    /// Uniform in 0 .. size - 1. The bias is below size / 2^64.
    std::uint32_t below(std::uint32_t size)
    {
        return static_cast<std::uint32_t>((bits() >> 32) * size >> 32);
    }

    bool coin() { return (bits() >> 63) != 0; }

    /// Log-uniform by binades: 2^k (1 + u), with k uniform in first .. last - 1.
    double magnitude(int first, int last)
    {
        const int exponent =
            first + static_cast<int>(below(static_cast<std::uint32_t>(last - first)));
        return std::ldexp(1 + unit(), exponent);
    }

private:
    static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;

    static std::uint64_t mix(std::uint64_t z)
    {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
};

}  // namespace lobe::analyze
