#include "evaluate/acceptance.h"

#include "evaluate/bounds.h"
#include "evaluate/intervals.h"
#include "evaluate/kernels.h"

#include <algorithm>
#include <array>

namespace lobe::evaluate {
namespace {

constexpr Rules float32_rules{.digits = 24,
                              .epsilon = 0x1p-23,
                              .largest = 0x1.fffffep127,
                              .least_normal = 0x1p-126,
                              .largest_divisor = 0x1p126,
                              .exp2_units = 3,
                              .log2_error = 0x1p-21,
                              .sine_error = 0x1p-11,
                              .atan2_units = 4096};

constexpr Rules float16_rules{.digits = 11,
                              .epsilon = 0x1p-10,
                              .largest = 65504,
                              .least_normal = 0x1p-14,
                              .largest_divisor = 0x1p14,
                              .exp2_units = 1,
                              .log2_error = 0x1p-7,
                              .sine_error = 0x1p-7,
                              .atan2_units = 5};

constexpr Acceptance zero{0, 0, false};
constexpr Acceptance one{1, 1, false};
constexpr Acceptance two{2, 2, false};
constexpr Acceptance three{3, 3, false};
constexpr double pi = 3.141592653589793;

Interval bounds(const Acceptance& x) { return {x.low, x.high}; }
bool reaches_infinity(const Acceptance& x) { return x.low == -infinity || x.high == infinity; }
bool reaches(const Acceptance& x, double value) { return x.low <= value && value <= x.high; }

Acceptance hull(const Acceptance& a, const Acceptance& b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high), a.undefined || b.undefined};
}

/// One precision's arithmetic. Every member returns what a device may return for one operation.
class Device {
public:
    explicit Device(const Rules& rules) : rules_{rules} {}

    Acceptance flushed(Acceptance x) const;
    Acceptance admitted(const Acceptance& x) const { return rounded({x.low, x.high}, x.undefined); }
    Acceptance add(const Acceptance& a, const Acceptance& b) const;
    Acceptance subtract(const Acceptance& a, const Acceptance& b) const;
    Acceptance multiply(const Acceptance& a, const Acceptance& b) const;
    Acceptance square(const Acceptance& x) const;
    Acceptance divide(const Acceptance& a, const Acceptance& b) const;
    Acceptance inverse_square_root(const Acceptance& x) const;
    Acceptance square_root(const Acceptance& x) const;
    Acceptance exponential(const Acceptance& x, double (*function)(double)) const;
    Interval logarithm_reads(const Acceptance& x) const;
    Acceptance logarithm(const Acceptance& x, double (*function)(double)) const;
    Acceptance power(const Acceptance& x, const Acceptance& y) const;
    Acceptance guarded_power(const Acceptance& x, const Acceptance& y) const;
    Acceptance wave(const Acceptance& x, Interval exact) const;
    Acceptance tangent(const Acceptance& x) const;
    Acceptance atan2(const Acceptance& y, const Acceptance& x) const;
    Acceptance arc_sine(const Acceptance& x) const;
    Acceptance arc_cosine(const Acceptance& x) const;
    Acceptance arc_tangent(const Acceptance& x) const;
    Acceptance normalized(const Acceptance& x, const Acceptance& squares) const;
    Acceptance guarded_normalized(const Acceptance& x, const Acceptance& squares) const;
    Acceptance lerp(const Acceptance& a, const Acceptance& b, const Acceptance& t) const;
    Acceptance smoothstep(const Acceptance& edge0, const Acceptance& edge1,
                          const Acceptance& x) const;
    Acceptance guarded_smoothstep(const Acceptance& edge0, const Acceptance& edge1,
                                  const Acceptance& x) const;
    Acceptance sum3(const Acceptance& a, const Acceptance& b, const Acceptance& c) const;
    Acceptance sum4(const std::array<Acceptance, 4>& terms) const;

private:
    double round_up(double x) const;
    double round_down(double x) const { return -round_up(-x); }
    double unit(double x) const;
    Acceptance rounded(Interval exact, bool undefined) const;
    Acceptance within(double low, double high, bool undefined) const;
    Acceptance within_units(Interval exact, double low_units, double high_units,
                            bool undefined) const;
    double epsilon() const { return rules_.epsilon; }
    /// A component is no longer than its vector, but for three roundings or two functions.
    double longest() const { return 1 + 8 * epsilon(); }

