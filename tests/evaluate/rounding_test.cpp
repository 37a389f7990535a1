// No computed value leaves its proved interval, and no error exceeds its proved bound: random terms
// over random boxes, in float, in both kinds of half, and in everything a Vulkan device may return.
#include "evaluate/acceptance.h"
#include "evaluate/bounds.h"
#include "evaluate/fixture.h"
#include "evaluate/half.h"
#include "evaluate/literals.h"
#include "evaluate/random_graph.h"
#include "evaluate/rounding_bounds.h"
#include "evaluate/waist.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

using namespace lobe;
using namespace lobe::evaluate;
using namespace lobe::tests;

namespace {

constexpr unsigned module_count = 800;
constexpr int box_count = 6;
constexpr int point_count = 24;
constexpr double floor_of_test = 0x1p-20;

double grid(double value, Precision precision)
{
    return precision == Precision::float32 ? static_cast<double>(static_cast<float>(value))
                                           : round_to_half(value, HalfMode::keep_denormals);
}

/// A random function, a box of its inputs, and points of the format in it.
struct Sample {
    ir::Module module;
    Tape tape;
    std::vector<Interval> box;
    Table<double> points;
};

Sample sample(std::mt19937& random, const ir::Module& module, Precision precision, int which)
{
    const ir::Function& function = module.functions.back();
    Sample result{module, compile(module, function), {}, {}};
    const auto center = random_point(random, function);
    std::vector<Interval> declared;
    for (const TapeInput& input : result.tape.inputs) {
        const ir::Range& range = function.inputs[input.input].range;
        declared.push_back({range.low, range.high});
    }
    // The declared box, then ever smaller ones, some of them points on some sides.
    const double scale = which == 0 ? 1 : std::ldexp(1.0, -4 * which);
    for (std::size_t i = 0; i < declared.size(); ++i) {
        const double x = grid(std::clamp(center[i], declared[i].low, declared[i].high), precision);
        const double width = (declared[i].high - declared[i].low) * scale;
        Interval side = which == 0          ? declared[i]
                        : random() % 4 == 0 ? Interval{x, x}
                                            : Interval{std::max(declared[i].low, x - width * 0.5),
                                                       std::min(declared[i].high, x + width * 0.5)};
        side = {grid(side.low, precision), grid(side.high, precision)};
        if (side.low > side.high) std::swap(side.low, side.high);
        result.box.push_back(side);
    }
    for (int p = 0; p < point_count; ++p) {
        auto& point = result.points.emplace_back();
        for (const Interval& side : result.box) {
            double t = std::uniform_real_distribution<double>{0, 1}(random);
            if (random() % 4 == 0) t = std::ldexp(t, -static_cast<int>(random() % 40));
            if (random() % 4 == 0) t = 1 - t;
            if (random() % 6 == 0) t = static_cast<double>(random() % 2);
            const double value = grid(side.low + (side.high - side.low) * t, precision);
            point.push_back(std::clamp(value, side.low, side.high));
        }
    }
    return result;
}

Table<float> narrow(const Table<double>& points)
{
    Table<float> result;
    for (const auto& point : points) result.emplace_back(point.begin(), point.end());
    return result;
}

/// The box of the inputs that one output reads.
std::vector<Interval> box_of(const RoundingTape& steps, const std::vector<Interval>& box)
{
    std::vector<Interval> result;
    for (const std::uint32_t input : steps.inputs) result.push_back(box[input]);
    return result;
}

double distance(double computed, const Real& exact)
{
    Real difference{256};
    mpfr_d_sub(difference.get(), computed, exact.get(), MPFR_RNDU);
    mpfr_abs(difference.get(), difference.get(), MPFR_RNDU);
    return mpfr_get_d(difference.get(), MPFR_RNDU);
}

struct Tally {
    std::size_t points = 0;
    std::size_t bounded = 0;  ///< points whose absolute bound is finite
    std::size_t without_jump = 0;
};

/// What `error` says of a box, against one computed value of it.
void require_bound(const BoxError& error, double computed, const Real& exact, Tally& tally)
{
    ++tally.points;
    if (error.absolute < infinity) ++tally.bounded;
    if (error.jump == 0) ++tally.without_jump;
    if (!std::isfinite(computed)) {
        // Only what is said to be unbounded may leave the format.
        REQUIRE((error.jump == infinity || error.absolute == infinity));
        return;
    }
    REQUIRE(error.computed.low <= computed);
    REQUIRE(computed <= error.computed.high);
    if (!mpfr_number_p(exact.get())) return;
    REQUIRE(mpfr_cmp_d(exact.get(), error.exact.low) >= 0);
    REQUIRE(mpfr_cmp_d(exact.get(), error.exact.high) <= 0);
    const double off = distance(computed, exact);
    // What 256 bits lose themselves, of values up to some 2^50 on the way.
    constexpr double truth = 0x1p-200;
    REQUIRE(off <= add_up(add_up(error.absolute, error.jump), truth));
    const double size = std::max(std::abs(exact.to_double()), floor_of_test);
    if (error.jump == 0) REQUIRE(off <= error.relative * size * (1 + 0x1p-40));
}

/// What is proved of an output over a box: from its inputs, and from each of its waists.
std::vector<BoxError> errors_of(const RoundingTape& steps, Machine machine, Precision precision,
                                const std::vector<Interval>& box)
{
    const Rounding& how = rounding(machine, precision);
    RoundingBounds bounds{steps, how, floor_of_test};
    std::vector<BoxError> result{bounds.error(box)};
    for (const auto& waist : waists(steps)) {
        std::vector<Rounded> given;
        std::vector<Interval> sides;
        for (const std::uint32_t node : waist) {
            given.push_back(bounds.values()[node]);
            sides.push_back(given.back().exact);
        }
        const RoundingTape rest = behind(steps, waist);
        result.push_back(RoundingBounds{rest, how, floor_of_test, given}.error(sides));
    }
    return result;
}

template <class Run>
Tally check(Machine machine, Precision precision, const RandomShape& shape, const Run& computed_of)
{
    Tally tally;
    Tally of_waists;
    for (unsigned seed = 0; seed < module_count; ++seed) {
        std::mt19937 random{seed};
        const ir::Module module = random_module(random, shape);
        for (int which = 0; which < box_count; ++which) {
            const Sample s = sample(random, module, precision, which);
            const auto truth = evaluate_real(s.tape, 256, s.points);
            const auto computed = computed_of(s);
            for (std::size_t k = 0; k < s.tape.outputs.size(); ++k) {
                const RoundingTape steps = rounding_tape(s.tape, k, Detail::steps);
                const auto errors = errors_of(steps, machine, precision, box_of(steps, s.box));
                for (std::size_t e = 0; e < errors.size(); ++e)
                    for (std::size_t p = 0; p < s.points.size(); ++p) {
                        const BoxError& error = errors[e];
                        INFO("seed " << seed << ", box " << which << ", point " << p << ", output "
                                     << k << ", waist " << e);
                        INFO(dump(steps));
                        INFO("proved [" << error.computed.low << ", " << error.computed.high
                                        << "], " << error.absolute << ", " << error.relative
                                        << ", jump " << error.jump);
                        for (const double value : computed[p][k]) {
                            INFO("computed " << value << ", exact " << truth[p][k].text());
                            require_bound(error, value, truth[p][k], e == 0 ? tally : of_waists);
                        }
                    }
            }
        }
    }
    CHECK(of_waists.points > tally.points);
    return tally;
}

using Values = std::vector<std::vector<std::vector<double>>>;  // by point, output; some of them

Values one_each(const Table<float>& results)
{
    Values out;
    for (const auto& point : results) {
        auto& row = out.emplace_back();
        for (const float value : point) row.push_back({static_cast<double>(value)});
    }
    return out;
}

Values both_halves(const Sample& s)
{
    const auto kept = evaluate_half(s.tape, HalfMode::keep_denormals, narrow(s.points));
    const auto flushed = evaluate_half(s.tape, HalfMode::flush_denormals, narrow(s.points));
    Values out = one_each(kept);
    for (std::size_t p = 0; p < out.size(); ++p)
        for (std::size_t k = 0; k < out[p].size(); ++k)
            out[p][k].push_back(static_cast<double>(flushed[p][k]));
    return out;
}

/// A device that keeps to the precision table and is as bad as that lets it be: every operation
/// returns an end of what it may, or anything between. Nothing where one leaves its domain.
std::optional<std::vector<double>> some_device(const Sample& s, const std::vector<double>& point,
                                               Precision precision, std::mt19937& random)
{
    const Rules& table = rules(precision);
    std::vector<double> slots(s.tape.slots);
    bool defined = true;
    const auto returned = [&](const Acceptance& allowed) {
        if (allowed.undefined || !std::isfinite(allowed.low) || !std::isfinite(allowed.high)) {
            defined = false;
            return 0.0;
        }
        const double t = std::uniform_real_distribution<double>{0, 1}(random);
        const double value = random() % 3 == 0   ? allowed.low
                             : random() % 2 == 0 ? allowed.high
                                                 : allowed.low + (allowed.high - allowed.low) * t;
        return std::clamp(grid(value, precision), allowed.low, allowed.high);
    };
    for (const Constant& constant : s.tape.constants) {
        const double value = precision == Precision::float32
                                 ? static_cast<double>(to_float(constant.literal))
                                 : to_half(constant.literal);
        slots[constant.slot] = returned(admit(table, {value, value, false}));
    }
    for (std::size_t i = 0; i < point.size(); ++i)
        slots[i] = returned(admit(table, {point[i], point[i], false}));
    for (const Instruction& step : s.tape.code) {
        const auto read = [&](Slot slot) { return Acceptance{slots[slot], slots[slot], false}; };
        const double value =
            returned(apply(table, step.op, read(step.a), read(step.b), read(step.c), read(step.d)));
        if (!defined) return std::nullopt;
        slots[step.result] = value;
    }
    std::vector<double> result;
    for (const Slot slot : s.tape.outputs) result.push_back(slots[slot]);
    return result;
}

Values on_devices(const Sample& s, Precision precision)
{
    std::mt19937 random{17};
    Values out;
    for (const auto& point : s.points) {
        auto& row = out.emplace_back(s.tape.outputs.size());
        for (int device = 0; device < 4; ++device)
            if (const auto results = some_device(s, point, precision, random))
                for (std::size_t k = 0; k < row.size(); ++k) row[k].push_back((*results)[k]);
    }
    return out;
}

RandomShape smooth_shape() { return {.functions = 2, .expressions = 10, .selects = false}; }

}  // namespace

