// What a device builds from its arithmetic: angles, normalize, mix, smoothstep, sums.
#include "evaluate/device_rules.h"
#include "evaluate/intervals.h"
#include "evaluate/kernels.h"

namespace lobe::evaluate {
namespace {

constexpr Acceptance two{2, 2, false};
constexpr Acceptance three{3, 3, false};
constexpr double pi = 3.141592653589793;

}  // namespace

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

}  // namespace lobe::evaluate
