// Unit vectors to evaluate geometry at, exact to 200 bits.
#pragma once

#include "values.h"

namespace lobe::tests {

/// Pairs l, v above the horizon of n = (0, 0, 1), both within `spread` radians of a common axis
/// that leans `lean` radians from n. Columns l.x .. n.z.
inline Points<evaluate::Real> directions(std::mt19937& random, std::size_t count, double lean,
                                         double spread)
{
    using evaluate::Real;
    Points<Real> points;
    std::uniform_real_distribution<double> offset{-1, 1};
    const auto push = [&](const std::string& name, double x, double y) {
        // z = sqrt(1 - x^2 - y^2) at full precision makes the doubles x and y a unit vector.
        Real z{1, real_bits};
        for (const double part : {x, y}) {
            Real square{part, real_bits};
            mpfr_sqr(square.get(), square.get(), MPFR_RNDN);
            mpfr_sub(z.get(), z.get(), square.get(), MPFR_RNDN);
        }
        mpfr_sqrt(z.get(), z.get(), MPFR_RNDN);
        points[name + ".x"].emplace_back(x, real_bits);
        points[name + ".y"].emplace_back(y, real_bits);
        points[name + ".z"].push_back(z);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const double axis_x = lean * offset(random);
        const double axis_y = lean * offset(random) * 0.5;
        const double dx = spread * offset(random);
        const double dy = spread * offset(random);
        push("l", axis_x + dx, axis_y + dy);
        push("v", axis_x - dx, axis_y - dy);
        push("n", 0, 0);
    }
    return points;
}

/// Rounded to float. n stays exact; l and v are as far from unit as float vectors are.
inline Points<float> rounded(const Points<evaluate::Real>& points)
{
    Points<float> result;
    for (const auto& [name, column] : points)
        for (const evaluate::Real& value : column)
            result[name].push_back(static_cast<float>(value.to_double()));
    return result;
}

inline Points<evaluate::Real> widened(const Points<float>& points)
{
    Points<evaluate::Real> result;
    for (const auto& [name, column] : points)
        for (const float value : column) result[name].emplace_back(double{value}, real_bits);
    return result;
}

/// The largest relative error of float results against real ones.
inline double worst_error(const std::vector<float>& results,
                          const std::vector<evaluate::Real>& truth)
{
    double worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double exact = truth[i].to_double();
        worst = std::fmax(worst, std::fabs(double{results[i]} - exact) / std::fabs(exact));
    }
    return worst;
}

}  // namespace lobe::tests