TEST_CASE("a squared distance is a waist of its falloff")
{
    ir::Module module;
    ir::Function f;
    f.name = "f";
    std::vector<ir::ExprId> x;
    for (std::uint32_t i = 0; i < 3; ++i) {
        f.inputs.push_back(number_input("x" + std::to_string(i), -1024, 1024));
        x.push_back(f.graph.input(i, ir::Type::scalar));
    }
    const auto squared = [&](std::size_t i) {
        return f.graph.apply(ir::Op::multiply, {x[i], x[i]});
    };
    const ir::ExprId one = f.graph.literal(1.0);
    const ir::ExprId sum = f.graph.apply(
        ir::Op::add, {f.graph.apply(ir::Op::add, {squared(0), squared(1)}), squared(2)});
    f.result = f.graph.apply(ir::Op::divide, {one, f.graph.apply(ir::Op::add, {sum, one})});
    module.functions.push_back(f);

    const RoundingTape steps = rounding_tape(compile(module, f), 0, Detail::steps);
    const auto all = waists(steps);
    REQUIRE_FALSE(all.empty());
    REQUIRE(all.front().size() == 1);
    const RoundingTape rest = behind(steps, all.front());
    // 1 / (d + 1), or less of it.
    CHECK(rest.nodes.size() <= 4);
    CHECK(std::ranges::count(rest.nodes, RoundingNode::Kind::input, &RoundingNode::kind) == 1);
}

TEST_CASE("float stays in what was proved of the kernels")
{
    const auto run = [](const Sample& s) {
        return one_each(evaluate_float(s.tape, narrow(s.points)));
    };
    const Tally all = check(Machine::kernels, Precision::float32, {}, run);
    // Bounds that say nothing would pass too. Most say something.
    CAPTURE(all.points, all.bounded);
    CHECK(all.bounded * 2 > all.points);
    const Tally smooth = check(Machine::kernels, Precision::float32, smooth_shape(), run);
    CAPTURE(smooth.points, smooth.without_jump);
    CHECK(smooth.without_jump * 2 > smooth.points);
}

TEST_CASE("half stays in what was proved of it, denormals kept or flushed")
{
    check(Machine::kernels, Precision::float16, {}, both_halves);
    check(Machine::kernels, Precision::float16, smooth_shape(), both_halves);
}

TEST_CASE("what a device may return stays in what was proved of all devices")
{
    for (const Precision precision : {Precision::float32, Precision::float16}) {
        const auto run = [precision](const Sample& s) { return on_devices(s, precision); };
        check(Machine::vulkan, precision, {}, run);
        check(Machine::vulkan, precision, smooth_shape(), run);
    }
}