    const Rules& rules_;
};

/// The least float that is not below `x`. Without branches: whether a bound rounds up is a toss.
double round_up_to_float(double x)
{
    const auto nearest = static_cast<float>(x);
    // As integers in the order of the floats, the next float is the next integer.
    constexpr std::int32_t magnitude = 0x7fffffff;
    const auto bits = std::bit_cast<std::int32_t>(nearest);
    const std::int32_t ordered = bits ^ ((bits >> 31) & magnitude);
    const std::int32_t next = ordered + (static_cast<double>(nearest) < x ? 1 : 0);
    return static_cast<double>(std::bit_cast<float>(next ^ ((next >> 31) & magnitude)));
}

/// The least number of the format that is not below `x`.
double Device::round_up(double x) const
{
    if (rules_.digits == 24) return round_up_to_float(x);
    const double size = std::abs(x);
    // Beyond the largest number: up to infinity, or toward zero, which stays finite.
    if (!(size <= rules_.largest)) return x > 0 ? infinity : -rules_.largest;
    const double last = std::max(size, rules_.least_normal);
    const double step =
        std::bit_cast<double>(std::bit_cast<std::uint64_t>(last) & 0x7ff0000000000000U) * epsilon();
    return std::ceil(x / step) * step;
}

/// A unit in the last place of `x`: of the larger of two, at a power of two.
double Device::unit(double x) const
{
    const double size = std::clamp(std::abs(x), rules_.least_normal, rules_.largest);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) & 0x7ff0000000000000U) *
           epsilon();
}

/// A result below the least normal number may be flushed to 0.
Acceptance Device::flushed(Acceptance x) const
{
    if (x.low > 0 && x.low < rules_.least_normal) x.low = 0;
    if (x.high < 0 && x.high > -rules_.least_normal) x.high = 0;
    return x;
}

/// Correctly rounded, in either direction.
Acceptance Device::rounded(Interval exact, bool undefined) const
{
    return flushed({round_down(exact.low), round_up(exact.high), undefined});
}

/// Any number of the format in [low, high].
Acceptance Device::within(double low, double high, bool undefined) const
{
    const double least = std::min(round_up(low), rules_.largest);
    const double most = std::max(round_down(high), -rules_.largest);
    if (least > most) return rounded({low, high}, undefined);
    return flushed({low == -infinity ? low : least, high == infinity ? high : most, undefined});
}

Acceptance Device::within_units(Interval exact, double low_units, double high_units,
                                bool undefined) const
{
    // The unit of the widened bound: a power of two in between has the larger unit.
    const auto widen = [this](double bound, double units) {
        return units * unit(std::abs(bound) + units * unit(bound));
    };
    // Overflow may stop at the largest number.
    const double low = std::min(exact.low, rules_.largest);
    const double high = std::max(exact.high, -rules_.largest);
    return within(low == -infinity ? low : low - widen(low, low_units),
                  high == infinity ? high : high + widen(high, high_units), undefined);
}

// The ends of operands are numbers of the format, so their products are exact in double, and a
// quotient or root is off by much less than what the table adds.

constexpr double slack = 0x1p-20;  // units

/// An infinite end times zero is zero.
double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Acceptance Device::add(const Acceptance& a, const Acceptance& b) const
{
    const bool opposite =
        (a.high == infinity && b.low == -infinity) || (a.low == -infinity && b.high == infinity);
    return rounded({add_down(a.low, b.low), add_up(a.high, b.high)},
                   a.undefined || b.undefined || opposite);
}

Acceptance Device::subtract(const Acceptance& a, const Acceptance& b) const
{
    return add(a, {-b.high, -b.low, b.undefined});
}

