// Rounding, arithmetic, roots, exponentials and logarithms of a device.
#include "evaluate/device_rules.h"
#include "evaluate/intervals.h"
#include "evaluate/kernels.h"

namespace lobe::evaluate {
namespace {

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

// The ends of operands are numbers of the format, so their products are exact in double, and a
// quotient or root is off by much less than what the table adds.

constexpr double slack = 0x1p-20;  // units

/// An infinite end times zero is zero.
double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

/// The values of an increasing function at both ends.
Interval ends(Interval x, double (*function)(double))
{
    const double low = function(x.low);
    return {low, x.high == x.low ? low : function(x.high)};
}

}  // namespace

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
    // Beyond the largest number is the infinity, too.
    return flushed({low < -rules_.largest ? -infinity : least,
                    high > rules_.largest ? infinity : most, undefined});
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
    // A multiple of 0, or 0 rounded: no device gives anything else.
    if (promised && a.low == 0 && a.high == 0) return {0, 0, undefined};
    const double units = 2.5 + slack;
    if (a.low >= 0 && b.low > 0) {
        Acceptance result = within_units({a.low / b.high, a.high / b.low}, units, units, undefined);
        // Read literally, an error of units of a denormal may cross 0; no device does that.
        result.low = std::max(result.low, 0.0);
        return result;
    }
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

}  // namespace lobe::evaluate
