// The total semantics of the language, case by case, in every kind of number.
#include "evaluate/fixture.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace lobe;
using namespace lobe::tests;
using evaluate::HalfMode;
using evaluate::Interval;
using ir::Op;

namespace {

struct Case {
    Op op;
    std::vector<double> operands;
    double result;
};

constexpr double large = 0x1p100;

// Exact in every format, so that every kind of number must give exactly this.
const Case cases[] = {
    {Op::guarded_power, {0, 0}, 1},
    {Op::guarded_power, {0.5, 0}, 1},
    {Op::guarded_power, {1, 0.375}, 1},
    {Op::guarded_smoothstep, {0.5, 0.5, 0.5}, 0},
    {Op::guarded_smoothstep, {0.5, 0.5, 0.75}, 1},
    {Op::guarded_smoothstep, {0.5, 0.25, 0.375}, 0},
    {Op::guarded_smoothstep, {0.5, 0.25, 0.75}, 1},
    {Op::guarded_smoothstep, {0, 1, 0.5}, 0.5},
    {Op::guarded_smoothstep, {0, 1, -3}, 0},
    {Op::guarded_smoothstep, {0, 1, 7}, 1},
    {Op::smoothstep, {0, 1, 0.25}, 0.15625},
    {Op::lerp, {0.25, 0.75, 0}, 0.25},
    {Op::lerp, {0.25, 0.75, 1}, 0.75},
    {Op::lerp, {0.25, 0.75, 0.5}, 0.5},
    {Op::lerp, {1, 1, 0.375}, 1},
    {Op::lerp, {0, 1, 2}, 2},
    {Op::lerp, {0, 1, -1}, -1},
    {Op::minimum, {-1, 2}, -1},
    {Op::maximum, {-1, 2}, 2},
    {Op::clamp, {3, 0, 1}, 1},
    {Op::clamp, {-3, 0, 1}, 0},
    {Op::clamp, {0.5, 0, 1}, 0.5},
    {Op::saturate, {1.5}, 1},
    {Op::saturate, {-0.5}, 0},
    {Op::step, {0.5, 0.5}, 1},
    {Op::step, {0.5, 0.25}, 0},
    {Op::sign, {-0.25}, -1},
    {Op::sign, {0}, 0},
    {Op::sign, {3}, 1},
    {Op::floor, {-0.25}, -1},
    {Op::floor, {2.75}, 2},
    {Op::floor, {-3}, -3},
    {Op::absolute, {-0.5}, 0.5},
    {Op::negate, {0.5}, -0.5},
    {Op::square_root, {0}, 0},
    {Op::square_root, {0.25}, 0.5},
    {Op::inverse_square_root, {0.25}, 2},
    {Op::exp2, {-3}, 0.125},
    {Op::exp2, {0}, 1},
    {Op::log2, {8}, 3},
    {Op::log2, {1}, 0},
    {Op::exp, {0}, 1},
    {Op::log, {1}, 0},
    {Op::sine, {0}, 0},
    {Op::cosine, {0}, 1},
    {Op::tangent, {0}, 0},
    {Op::arc_sine, {0}, 0},
    {Op::arc_cosine, {1}, 0},
    {Op::arc_tangent, {0}, 0},
    {Op::divide, {1, 4}, 0.25},
    {Op::multiply, {-0.5, -0.5}, 0.25},
};

}  // namespace

TEST_CASE("every kind of number gives the value that the language states")
{
    for (const Case& c : cases) {
        const ir::Module module = module_of(c.op, static_cast<int>(c.operands.size()));
        const evaluate::Tape tape = evaluate::compile(module, module.functions[0]);
        std::vector<float> narrow(c.operands.begin(), c.operands.end());
        std::vector<Interval> points;
        for (const double value : c.operands) points.push_back({value, value});
        INFO(name(c.op) << " " << Catch::StringMaker<std::vector<double>>::convert(c.operands));

        CHECK(evaluate_double(tape, {c.operands})[0][0] == c.result);
        CHECK(static_cast<double>(evaluate_float(tape, {narrow})[0][0]) == c.result);
        for (const auto mode : {HalfMode::keep_denormals, HalfMode::flush_denormals})
            CHECK(static_cast<double>(evaluate_half(tape, mode, {narrow})[0][0]) == c.result);
        CHECK(evaluate_interval(tape, {points})[0][0] == Interval{c.result, c.result});
        CHECK(evaluate_real(tape, 200, {c.operands})[0][0].to_double() == c.result);
        const auto accepted =
            evaluate_acceptance(tape, evaluate::Precision::float32, {narrow})[0][0];
        CHECK(accepted.low <= c.result);
        CHECK(c.result <= accepted.high);
    }
}