Acceptance Device::multiply(const Acceptance& a, const Acceptance& b) const
{
    const bool vague =
        (reaches_infinity(a) && reaches(b, 0)) || (reaches_infinity(b) && reaches(a, 0));
    const bool undefined = a.undefined || b.undefined || vague;
    if (a.low >= 0 && b.low >= 0)
        return rounded({product(a.low, b.low), product(a.high, b.high)}, undefined);
    const auto [low, high] = std::minmax({product(a.low, b.low), product(a.low, b.high),
                                          product(a.high, b.low), product(a.high, b.high)});
    return rounded({low, high}, undefined);
}

Acceptance Device::square(const Acceptance& x) const
{
    const Interval size = evaluate::absolute(bounds(x));
    return rounded({size.low * size.low, size.high * size.high}, x.undefined);
}

Acceptance Device::divide(const Acceptance& a, const Acceptance& b) const
{
    const double largest = rules_.largest_divisor;
    const double least = 1 / largest;
    const bool promised =
        (b.low >= least && b.high <= largest) || (b.high <= -least && b.low >= -largest);
    const bool undefined = a.undefined || b.undefined || !promised || reaches_infinity(a);
    const double units = 2.5 + slack;
    if (a.low >= 0 && b.low > 0)
        return within_units({a.low / b.high, a.high / b.low}, units, units, undefined);
    return within_units(evaluate::divide(bounds(a), bounds(b)), units, units, undefined);
}

Acceptance Device::inverse_square_root(const Acceptance& x) const
{
    const Interval exact{x.high > 0 ? 1 / std::sqrt(x.high) : infinity,
                         x.low > 0 ? 1 / std::sqrt(x.low) : infinity};
    const Acceptance result =
        within_units(exact, 2 + slack, 2 + slack, x.undefined || x.low <= 0 || reaches_infinity(x));
    return {std::max(result.low, 0.0), result.high, result.undefined};
}

/// Inherited from 1 / inversesqrt(x). At 0 that is 1 / infinity: 0.
Acceptance Device::square_root(const Acceptance& x) const
{
    if (x.high <= 0) return {0, 0, x.undefined || x.low < 0};
    const double least = std::max(x.low, rules_.least_normal);
    const Acceptance positive{least, std::max(x.high, least), x.undefined || x.low < 0};
    Acceptance result = divide(one, inverse_square_root(positive));
    if (x.low <= 0) result.low = 0;
    return result;
}

/// The values of an increasing function at both ends.
Interval ends(Interval x, double (*function)(double))
{
    const double low = function(x.low);
    return {low, x.high == x.low ? low : function(x.high)};
}

/// 2^x or e^x. Not negative: no device returns such a power.
Acceptance Device::exponential(const Acceptance& x, double (*function)(double)) const
{
    const auto units = [&](double end) {
        return rules_.exp2_units + 2 * std::min(std::abs(end), 4096.0) + slack;
    };
    const Acceptance result =
        within_units(ends(bounds(x), function), units(x.low), units(x.high), x.undefined);
    return {std::max(result.low, 0.0), result.high, result.undefined};
}

/// What a logarithm may see of x. A denormal may be flushed to 0, and devices that take the
/// exponent out of the bits read it as nearly the least normal number instead (log2 of 1e-45 is
/// -126.9 on lavapipe): all between is allowed.
Interval Device::logarithm_reads(const Acceptance& x) const
{
    if (x.low >= rules_.least_normal || x.high <= 0) return bounds(x);
    return {0, std::max(x.high, rules_.least_normal)};
}

/// log2 x or log x. Below 0 undefined; so is 0, where only `power` may look.
Acceptance Device::logarithm(const Acceptance& x, double (*function)(double)) const
{
    const bool undefined = x.undefined || x.low <= 0 || reaches_infinity(x);
    const Interval exact = ends(logarithm_reads(x), function);
    const Acceptance outside = within_units(exact, 3 + slack, 3 + slack, undefined);
    if (x.high < 0.5 || x.low > 2) return outside;
    const Acceptance inside =
        within(exact.low - rules_.log2_error, exact.high + rules_.log2_error, undefined);
    return x.low >= 0.5 && x.high <= 2 ? inside : hull(outside, inside);
}

