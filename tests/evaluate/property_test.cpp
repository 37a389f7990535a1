// All kinds of number agree on random terms: what one of them says bounds what another may say.
#include "evaluate/fixture.h"
#include "evaluate/random_graph.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

using namespace lobe;
using namespace lobe::evaluate;
using namespace lobe::tests;

namespace {

constexpr unsigned module_count = 300;
constexpr int point_count = 40;

struct Sample {
    ir::Module module;
    Tape tape;
    Table<double> points;
};

const ir::Function& last(const ir::Module& module) { return module.functions.back(); }

Sample sample(unsigned seed, const RandomShape& shape = {})
{
    std::mt19937 random{seed};
    Sample result{random_module(random, shape), {}, {}};
    result.tape = compile(result.module, last(result.module));
    for (int i = 0; i < point_count; ++i)
        result.points.push_back(random_point(random, last(result.module)));
    return result;
}

Table<float> narrow(const Table<double>& points)
{
    Table<float> result;
    for (const auto& point : points) {
        auto& row = result.emplace_back();
        for (const double value : point) row.push_back(static_cast<float>(value));
    }
    return result;
}

Table<Interval> exact(const Table<double>& points)
{
    Table<Interval> result;
    for (const auto& point : points) {
        auto& row = result.emplace_back();
        for (const double value : point) row.push_back({value, value});
    }
    return result;
}

bool contains(const Interval& interval, const Real& value)
{
    return mpfr_cmp_d(value.get(), interval.low) >= 0 &&
           mpfr_cmp_d(value.get(), interval.high) <= 0;
}

std::string failure(const Sample& sample, std::size_t point)
{
    std::string text;
    for (const double value : sample.points[point]) text += fmt::format("{} ", value);
    return text + "in\n" + dump(sample.tape);
}

}  // namespace

TEST_CASE("an interval contains the value over the reals")
{
    for (unsigned seed = 0; seed < module_count; ++seed) {
        const Sample s = sample(seed);
        REQUIRE_FALSE(ir::verify(s.module));
        const auto bounds = evaluate_interval(s.tape, exact(s.points));
        const auto truth = evaluate_real(s.tape, 256, s.points);
        for (std::size_t p = 0; p < s.points.size(); ++p)
            for (std::size_t k = 0; k < s.tape.outputs.size(); ++k)
                if (!contains(bounds[p][k], truth[p][k]))
                    FAIL("seed " << seed << ": " << truth[p][k].text() << " is outside ["
                                 << bounds[p][k].low << ", " << bounds[p][k].high << "] at "
                                 << failure(s, p));
    }
}

TEST_CASE("the ranges over the reals contain every value, and no more than float ranges")
{
    for (unsigned seed = 0; seed < module_count; ++seed) {
        const Sample s = sample(seed);
        const auto& function = last(s.module);
        const auto inputs = declared_ranges(function);
        const auto reals = ranges(s.module, function, inputs, Arithmetic::reals);
        const auto floats = ranges(s.module, function, inputs);
        for (const ir::ExprId id : function.graph.ids()) {
            // Behind a division by exactly 0, which some select leaves out.
            if (std::isinf(reals[id].low) && std::isinf(reals[id].high)) continue;
            INFO("seed " << seed << " %" << id.index << "\n" << ir::dump(function.graph));
            CHECK(floats[id].low <= reals[id].low);
            CHECK(reals[id].high <= floats[id].high);
        }
        const auto truth = evaluate_real(s.tape, 256, s.points);
        const auto results = evaluate_float(s.tape, narrow(s.points));
        for (std::size_t p = 0; p < s.points.size(); ++p)
            for (std::size_t k = 0; k < s.tape.outputs.size(); ++k) {
                CHECK(contains(reals[function.result], truth[p][k]));
                const double value = results[p][k];
                CHECK(floats[function.result].low <= value);
                CHECK(value <= floats[function.result].high);
            }
    }
}

