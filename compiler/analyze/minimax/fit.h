// The ratio of two polynomials that is nearest to a function, by its greatest difference.
//
// In: a function of one or two variables, known on a lattice. Out: coefficients. The differential
// correction algorithm ([Barrodale72]) solves one linear program per step and gets no worse; a
// polynomial takes one step, and another one that polishes it. Programs see few of the points;
// where the result is worse than on those, the worst points join them: Remez' exchange, in any
// number of variables.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// x^x y^y
struct Powers {
    int x = 0;
    int y = 0;
    friend bool operator==(const Powers&, const Powers&) = default;
};

/// What polynomials are made of. The denominator's constant is 1, and is not among its powers; with
/// none it is a polynomial.
struct Shape {
    std::vector<Powers> numerator;
    std::vector<Powers> denominator;
};

/// Coefficients in the order of a shape's powers.
struct Ratio {
    std::vector<double> numerator;
    std::vector<double> denominator;
};

struct Place {
    double x = 0;
    double y = 0;
};

double denominator_at(const Shape& shape, const Ratio& ratio, Place at);
double value_at(const Shape& shape, const Ratio& ratio, Place at);

/// A function on a lattice, row after row, and at places between that a fit must see.
struct Samples {
    std::size_t width = 0;
    std::size_t height = 0;  ///< 1 for one variable
    std::vector<Place> places;
    std::vector<double> values;
};

/// Places of a lattice that differ more than their neighbors and than `above`; greatest first.
std::vector<std::size_t> peaks(const std::vector<double>& differences, std::size_t width,
                               std::size_t height, double above, std::size_t most);

struct Fit {
    Ratio ratio;
    double level = 0;  ///< greatest difference over the samples
};

/// A denominator stays above this over the samples, where its constant is 1.
inline constexpr double least_denominator = 0x1p-4;

/// The best fit in places with coordinates in [-1, 1]; nothing where the programs find none.
std::optional<Fit> best_fit(const Shape& shape, const Samples& samples);

/// A fit with coefficients that are floats: rounded one by one, the greatest first, since it moves
/// furthest, each time making the best of those that are left.
Fit round_to_float(const Shape& shape, const Samples& samples, const Fit& fit);

}  // namespace lobe::analyze