/// Inherited from exp2(y * log2 x).
Acceptance Device::power(const Acceptance& x, const Acceptance& y) const
{
    const bool undefined = x.undefined || y.undefined || x.low < 0 || (x.low <= 0 && y.low <= 0);
    if (x.high <= 0) return {0, undefined ? infinity : 0, undefined};
    Acceptance log = logarithm(x, log2_one);
    // log2 of what may be 0 is as low as can be: 2^(y log2 0) is 0.
    if (x.low <= 0) log.low = -infinity;
    const Acceptance exponent = multiply(y, log);
    Acceptance result = exponential(exponent, exp2_one);
    result.undefined = undefined;
    return result;
}

/// y == 0 ? 1 : (x <= 0 ? 0 : pow(x, y))
Acceptance Device::guarded_power(const Acceptance& x, const Acceptance& y) const
{
    const bool undefined = x.undefined || y.undefined;
    if (y.low == 0 && y.high == 0) return {1, 1, undefined};
    Acceptance result{infinity, -infinity, undefined};
    if (reaches(y, 0)) result = hull(result, one);
    if (x.low <= 0) result = hull(result, zero);
    if (x.high > 0) {
        const double least = std::max(x.low, 0x1p-1074);
        Acceptance bare = power({least, x.high, false}, y);
        // A positive base may still be read as 0.
        if (x.low < rules_.least_normal && y.low < 0) bare.undefined = true;
        result = hull(result, bare);
    }
    return result;
}

/// Sine and cosine.
Acceptance Device::wave(const Acceptance& x, Interval exact) const
{
    const bool promised = x.low >= -pi && x.high <= pi;
    return within(exact.low - rules_.sine_error, exact.high + rules_.sine_error,
                  x.undefined || !promised);
}

/// Inherited from sin x / cos x.
Acceptance Device::tangent(const Acceptance& x) const
{
    return divide(wave(x, evaluate::sine(bounds(x))), wave(x, evaluate::cosine(bounds(x))));
}

/// For y >= 0.
Acceptance Device::atan2(const Acceptance& y, const Acceptance& x) const
{
    const auto angle = [](double opposite, double adjacent) {
        if (adjacent == 0) return pi / 2;
        const double acute = arc_tangent_one(opposite / adjacent);
        return adjacent > 0 ? acute : acute + pi;
    };
    const std::array corners{angle(y.low, x.low), angle(y.low, x.high), angle(y.high, x.low),
                             angle(y.high, x.high)};
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    return within_units({*low, *high}, rules_.atan2_units, rules_.atan2_units,
                        x.undefined || y.undefined);
}

/// Inherited from atan2(x, sqrt(1 - x * x)).
Acceptance Device::arc_sine(const Acceptance& x) const
{
    const Acceptance cosine = square_root(subtract(one, square(x)));
    const bool undefined = x.undefined || x.low < -1 || x.high > 1;
    // Odd in x: from the ends, each mirrored to where atan2 takes it.
    const auto at = [&](double end) {
        const Acceptance size{std::abs(end), std::abs(end), false};
        const Acceptance angle = atan2(size, cosine);
        return end < 0 ? Acceptance{-angle.high, -angle.low, false} : angle;
    };
    Acceptance result = hull(at(x.low), at(x.high));
    result.undefined = undefined;
    return result;
}

/// Inherited from atan2(sqrt(1 - x * x), x).
Acceptance Device::arc_cosine(const Acceptance& x) const
{
    Acceptance result = atan2(square_root(subtract(one, square(x))), x);
    result.undefined = x.undefined || x.low < -1 || x.high > 1;
    return result;
}

Acceptance Device::arc_tangent(const Acceptance& x) const
{
    return within_units(evaluate::arc_tangent(bounds(x)), rules_.atan2_units, rules_.atan2_units,
                        x.undefined);
}

/// normalize: inherited from x * inversesqrt(dot(x, x)), or from x / length(x).
Acceptance Device::normalized(const Acceptance& x, const Acceptance& squares) const
{
    const Acceptance product = multiply(x, inverse_square_root(squares));
    const Acceptance quotient = divide(x, square_root(squares));
    Acceptance result = hull(product, quotient);
    result.low = std::clamp(result.low, -longest(), longest());
    result.high = std::clamp(result.high, -longest(), longest());
    return result;
}