TEST_CASE("float lies in the acceptance interval")
{
    std::size_t undefined = 0;
    std::size_t total = 0;
    for (unsigned seed = 0; seed < module_count; ++seed) {
        const Sample s = sample(seed);
        const auto points = narrow(s.points);
        const auto accepted = evaluate_acceptance(s.tape, Precision::float32, points);
        const auto results = evaluate_float(s.tape, points);
        for (std::size_t p = 0; p < points.size(); ++p)
            for (std::size_t k = 0; k < s.tape.outputs.size(); ++k) {
                ++total;
                if (accepted[p][k].undefined) {
                    ++undefined;
                    continue;
                }
                const double value = results[p][k];
                if (!(accepted[p][k].low <= value && value <= accepted[p][k].high))
                    FAIL("seed " << seed << ": " << value << " is outside [" << accepted[p][k].low
                                 << ", " << accepted[p][k].high << "] at " << failure(s, p));
            }
    }
    // The generator stays inside the domains, so little may hide as undefined: only what stands
    // behind a jump that rounding leaves open.
    CAPTURE(undefined, total);
    CHECK(undefined * 20 < total);
}

TEST_CASE("half lies in the half acceptance interval, denormals kept or flushed")
{
    for (const HalfMode mode : {HalfMode::keep_denormals, HalfMode::flush_denormals})
        for (unsigned seed = 0; seed < module_count; ++seed) {
            const Sample s = sample(seed);
            // Inputs that are halves, so that reading them rounds nothing.
            Table<float> points = narrow(s.points);
            for (auto& point : points)
                for (float& value : point) value = apply_half(ir::Op::negate, mode, {-value});
            const auto accepted = evaluate_acceptance(s.tape, Precision::float16, points);
            const auto results = evaluate_half(s.tape, mode, points);
            for (std::size_t p = 0; p < points.size(); ++p)
                for (std::size_t k = 0; k < s.tape.outputs.size(); ++k) {
                    if (accepted[p][k].undefined) continue;
                    const double value = results[p][k];
                    if (!(accepted[p][k].low <= value && value <= accepted[p][k].high))
                        FAIL("seed " << seed << ": " << value << " is outside ["
                                     << accepted[p][k].low << ", " << accepted[p][k].high << "] at "
                                     << failure(s, p));
                }
        }
}

TEST_CASE("MPFR at 53 bits is double, bit for bit, where IEEE says what to compute")
{
    for (unsigned seed = 0; seed < module_count; ++seed) {
        const Sample s = sample(seed, {.elementary = false});
        // Two roundings in double, one in MPFR.
        if (std::ranges::any_of(s.tape.code, [](const Instruction& step) {
                return step.op == TapeOp::inverse_square_root;
            }))
            continue;
        const auto results = evaluate_double(s.tape, s.points);
        const auto truth = evaluate_real(s.tape, 53, s.points);
        for (std::size_t p = 0; p < s.points.size(); ++p)
            for (std::size_t k = 0; k < s.tape.outputs.size(); ++k)
                // MPFR has no denormals.
                if (results[p][k] != truth[p][k].to_double() && std::abs(results[p][k]) > 1e-300)
                    FAIL("seed " << seed << ": " << results[p][k] << " and " << truth[p][k].text()
                                 << " at " << failure(s, p));
    }
}

TEST_CASE("results do not depend on the size of the blocks")
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random{seed};
        const ir::Module module = random_module(random);
        const Tape tape = compile(module, last(module));
        Table<float> points;
        for (int i = 0; i < 1000; ++i) {
            auto& row = points.emplace_back();
            for (const double value : random_point(random, last(module)))
                row.push_back(static_cast<float>(value));
        }
        const auto whole = evaluate_float(tape, points);
        for (const std::size_t size : {1U, 7U, 128U}) {
            for (std::size_t begin = 0; begin < points.size(); begin += size) {
                const auto end = std::min(points.size(), begin + size);
                const Table<float> part(points.begin() + static_cast<long>(begin),
                                        points.begin() + static_cast<long>(end));
                const auto results = evaluate_float(tape, part);
                for (std::size_t p = 0; p < part.size(); ++p)
                    for (std::size_t k = 0; k < results[p].size(); ++k)
                        REQUIRE(std::bit_cast<std::uint32_t>(results[p][k]) ==
                                std::bit_cast<std::uint32_t>(whole[begin + p][k]));
            }
        }
    }
}
