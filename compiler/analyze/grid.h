// The numbers of a float format, as a set: what is next to what, and what is nearest.
#pragma once

#include "evaluate/run.h"

namespace lobe::analyze {

/// What is particular about a format.
struct Grid {
    evaluate::Precision precision{};
    double largest = 0;  ///< finite
    double least_normal = 0;
    double least = 0;  ///< above 0
    int digits = 0;    ///< of the significand, with the hidden one
};

const Grid& grid_of(evaluate::Precision precision);

/// The distance from a value to the next one away from zero, in its binade.
double step_at(double value, const Grid& grid);

/// The neighbors of a number of the grid; the largest has none above.
double next_above(double value, const Grid& grid);
double next_below(double value, const Grid& grid);

/// The nearest number of the grid, ties to even, as a float. Overflow becomes the largest
/// finite one.
float to_grid(double value, evaluate::Precision precision);

}  // namespace lobe::analyze