TEST_CASE("normalize of zero is zero, of anything else has length one")
{
    ir::Module module;
    ir::Function function;
    function.name = "direction";
    function.inputs.push_back(
        {"v", ir::Type::vec3, ir::Quantity::vector, {-1, 1}, ir::Origin::argument, 0, {}});
    function.result =
        function.graph.apply(Op::guarded_normalize, {function.graph.input(0, ir::Type::vec3)});
    module.functions.push_back(function);
    const evaluate::Tape tape = evaluate::compile(module, module.functions[0]);
    const auto results = evaluate_double(tape, {{0, 0, 0}, {0, -2, 0}, {3, 0, 4}});
    CHECK(results[0] == std::vector<double>{0, 0, 0});
    CHECK(results[1] == std::vector<double>{0, -1, 0});
    CHECK(results[2] == std::vector<double>{3.0 / 5, 0, 4.0 / 5});
    const auto accepted = evaluate_acceptance(tape, evaluate::Precision::float32, {{0, 0, 0}})[0];
    for (const auto& component : accepted) CHECK(component == evaluate::Acceptance{0, 0, false});
}

TEST_CASE("a base below the least normal number counts as that")
{
    for (const double base : {0.0, -0.25, 0x1p-140}) {
        CAPTURE(base);
        const auto narrow = static_cast<float>(base);
        CHECK(apply_float(Op::guarded_power, {narrow, 0}) == 1);
        CHECK(apply_float(Op::guarded_power, {narrow, 2.5F}) == 0);  // 2^-315
        CHECK(apply_double(Op::guarded_power, {base, 1.5}) ==
              apply_double(Op::guarded_power, {0x1p-126, 1.5}));
        CHECK(apply_half(Op::guarded_power, HalfMode::flush_denormals, {narrow, 0}) == 1);
        CHECK(apply_half(Op::guarded_power, HalfMode::keep_denormals, {narrow, 0.5F}) == 0x1p-7F);
        CHECK(apply_half(Op::guarded_power, HalfMode::keep_denormals, {narrow, 2.5F}) == 0);
    }
}

TEST_CASE("the width of a smoothstep below what divides counts as that")
{
    CHECK(apply_double(Op::guarded_smoothstep, {0, 0, 0}) == 0);
    CHECK(apply_double(Op::guarded_smoothstep, {0, 0, ir::least_divisor}) == 1);
    CHECK(apply_double(Op::guarded_smoothstep, {0, 0, ir::least_divisor / 2}) == 0.5);
    const auto flush = HalfMode::flush_denormals;
    CHECK(apply_half(Op::guarded_smoothstep, flush, {0, 0, 0x1p-14F}) == 1);
    CHECK(apply_half(Op::guarded_smoothstep, flush, {0, 0, 0}) == 0);
}

TEST_CASE("minimum, maximum, clamp and saturate of finite numbers are never NaN")
{
    const double values[] = {0,     -0.0,   1,        -1,
                             large, -large, 0x1p-140, std::numeric_limits<double>::max()};
    for (const double a : values)
        for (const double b : values) {
            CHECK(apply_double(Op::minimum, {a, b}) == std::min(a, b));
            CHECK(apply_double(Op::maximum, {a, b}) == std::max(a, b));
            CHECK(apply_double(Op::clamp, {a, -1, b}) <= std::max(b, 1.0));
            CHECK(apply_double(Op::saturate, {a}) == std::clamp(a, 0.0, 1.0));
        }
}