/// squares > 0 ? normalize(x) : 0
Acceptance Device::guarded_normalized(const Acceptance& x, const Acceptance& squares) const
{
    const bool undefined = x.undefined || squares.undefined;
    if (squares.high <= 0) return {0, 0, undefined};
    if (squares.low > 0) return normalized(x, squares);
    // A denormal sum may pass the guard and then be read as 0.
    return {x.low < 0 ? -longest() : 0, x.high > 0 ? longest() : 0, true};
}

/// mix: x * (1 - t) + y * t, or x + (y - x) * t.
Acceptance Device::lerp(const Acceptance& a, const Acceptance& b, const Acceptance& t) const
{
    const Acceptance weighted = add(multiply(a, subtract(one, t)), multiply(b, t));
    const Acceptance moved = add(a, multiply(subtract(b, a), t));
    Acceptance result = hull(weighted, moved);
    if (reaches_infinity(a) || reaches_infinity(b) || reaches_infinity(t)) return result;

    // Wide operands forget that both a's are one number. Over the reals the extremes are at the
    // corners; each formula adds at most four roundings of its largest term, and the flushing
    // of its terms.
    Interval exact{infinity, -infinity};
    for (const double from : {a.low, a.high})
        for (const double to : {b.low, b.high})
            for (const double weight : {t.low, t.high}) {
                const double corner = from + (to - from) * weight;
                exact = {std::min(exact.low, corner), std::max(exact.high, corner)};
            }
    const auto size = [](const Acceptance& x) {
        return std::max(std::abs(x.low), std::abs(x.high));
    };
    const double largest = (size(a) + size(b)) * (1 + size(t));
    const double error = 4.0001 * epsilon() * largest + 4 * rules_.least_normal;
    result.low = std::max(result.low, round_down(exact.low - error));
    result.high = std::min(result.high, round_up(exact.high + error));
    return result;
}

/// Inherited from t = clamp((x - edge0) / (edge1 - edge0), 0, 1), t * t * (3 - 2 * t).
Acceptance Device::smoothstep(const Acceptance& edge0, const Acceptance& edge1,
                              const Acceptance& x) const
{
    Acceptance t = divide(subtract(x, edge0), subtract(edge1, edge0));
    t.low = std::clamp(t.low, 0.0, 1.0);
    t.high = std::clamp(t.high, 0.0, 1.0);
    Acceptance result = multiply(square(t), subtract(three, multiply(two, t)));
    // The polynomial rises on [0, 1], with three roundings of it.
    const auto smooth = [](double at) { return at * at * (3 - 2 * at); };
    const double error = 4 * epsilon();
    result.low = std::max(result.low, round_down(smooth(t.low) * (1 - error)));
    result.high = std::min(result.high, round_up(smooth(t.high) * (1 + error)));
    result = flushed(result);
    if (edge1.low <= edge0.high) result.undefined = true;
    return result;
}

/// edge1 <= edge0 ? (x > edge0 ? 1 : 0) : smoothstep(edge0, edge1, x)
Acceptance Device::guarded_smoothstep(const Acceptance& edge0, const Acceptance& edge1,
                                      const Acceptance& x) const
{
    const bool undefined = edge0.undefined || edge1.undefined || x.undefined;
    Acceptance result{infinity, -infinity, undefined};
    if (edge1.low <= edge0.high) {
        if (x.low <= edge0.high) result = hull(result, zero);
        if (x.high > edge0.low) result = hull(result, one);
    }
    if (edge1.high > edge0.low) {
        Acceptance bare = smoothstep(edge0, edge1, x);
        // Taken only where the edges differ; then only a denormal difference is undefined.
        const Acceptance width = subtract(edge1, edge0);
        if (width.high >= rules_.least_normal && !undefined)
            bare.undefined = width.high > rules_.largest_divisor;
        result = hull(result, bare);
    }
    return result;
}

Acceptance Device::sum3(const Acceptance& a, const Acceptance& b, const Acceptance& c) const
{
    return hull(add(add(a, b), c), hull(add(add(a, c), b), add(a, add(b, c))));
}

