// Single bounds, rounded in a chosen direction: what interval arithmetic is made of.
//
// A rounded result tells by its exact residue on which side of the true value it lies; only then
// does it move by one unit in the last place. So exact operations give exact bounds, and 1 * x is
// x. An infinite bound is never reached, so zero times it is zero, and their sum or quotient is
// never asked for what would be NaN.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lobe::evaluate {

constexpr double infinity = std::numeric_limits<double>::infinity();

inline double next_up(double x)
{
    if (x == infinity) return x;
    if (x == 0) return std::numeric_limits<double>::denorm_min();
    const auto bits = std::bit_cast<std::int64_t>(x);
    return std::bit_cast<double>(bits + (x > 0 ? 1 : -1));
}

inline double next_down(double x) { return -next_up(-x); }

/// Below this a product's residue may itself be rounded away.
constexpr double least_exact_product = 0x1p-960;

inline double add_up(double a, double b)
{
    const double sum = a + b;
    if (!(std::abs(sum) < infinity)) {
        // Overflow downward of finite numbers is above -infinity.
        const bool finite = std::abs(a) < infinity && std::abs(b) < infinity;
        return sum == -infinity && finite ? -std::numeric_limits<double>::max() : sum;
    }
    const double part = sum - a;
    const double residue = (a - (sum - part)) + (b - part);
    return residue > 0 ? next_up(sum) : sum;
}

inline double add_down(double a, double b) { return -add_up(-a, -b); }

inline double multiply_up(double a, double b)
{
    if (a == 0 || b == 0) return 0;
    const double product = a * b;
    const double size = std::abs(product);
    if (!(size < infinity)) {
        const bool finite = std::abs(a) < infinity && std::abs(b) < infinity;
        return product < 0 && finite ? -std::numeric_limits<double>::max() : product;
    }
    if (size < least_exact_product)
        return (a < 0) == (b < 0) ? next_up(product) : std::fmin(next_up(product), 0.0);
    return std::fma(a, b, -product) > 0 ? next_up(product) : product;
}

inline double multiply_down(double a, double b) { return -multiply_up(-a, b); }

/// `b` is not 0.
inline double divide_up(double a, double b)
{
    if (a == 0 || std::abs(b) == infinity) return 0;
    const double quotient = a / b;
    const double size = std::abs(quotient);
    if (!(size < infinity)) {
        const bool finite = std::abs(a) < infinity;
        return quotient < 0 && finite ? -std::numeric_limits<double>::max() : quotient;
    }
    if (size < least_exact_product || std::abs(a) < least_exact_product)
        return (a < 0) == (b < 0) ? next_up(quotient) : std::fmin(next_up(quotient), 0.0);
    const double residue = std::fma(-quotient, b, a);
    return (b > 0 ? residue : -residue) > 0 ? next_up(quotient) : quotient;
}

inline double divide_down(double a, double b) { return -divide_up(-a, b); }

/// `a` is not negative.
inline double root_up(double a)
{
    const double root = std::sqrt(a);
    if (a == 0 || a == infinity) return root;
    if (a < least_exact_product) return next_up(root);
    return std::fma(-root, root, a) > 0 ? next_up(root) : root;
}

inline double root_down(double a)
{
    const double root = std::sqrt(a);
    if (a == 0 || a == infinity) return root;
    if (a < least_exact_product) return next_down(root);
    return std::fma(-root, root, a) < 0 ? next_down(root) : root;
}

}  // namespace lobe::evaluate
