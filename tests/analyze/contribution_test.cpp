// What an effect adds is bounded: at every point of every box, the values, their difference and
// their ratio lie in what was said.
#include "analyze/checked.h"
#include "analyze/residual/contribution.h"
#include "evaluate/run.h"
#include "evaluate/tape.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace lobe;
using namespace lobe::analyze;
using evaluate::Interval;

namespace {

/// Terms that take every rule: `x` and `y` stay, `p` and `q` are changed.
struct Example {
    const char* body;
    bool has_factor;  ///< where p and q are positive without the effect
};

constexpr Example examples[] = {
    {"p * x + q * y", true},
    {"x - p * q", false},
    {"p * x / (q * y)", true},
    {"sqrt(p * x) * y", true},
    {"1 / sqrt(p * x)", true},
    {"lerp(x, y, 0.25 * p) * q", true},
    {"lerp(p * x, q * y, 0.3)", true},
    {"lerp(1, p * x, 0.5 * y) * q", true},
    {"(x * p)^3.7", true},
    {"(0.2 * x)^(p * q)", false},
    {"(0.2 * x)^(2 + y * p)", true},
    {"exp(-p * x) * y", true},
    {"2^(p * x - q * y)", true},
    {"log(1 + p * x)", true},
    {"min(p * x, q * y)", true},
    {"max(p * x, q * y) - y", false},
    {"max(p - x, 0)", false},
    {"saturate(0.4 * p * x)", true},
    {"clamp(p * x, 0.3, 2)", true},
    {"abs(p - x)", false},
    {"(p - q * x)^2", false},
    {"if x < y then p * x else q * y", true},
    {"if p * x < q * y then x else y", true},
    {"smoothstep(0, p * x, y)", false},
    {"smoothstep(0.2, 1.5, p * x)", false},
    {"sin(p * x) + cos(q * y)", false},
    {"step(x, p)", false},
    {"p * x + q * y + x * y", true},
    {"-(p * x)", true},
};

struct Sides {
    std::vector<Contribution> box;
    std::vector<Interval> range;  ///< per input, with the effect
    std::vector<double> without;  ///< of the changed ones
    std::vector<bool> is_changed;
};

double between(std::mt19937& random, double low, double high)
{
    return std::uniform_real_distribution<double>{low, high}(random);
}

Sides sides_of(const evaluate::Tape& tape, std::mt19937& random)
{
    Sides sides;
    for (const evaluate::TapeInput& input : tape.inputs) {
        const bool changes = input.name == "p" || input.name == "q";
        const double a = between(random, 0.5, 2);
        const double b = random() % 4 == 0 ? a : between(random, 0.5, 2);
        const Interval range{std::min(a, b), std::max(a, b)};
        const double off = between(random, 0.5, 2);
        sides.range.push_back(range);
        sides.without.push_back(off);
        sides.is_changed.push_back(changes);
        sides.box.push_back(changes ? changed(off, range) : untouched(range));
    }
    return sides;
}

double value_of(const evaluate::Tape& tape, const std::vector<double>& point)
{
    std::vector<const double*> in;
    for (const double& value : point) in.push_back(&value);
    double result = 0;
    std::vector<double*> out{&result};
    evaluate::run(tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out}, 1);
    return result;
}

/// Doubles are not reals: some roundings of values up to 100.
constexpr double slack = 100 * 0x1p-44;

bool lies_in(double value, const Interval& range)
{
    return range.low - slack <= value && value <= range.high + slack;
}

}  // namespace

TEST_CASE("differences and ratios lie in what is said of them")
{
    std::mt19937 random{7};
    for (const Example& example : examples) {
        CAPTURE(example.body);
        const tests::Checked checked = tests::checked_text(
            std::string{"module test\nterm f(x: float in [0.5, 2], y: float in [0.5, 2], p: float "
                        "in [0.5, 2], q: float in [0.5, 2]) -> float = "} +
            example.body + "\n");
        const ir::Function& function = checked.module.functions.back();
        const evaluate::Tape tape = evaluate::compile(checked.module, function);
        const evaluate::RoundingTape nodes =
            evaluate::rounding_tape(tape, 0, evaluate::Detail::operations);
        std::vector<Contribution> values;
        for (int box = 0; box < 64; ++box) {
            const Sides sides = sides_of(tape, random);
            std::vector<Contribution> inputs;
            for (const std::uint32_t input : nodes.inputs) inputs.push_back(sides.box[input]);
            const Contribution found = contribution(nodes, inputs, values);
            if (example.has_factor) CHECK(found.factor.has_value());
            for (int at = 0; at < 32; ++at) {
                std::vector<double> with;
                std::vector<double> without;
                for (std::size_t i = 0; i < sides.range.size(); ++i) {
                    with.push_back(between(random, sides.range[i].low, sides.range[i].high));
                    without.push_back(sides.is_changed[i] ? sides.without[i] : with.back());
                }
                const double on = value_of(tape, with);
                const double off = value_of(tape, without);
                CHECK(lies_in(on, found.with));
                CHECK(lies_in(off, found.without));
                CHECK(lies_in(on - off, found.change));
                if (found.factor)
                    CHECK(lies_in(
                        on, evaluate::Interval{
                                std::min(off * found.factor->low, off * found.factor->high),
                                std::max(off * found.factor->low, off * found.factor->high)}));
            }
        }
    }
}

TEST_CASE("a common factor, however uncertain, is no part of a ratio")
{
    // A highlight between 0 and 1e6 times what 0.004 of a mask leaves.
    const tests::Checked checked = tests::checked_text(
        "module test\nterm f(highlight: float in [0, 1000000], mask: unit, p: unit) -> float = "
        "highlight * lerp(1, 0, mask * p)\n");
    const evaluate::Tape tape = evaluate::compile(checked.module, checked.module.functions.back());
    const evaluate::RoundingTape nodes =
        evaluate::rounding_tape(tape, 0, evaluate::Detail::operations);
    const std::vector<Contribution> box{untouched({0, 1e6}), untouched({0, 1}),
                                        changed(0, {0.004, 0.004})};
    std::vector<Contribution> inputs;
    for (const std::uint32_t input : nodes.inputs) inputs.push_back(box[input]);
    std::vector<Contribution> values;
    const Contribution found = contribution(nodes, inputs, values);
    REQUIRE(found.factor);
    // On the way: 0.004 as a double, mask p, the lerp's difference, two products and sum, its
    // ratio, the product with the highlight. Each rounds to nearest and then moves one step
    // outward, by less than 2 units of 2^-52 together.
    constexpr int roundings = 8;
    constexpr double rounding = roundings * 2 * 0x1p-52;
    CHECK(found.factor->low <= 0.996);
    CHECK(found.factor->low >= 0.996 * (1 - rounding));
    CHECK(found.factor->high == 1);
    CHECK(found.change.low <= -4000);
    CHECK(found.change.low >= -4000 * (1 + rounding));
    CHECK(found.change.high == 0);
}
