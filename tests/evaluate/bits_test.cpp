// The same bits everywhere: from every instruction set of this machine, and from every compiler.
#include "evaluate/fixture.h"
#include "evaluate/kernels.h"
#include "evaluate/random_graph.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

using namespace lobe;
using namespace lobe::evaluate;
using namespace lobe::tests;

namespace {

template <class Number>
using Bits = std::conditional_t<std::is_same_v<Number, float>, std::uint32_t, std::uint64_t>;

/// Numbers of every kind: all binades, ends, denormals, infinities.
template <class Number>
std::vector<Number> hostile_numbers(std::mt19937_64& random, std::size_t count)
{
    using Limits = std::numeric_limits<Number>;
    std::vector<Number> numbers{0,
                                Number{-0.0},
                                1,
                                -1,
                                Number{0.5},
                                2,
                                Limits::max(),
                                -Limits::max(),
                                Limits::min(),
                                Limits::denorm_min(),
                                Limits::infinity(),
                                -Limits::infinity()};
    while (numbers.size() < count) {
        const auto bits = static_cast<Bits<Number>>(random());
        const auto any = std::bit_cast<Number>(bits);
        const auto even =
            static_cast<Number>(std::ldexp(static_cast<double>(random() >> 11), -50) - 4);
        if (!std::isnan(any)) numbers.push_back(any);
        numbers.push_back(even);
    }
    numbers.resize(count);
    return numbers;
}

template <class Number>
void compare_sets(InstructionSet set)
{
    std::mt19937_64 random{11};
    const auto a = hostile_numbers<Number>(random, 4096);
    auto b = a;
    auto c = a;
    std::shuffle(b.begin(), b.end(), random);
    std::shuffle(c.begin(), c.end(), random);
    for (std::size_t op = 0; op < tape_op_count; ++op)
        for (std::size_t begin = 0; begin < a.size(); begin += block_lanes) {
            std::array<Number, block_lanes> first{};
            std::array<Number, block_lanes> second{};
            const auto* const from_a = a.data() + begin;
            const auto* const from_b = b.data() + begin;
            const auto* const from_c = c.data() + begin;
            kernels<Number>(InstructionSet::baseline)[op](first.data(), from_a, from_b, from_c,
                                                          from_a);
            kernels<Number>(set)[op](second.data(), from_a, from_b, from_c, from_a);
            for (std::size_t i = 0; i < block_lanes; ++i) {
                if (std::isnan(first[i]) && std::isnan(second[i])) continue;
                if (std::bit_cast<Bits<Number>>(first[i]) != std::bit_cast<Bits<Number>>(second[i]))
                    FAIL(name(static_cast<TapeOp>(op))
                         << " of " << from_a[i] << ", " << from_b[i] << ", " << from_c[i] << ": "
                         << first[i] << " and " << second[i]);
            }
        }
}

/// FNV-1a over the bits of every result that is a number; NaNs count as one value.
template <class Number>
void mix(std::uint64_t& hash, Number value)
{
    std::uint64_t bits = 0x7ff8000000000000U;
    if (!std::isnan(value)) bits = std::bit_cast<Bits<Number>>(value);
    for (int byte = 0; byte < 8; ++byte)
        hash = (hash ^ (bits >> (8 * byte) & 0xff)) * 0x100000001b3U;
}

template <class Number>
std::uint64_t hash_of_kernels()
{
    std::mt19937_64 random{3};
    const auto numbers = hostile_numbers<Number>(random, 1024);
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const Kernel<Number> kernel : kernels<Number>(widest()))
        for (std::size_t begin = 0; begin + block_lanes <= numbers.size(); begin += block_lanes) {
            std::array<Number, block_lanes> result{};
            const std::size_t other = numbers.size() - block_lanes - begin;
            kernel(result.data(), numbers.data() + begin, numbers.data() + other,
                   numbers.data() + begin / 2, numbers.data() + begin);
            for (const Number value : result) mix(hash, value);
        }
    return hash;
}

}  // namespace

TEST_CASE("every instruction set computes the same bits")
{
    for (const auto set : {InstructionSet::avx2, InstructionSet::avx512}) {
        if (!available(set)) continue;
        compare_sets<float>(set);
        compare_sets<double>(set);
    }
}

TEST_CASE("every compiler computes the same bits")
{
    // Computed once; g++ and clang++ both have to give it. It changes when a kernel does.
    CHECK(hash_of_kernels<float>() == 0x83e316a5f0bbda7fU);
    CHECK(hash_of_kernels<double>() == 0x6c890224f8d086a5U);
}