Acceptance Device::sum4(const std::array<Acceptance, 4>& terms) const
{
    // Some two are added first, and then there are three.
    Acceptance result{infinity, -infinity, false};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            std::array<Acceptance, 2> rest;
            std::size_t size = 0;
            for (std::size_t k = 0; k < 4; ++k)
                if (k != i && k != j) rest[size++] = terms[k];
            result = hull(result, sum3(add(terms[i], terms[j]), rest[0], rest[1]));
        }
    return result;
}

Acceptance select(const Acceptance& condition, const Acceptance& yes, const Acceptance& no)
{
    if (condition.undefined) {
        Acceptance result = hull(yes, no);
        result.undefined = true;
        return result;
    }
    if (condition.low > 0) return yes;
    return condition.high == 0 ? no : hull(yes, no);
}

}  // namespace

const Rules& rules(Precision precision)
{
    return precision == Precision::float32 ? float32_rules : float16_rules;
}

Acceptance admit(const Rules& rules, Acceptance x) { return Device{rules}.admitted(x); }

Acceptance apply(const Rules& rules, TapeOp op, const Acceptance& a, const Acceptance& b,
                 const Acceptance& c, const Acceptance& d)
{
    const Device device{rules};
    // Operations that choose or compare, and round nothing.
    const auto exact1 = [&] {
        const Interval result = apply(op, bounds(a), {}, {}, {});
        return Acceptance{result.low, result.high, a.undefined};
    };
    const auto exact2 = [&] {
        const Interval result = apply(op, bounds(a), bounds(b), {}, {});
        return Acceptance{result.low, result.high, a.undefined || b.undefined};
    };

    switch (op) {
    case TapeOp::negate:
    case TapeOp::absolute:
    case TapeOp::sign:
    case TapeOp::floor:
    case TapeOp::saturate:
    case TapeOp::logical_not: return exact1();
    case TapeOp::minimum:
        return {std::min(a.low, b.low), std::min(a.high, b.high), a.undefined || b.undefined};
    case TapeOp::maximum:
        return {std::max(a.low, b.low), std::max(a.high, b.high), a.undefined || b.undefined};
    case TapeOp::step:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or: return exact2();
    case TapeOp::clamp: {
        const Interval result = apply(op, bounds(a), bounds(b), bounds(c), {});
        return {result.low, result.high, a.undefined || b.undefined || c.undefined};
    }
    case TapeOp::square: return device.square(a);
    case TapeOp::square_root: return device.square_root(a);
    case TapeOp::inverse_square_root: return device.inverse_square_root(a);
    case TapeOp::exp2: return device.exponential(a, exp2_one);
    case TapeOp::exp: return device.exponential(a, exp_one);
    case TapeOp::log2: return device.logarithm(a, log2_one);
    case TapeOp::log: return device.logarithm(a, log_one);
    case TapeOp::sine: return device.wave(a, sine(bounds(a)));
    case TapeOp::cosine: return device.wave(a, cosine(bounds(a)));
    case TapeOp::tangent: return device.tangent(a);
    case TapeOp::arc_sine: return device.arc_sine(a);
    case TapeOp::arc_cosine: return device.arc_cosine(a);
    case TapeOp::arc_tangent: return device.arc_tangent(a);
    case TapeOp::add: return device.add(a, b);
    case TapeOp::subtract: return device.subtract(a, b);
    case TapeOp::multiply: return device.multiply(a, b);
    case TapeOp::divide: return device.divide(a, b);
    case TapeOp::power: return device.power(a, b);
    case TapeOp::guarded_power: return device.guarded_power(a, b);
    case TapeOp::normalized: return device.normalized(a, b);
    case TapeOp::guarded_normalized: return device.guarded_normalized(a, b);
    case TapeOp::lerp: return device.lerp(a, b, c);
    case TapeOp::smoothstep: return device.smoothstep(a, b, c);
    case TapeOp::guarded_smoothstep: return device.guarded_smoothstep(a, b, c);
    case TapeOp::select: return select(a, b, c);
    case TapeOp::sum3: return device.sum3(a, b, c);
    case TapeOp::sum4: return device.sum4({a, b, c, d});
    }
    return {-infinity, infinity, true};
}

}  // namespace lobe::evaluate
