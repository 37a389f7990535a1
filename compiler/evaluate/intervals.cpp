#include "evaluate/intervals.h"

#include "evaluate/bounds.h"
#include "evaluate/kernels.h"

#include <algorithm>
#include <initializer_list>

namespace lobe::evaluate {
namespace {

constexpr Interval everything{-infinity, infinity};
constexpr Interval one{1, 1};
constexpr Interval unit{0, 1};

// The elementary functions of functions.inc are right to 2 units in the last place, the
// tangent and the arc functions to 4 (docs/numerics.md). An interval takes twice that.
constexpr int function_slack = 4;
constexpr int arc_slack = 8;

double lower(double value, int steps)
{
    for (int i = 0; i < steps; ++i) value = next_down(value);
    return value;
}

double upper(double value, int steps)
{
    for (int i = 0; i < steps; ++i) value = next_up(value);
    return value;
}

bool is_whole(double x) { return x == std::floor(x); }

/// The bounds of an increasing function that is 0 at 0 alone, and keeps the sign.
Interval increasing(Interval x, double (*function)(double), int steps)
{
    const double low = function(x.low);
    const double high = function(x.high);
    return {x.low >= 0 ? std::max(lower(low, steps), 0.0) : lower(low, steps),
            x.high <= 0 ? std::min(upper(high, steps), 0.0) : upper(high, steps)};
}

double exp2_down(double x)
{
    const double value = exp2_one(x);
    if (is_whole(x) && value > 0 && value < infinity) return value;
    if (value == infinity) return x == infinity ? value : std::numeric_limits<double>::max();
    return std::max(lower(value, function_slack), 0.0);
}

double exp2_up(double x)
{
    const double value = exp2_one(x);
    if (x == -infinity || (is_whole(x) && value > 0 && value < infinity)) return value;
    return upper(value, function_slack);
}

/// True for 2^k, whose logarithm is exact.
bool is_binade(double x)
{
    return (std::bit_cast<std::uint64_t>(x) & 0xfffffffffffffU) == 0 && x >= 0x1p-1022;
}

/// Twice the error of a power, relative: 2 units in the last place, and (ln 2)/4 for every unit
/// of the exponent of 2.
double power_slack(double x, double y)
{
    return (4 + std::min(std::abs(y * log2_one(x)), 1100.0) / 2) * 0x1p-52;
}

double power_down(double x, double y)
{
    if (y == 0 || x == 1) return 1;
    if (x <= 0) return y > 0 ? 0 : infinity;
    if (y == 1) return x;
    const double value = power_one(x, y);
    if (value == infinity) return std::numeric_limits<double>::max();
    return std::max(lower(value * (1 - power_slack(x, y)), 1), 0.0);
}

double power_up(double x, double y)
{
    if (y == 0 || x == 1) return 1;
    if (x <= 0) return y > 0 ? 0 : infinity;
    if (y == 1) return x;
    const double value = upper(power_one(x, y) * (1 + power_slack(x, y)), 1);
    // x^y does not cross 1.
    return (x < 1) == (y > 0) ? std::min(value, 1.0) : value;
}

/// t^2 (3 - 2 t) for one t in [0, 1].
Interval smooth(double t)
{
    const Interval at{t, t};
    const Interval value = multiply(square(at), subtract({3, 3}, multiply({2, 2}, at)));
    return common(value, unit);
}

/// Whether some `offset + k * period` lies in x, generously: a false alarm only widens a result.
bool may_reach(Interval x, double offset, double period)
{
    const double first = std::floor((x.low - offset) / period - 1e-9);
    const double last = std::floor((x.high - offset) / period + 1e-9);
    return last > first;
}

constexpr double pi = 3.141592653589793;
/// Past this the argument reduction has no error bound.
constexpr double largest_angle = 0x1p20;

bool is_reducible(Interval x) { return x.low >= -largest_angle && x.high <= largest_angle; }

/// A periodic function between -1 and 1, from its values at the ends and where its peaks are.
Interval wave(Interval x, double (*function)(double), double peak)
{
    if (!is_reducible(x)) return {-1, 1};
    const double at_low = function(x.low);
    const double at_high = function(x.high);
    const double high =
        may_reach(x, peak, 2 * pi) ? 1 : std::min(upper(std::max(at_low, at_high), arc_slack), 1.0);
    const double low = may_reach(x, peak + pi, 2 * pi)
                           ? -1
                           : std::max(lower(std::min(at_low, at_high), arc_slack), -1.0);
    return {low, high};
}

}  // namespace

Interval hull(Interval a, Interval b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

Interval common(Interval a, Interval b)
{
    const Interval both{std::max(a.low, b.low), std::min(a.high, b.high)};
    return both.low <= both.high ? both : a;
}

Interval negate(Interval x) { return {-x.high, -x.low}; }

Interval absolute(Interval x)
{
    if (x.low >= 0) return x;
    if (x.high <= 0) return negate(x);
    return {0, std::max(-x.low, x.high)};
}

Interval add(Interval a, Interval b) { return {add_down(a.low, b.low), add_up(a.high, b.high)}; }

Interval subtract(Interval a, Interval b)
{
    return {add_down(a.low, -b.high), add_up(a.high, -b.low)};
}

Interval multiply(Interval a, Interval b)
{
    if (a.low >= 0 && b.low >= 0) return {multiply_down(a.low, b.low), multiply_up(a.high, b.high)};
    return {std::min({multiply_down(a.low, b.low), multiply_down(a.low, b.high),
                      multiply_down(a.high, b.low), multiply_down(a.high, b.high)}),
            std::max({multiply_up(a.low, b.low), multiply_up(a.low, b.high),
                      multiply_up(a.high, b.low), multiply_up(a.high, b.high)})};
}

Interval divide(Interval a, Interval b)
{
    if (a.low >= 0 && b.low > 0) return {divide_down(a.low, b.high), divide_up(a.high, b.low)};
    if (b.low > 0 || b.high < 0)
        return {std::min({divide_down(a.low, b.low), divide_down(a.low, b.high),
                          divide_down(a.high, b.low), divide_down(a.high, b.high)}),
                std::max({divide_up(a.low, b.low), divide_up(a.low, b.high),
                          divide_up(a.high, b.low), divide_up(a.high, b.high)})};
    if (b.low == 0 && b.high > 0) {
        if (a.low >= 0) return {divide_down(a.low, b.high), infinity};
        if (a.high <= 0) return {-infinity, divide_up(a.high, b.high)};
    }
    if (b.high == 0 && b.low < 0) {
        if (a.low >= 0) return {-infinity, divide_up(a.low, b.low)};
        if (a.high <= 0) return {divide_down(a.high, b.low), infinity};
    }
    return everything;
}

Interval square(Interval x)
{
    const Interval size = absolute(x);
    return {multiply_down(size.low, size.low), multiply_up(size.high, size.high)};
}

Interval square_root(Interval x)
{
    return {root_down(std::max(x.low, 0.0)), root_up(std::max(x.high, 0.0))};
}

Interval inverse_square_root(Interval x) { return divide(one, square_root(x)); }

Interval minimum(Interval a, Interval b)
{
    return {std::min(a.low, b.low), std::min(a.high, b.high)};
}

Interval maximum(Interval a, Interval b)
{
    return {std::max(a.low, b.low), std::max(a.high, b.high)};
}

Interval power(Interval x, Interval y)
{
    if (y == Interval{0, 0}) return one;
    // Monotone in each operand for a positive base, so its extremes are at the corners.
    const double least = std::max(x.low, 0.0);
    const double most = std::max(x.high, 0.0);
    Interval result{power_down(least, y.low), power_up(least, y.low)};
    for (const double base : {least, most})
        for (const double exponent : {y.low, y.high})
            result = hull(result, {power_down(base, exponent), power_up(base, exponent)});
    if (contains(y, 0)) result = hull(result, one);
    // 0 for a base that is not positive, whatever the exponent but 0.
    if (x.low <= 0) result = hull(result, {0, 0});
    return result;
}

Interval lerp(Interval a, Interval b, Interval t)
{
    // Linear in each operand, so its extremes are at the corners.
    const auto corner = [](double from, double to, double weight) -> Interval {
        if (weight == 0) return {from, from};
        if (weight == 1) return {to, to};
        return add({from, from}, multiply(subtract({to, to}, {from, from}), {weight, weight}));
    };
    const bool bounded = std::max({std::abs(a.low), std::abs(a.high), std::abs(b.low),
                                   std::abs(b.high), std::abs(t.low), std::abs(t.high)}) < infinity;
    Interval result = everything;
    if (bounded) {
        result = corner(a.low, b.low, t.low);
        for (const double weight : {t.low, t.high})
            for (const double from : {a.low, a.high})
                for (const double to : {b.low, b.high})
                    result = hull(result, corner(from, to, weight));
    } else {
        result = add(a, multiply(subtract(b, a), t));
    }
    return t.low >= 0 && t.high <= 1 ? common(result, hull(a, b)) : result;
}

Interval smoothstep(Interval edge0, Interval edge1, Interval x)
{
    Interval result{1, 0};
    const auto include = [&result](Interval value) {
        result = result.low > result.high ? value : hull(result, value);
    };
    // The step x > edge0, where the edges may meet or cross.
    if (edge1.low <= edge0.high) {
        if (x.low <= edge0.high) include({0, 0});
        if (x.high > edge0.low) include(one);
    }
    if (edge1.high > edge0.low) {
        const Interval width = subtract(edge1, edge0);
        const Interval ratio = divide(subtract(x, edge0), {std::max(width.low, 0.0), width.high});
        const Interval t = minimum(maximum(ratio, {0, 0}), one);
        include({smooth(t.low).low, smooth(t.high).high});
        // Where x is outside of all edges the ratio is 0 or 1 however wide its bounds are.
        if (x.high <= edge0.low) result = {result.low, std::min(result.high, 0.0)};
        if (x.low >= edge1.high && x.low > edge0.high) result = {std::max(result.low, 1.0), 1};
    }
    return result;
}

/// x / sqrt(squares), where x^2 is one of the squares: in [-1, 1], with the sign of x.
Interval normalized(Interval x, Interval squares)
{
    if (squares.high <= 0) return {0, 0};
    const Interval ratio = divide(x, square_root(squares));
    return {std::max(ratio.low, x.low >= 0 ? 0.0 : -1.0),
            std::min(ratio.high, x.high <= 0 ? 0.0 : 1.0)};
}

Interval exp2(Interval x) { return {exp2_down(x.low), exp2_up(x.high)}; }

Interval log2(Interval x)
{
    if (x.high <= 0) return everything;
    const double low = x.low <= 0 ? -infinity : log2_one(x.low);
    const double high = log2_one(x.high);
    return {is_binade(x.low) ? low : lower(low, function_slack),
            is_binade(x.high) ? high : upper(high, function_slack)};
}

Interval exp(Interval x)
{
    const double low = exp_one(x.low);
    const double high = exp_one(x.high);
    return {x.low == 0 ? 1 : std::max(lower(low, function_slack), 0.0),
            x.high == 0 ? 1 : (x.high == -infinity ? 0 : upper(high, function_slack))};
}

Interval log(Interval x)
{
    if (x.high <= 0) return everything;
    const double low = x.low <= 0 ? -infinity : log_one(x.low);
    const double high = log_one(x.high);
    return {x.low == 1 ? 0 : lower(low, function_slack),
            x.high == 1 ? 0 : upper(high, function_slack)};
}

Interval sine(Interval x)
{
    // Between the peaks on either side of 0 it is increasing.
    if (x.low >= -1.5 && x.high <= 1.5) return increasing(x, sine_one, arc_slack);
    return wave(x, sine_one, pi / 2);
}

Interval cosine(Interval x)
{
    if (x == Interval{0, 0}) return one;
    return wave(x, cosine_one, 0);
}

Interval tangent(Interval x)
{
    if (!is_reducible(x) || may_reach(x, pi / 2, pi)) return everything;
    return increasing(x, tangent_one, arc_slack);
}

Interval arc_sine(Interval x)
{
    return common(increasing(x, arc_sine_one, arc_slack), {-next_up(pi / 2), next_up(pi / 2)});
}

Interval arc_cosine(Interval x)
{
    return {x.high >= 1 ? 0 : lower(arc_cosine_one(x.high), arc_slack),
            x.low >= 1 ? 0 : upper(arc_cosine_one(x.low), arc_slack)};
}

Interval arc_tangent(Interval x)
{
    return common(increasing(x, arc_tangent_one, arc_slack), {-next_up(pi / 2), next_up(pi / 2)});
}

Interval truth(bool always, bool never) { return {always ? 1.0 : 0.0, never ? 0.0 : 1.0}; }

Interval less(Interval a, Interval b) { return truth(a.high < b.low, a.low >= b.high); }
Interval less_equal(Interval a, Interval b) { return truth(a.high <= b.low, a.low > b.high); }

Interval equal(Interval a, Interval b)
{
    return truth(a.low == a.high && a == b, a.high < b.low || b.high < a.low);
}

Interval apply(TapeOp op, Interval a, Interval b, Interval c, Interval d)
{
    switch (op) {
    case TapeOp::negate: return negate(a);
    case TapeOp::absolute: return absolute(a);
    case TapeOp::sign:
        return {a.low > 0 ? 1.0 : (a.low < 0 ? -1.0 : 0.0),
                a.high > 0 ? 1.0 : (a.high < 0 ? -1.0 : 0.0)};
    case TapeOp::floor: return {std::floor(a.low), std::floor(a.high)};
    case TapeOp::square: return square(a);
    case TapeOp::square_root: return square_root(a);
    case TapeOp::inverse_square_root: return inverse_square_root(a);
    case TapeOp::exp2: return exp2(a);
    case TapeOp::log2: return log2(a);
    case TapeOp::exp: return exp(a);
    case TapeOp::log: return log(a);
    case TapeOp::sine: return sine(a);
    case TapeOp::cosine: return cosine(a);
    case TapeOp::tangent: return tangent(a);
    case TapeOp::arc_sine: return arc_sine(a);
    case TapeOp::arc_cosine: return arc_cosine(a);
    case TapeOp::arc_tangent: return arc_tangent(a);
    case TapeOp::saturate: return minimum(maximum(a, {0, 0}), one);
    case TapeOp::add: return add(a, b);
    case TapeOp::subtract: return subtract(a, b);
    case TapeOp::multiply: return multiply(a, b);
    case TapeOp::divide: return divide(a, b);
    case TapeOp::power: return power(a, b);
    case TapeOp::minimum: return minimum(a, b);
    case TapeOp::maximum: return maximum(a, b);
    case TapeOp::step: return less_equal(a, b);
    case TapeOp::normalized: return normalized(a, b);
    case TapeOp::lerp: return lerp(a, b, c);
    case TapeOp::clamp: return minimum(maximum(a, b), c);
    case TapeOp::smoothstep: return smoothstep(a, b, c);
    case TapeOp::less: return less(a, b);
    case TapeOp::less_equal: return less_equal(a, b);
    case TapeOp::equal: return equal(a, b);
    case TapeOp::not_equal: return subtract(one, equal(a, b));
    case TapeOp::logical_and: return minimum(a, b);
    case TapeOp::logical_or: return maximum(a, b);
    case TapeOp::logical_not: return subtract(one, a);
    case TapeOp::select:
        if (a.low > 0) return b;
        return a.high == 0 ? c : hull(b, c);
    case TapeOp::sum3: return add(add(a, b), c);
    case TapeOp::sum4: return add(add(add(a, b), c), d);
    }
    return everything;
}

}  // namespace lobe::evaluate