TEST_CASE("denormals are numbers in float and double")
{
    CHECK(apply_float(Op::multiply, {0x1p-100F, 0x1p-40F}) == 0x1p-140F);
    CHECK(apply_float(Op::exp2, {-140}) == 0x1p-140F);
    CHECK(apply_float(Op::exp2, {-160}) == 0);
    CHECK(apply_float(Op::log2, {0x1p-140F}) == -140);
    CHECK(apply_double(Op::exp2, {-1060}) == 0x1p-1060);
    CHECK(apply_double(Op::log2, {0x1p-1060}) == -1060);
}

TEST_CASE("half rounds to nearest even, overflows to infinity and flushes when asked")
{
    const auto keep = HalfMode::keep_denormals;
    const auto flush = HalfMode::flush_denormals;
    CHECK(apply_half(Op::add, keep, {2048, 1}) == 2048);  // the midpoint of 2048 and 2050
    CHECK(apply_half(Op::add, keep, {2050, 1}) == 2052);
    CHECK(std::isinf(apply_half(Op::multiply, keep, {256, 256})));
    CHECK(apply_half(Op::add, keep, {65504, 8}) == 65504);
    CHECK(apply_half(Op::multiply, keep, {0x1p-12F, 0x1p-12F}) == 0x1p-24F);
    CHECK(apply_half(Op::multiply, keep, {0x1p-13F, 0x1p-12F}) == 0);  // half of the least: even
    CHECK(apply_half(Op::multiply, keep, {0x1.8p-13F, 0x1p-12F}) == 0x1p-24F);
    CHECK(apply_half(Op::multiply, flush, {0x1p-12F, 0x1p-12F}) == 0);
    CHECK(apply_half(Op::multiply, flush, {0x1p-7F, 0x1p-7F}) == 0x1p-14F);
}

TEST_CASE("intervals know what the parts of an expression forget")
{
    CHECK(apply_interval(Op::lerp, {{1, 1}, {0, 256}, {0, 1}}) == Interval{0, 256});
    CHECK(apply_interval(Op::smoothstep, {{0, 0}, {1, 1}, {-5, 5}}) == Interval{0, 1});
    CHECK(apply_interval(Op::guarded_smoothstep, {{0, 0}, {0, 1}, {-5, 5}}) == Interval{0, 1});
    CHECK(apply_interval(Op::divide, {{1, 2}, {0, 4}}) ==
          Interval{0.25, std::numeric_limits<double>::infinity()});
    CHECK(apply_interval(Op::guarded_power, {{0, 1}, {0, 10}}) == Interval{0, 1});
    CHECK(apply_interval(Op::multiply, {{0, 0}, {0, std::numeric_limits<double>::infinity()}}) ==
          Interval{0, 0});

    ir::Module module = module_of(Op::multiply, 2);
    ir::Function& function = module.functions[0];
    const ir::ExprId x = function.graph.input(0, ir::Type::scalar);
    function.result = function.graph.apply(Op::multiply, {x, x});
    const evaluate::Tape tape = evaluate::compile(module, function);
    CHECK(evaluate_interval(tape, {{{-1, 1}, {0, 0}}})[0][0] == Interval{0, 1});
}

TEST_CASE("bounds round outward, and only when they must")
{
    CHECK(apply_interval(Op::add, {{0.5, 0.5}, {0.25, 0.25}}) == Interval{0.75, 0.75});
    const Interval third = apply_interval(Op::divide, {{1, 1}, {3, 3}});
    CHECK(third.low < third.high);
    CHECK(std::nextafter(third.low, 1.0) == third.high);
    const Interval tenth = apply_interval(Op::add, {{0.1, 0.1}, {0.2, 0.2}});
    CHECK(std::nextafter(tenth.low, 1.0) == tenth.high);
    CHECK(apply_interval(Op::square_root, {{4, 9}}) == Interval{2, 3});
    CHECK(apply_interval(Op::exp2, {{-1, 3}}) == Interval{0.5, 8});
    const double most = std::numeric_limits<double>::max();
    CHECK(apply_interval(Op::add, {{most, most}, {most, most}}) ==
          Interval{most, std::numeric_limits<double>::infinity()});
}
