// The same bits everywhere: from every instruction set of this machine, and from every compiler.
#include "evaluate/fixture.h"
#include "evaluate/kernels.h"
#include "evaluate/literals.h"
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

/// Both tables over the same hostile numbers.
template <class Number, class Table>
void compare_tables(const Table& expected, const Table& got)
{
    std::mt19937_64 random{11};
    const auto a = hostile_numbers<Number>(random, 4096);
    auto b = a;
    auto c = a;
    std::shuffle(b.begin(), b.end(), random);
    std::shuffle(c.begin(), c.end(), random);
    for (std::size_t op = 0; op < expected.size(); ++op)
        for (std::size_t begin = 0; begin < a.size(); begin += block_lanes) {
            std::array<Number, block_lanes> first{};
            std::array<Number, block_lanes> second{};
            const auto* const from_a = a.data() + begin;
            const auto* const from_b = b.data() + begin;
            const auto* const from_c = c.data() + begin;
            const auto* const from_d = b.data() + (a.size() - block_lanes - begin);
            expected[op](first.data(), from_a, from_b, from_c, from_d);
            got[op](second.data(), from_a, from_b, from_c, from_d);
            for (std::size_t i = 0; i < block_lanes; ++i) {
                if (std::isnan(first[i]) && std::isnan(second[i])) continue;
                if (std::bit_cast<Bits<Number>>(first[i]) != std::bit_cast<Bits<Number>>(second[i]))
                    FAIL("kernel " << op << " of " << from_a[i] << ", " << from_b[i] << ", "
                                   << from_c[i] << ": " << first[i] << " and " << second[i]);
            }
        }
}

/// Joined operations read a constant operand once, so here every operand is one number.
void compare_joined(const FusedTable& expected, const FusedTable& got)
{
    std::mt19937_64 random{12};
    const auto numbers = hostile_numbers<float>(random, 400);
    std::array<std::array<float, block_lanes>, 4> operands{};
    for (std::size_t i = 0; i + 4 <= numbers.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) operands[k].fill(numbers[i + k]);
        for (std::size_t op = 0; op < expected.size(); ++op) {
            std::array<float, block_lanes> first{};
            std::array<float, block_lanes> second{};
            for (const auto& [table, result] :
                 {std::pair{&expected, &first}, std::pair{&got, &second}})
                (*table)[op](result->data(), operands[0].data(), operands[1].data(),
                             operands[2].data(), operands[3].data());
            if (std::isnan(first[0]) && std::isnan(second[0])) continue;
            if (std::bit_cast<std::uint32_t>(first[0]) != std::bit_cast<std::uint32_t>(second[0]))
                FAIL("kernel " << op << " of " << numbers[i] << ", " << numbers[i + 1] << ", "
                               << numbers[i + 2] << ", " << numbers[i + 3] << ": " << first[0]
                               << " and " << second[0]);
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
        const auto base = InstructionSet::baseline;
        compare_tables<float>(kernels<float>(base), kernels<float>(set));
        compare_tables<double>(kernels<double>(base), kernels<double>(set));
        compare_joined(fused_kernels(base), fused_kernels(set));
    }
}

TEST_CASE("joined operations compute the same bits as single ones")
{
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random{seed};
        const ir::Module module = random_module(random, {.functions = 2, .expressions = 40});
        const ir::Function& function = module.functions.back();
        const Tape tape = compile(module, function);

        Table<float> columns(tape.inputs.size());
        for (std::size_t p = 0; p < block_lanes; ++p) {
            const auto point = random_point(random, function);
            for (std::size_t i = 0; i < columns.size(); ++i)
                columns[i].push_back(static_cast<float>(point[i]));
        }
        std::vector<const float*> in;
        for (const auto& column : columns) in.push_back(column.data());
        Table<float> results(tape.outputs.size(), std::vector<float>(block_lanes));
        std::vector<float*> out;
        for (auto& column : results) out.push_back(column.data());
        run(tape, Columns<float>{in}, Results<float>{out}, block_lanes);

        std::vector<std::array<float, block_lanes>> slots(tape.slots);
        for (std::size_t i = 0; i < columns.size(); ++i)
            std::copy(columns[i].begin(), columns[i].end(), slots[i].begin());
        for (const Constant& constant : tape.constants)
            slots[constant.slot].fill(to_float(constant.literal));
        for (const Instruction& step : tape.code)
            kernels<float>(widest())[static_cast<std::size_t>(step.op)](
                slots[step.result].data(), slots[step.a].data(), slots[step.b].data(),
                slots[step.c].data(), slots[step.d].data());
        for (std::size_t k = 0; k < results.size(); ++k)
            for (std::size_t p = 0; p < block_lanes; ++p)
                if (std::bit_cast<std::uint32_t>(results[k][p]) !=
                    std::bit_cast<std::uint32_t>(slots[tape.outputs[k]][p]))
                    FAIL("seed " << seed << ": " << results[k][p] << " and "
                                 << slots[tape.outputs[k]][p] << " in\n"
                                 << dump(tape));
    }
}

TEST_CASE("every compiler computes the same bits")
{
    // Computed once; g++ and clang++ both have to give it. It changes when a kernel does.
    CHECK(hash_of_kernels<float>() == 0x2d007acfc986ba19U);
    CHECK(hash_of_kernels<double>() == 0x51b21efb937ba53fU);
}
