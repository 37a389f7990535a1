#include "analyze/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::analyze {

const Grid& grid_of(evaluate::Precision precision)
{
    static constexpr Grid single{evaluate::Precision::float32, 0x1.fffffep127, 0x1p-126, 0x1p-149,
                                 24};
    static constexpr Grid half{evaluate::Precision::float16, 65504, 0x1p-14, 0x1p-24, 11};
    return precision == evaluate::Precision::float16 ? half : single;
}

/// The distance from a value to the next one away from zero.
double step_at(double value, const Grid& grid)
{
    const double magnitude = std::abs(value);
    if (magnitude < grid.least_normal) return grid.least;
    return std::ldexp(1.0, std::ilogb(magnitude) - grid.digits + 1);
}

double next_above(double value, const Grid& grid)
{
    // Below zero the next number up has the smaller magnitude, and its binade counts.
    if (value < 0) return value + step_at(std::nextafter(value, 0.0), grid);
    return std::min(value + step_at(value, grid), grid.largest);
}

double next_below(double value, const Grid& grid) { return -next_above(-value, grid); }

float to_grid(double value, evaluate::Precision precision)
{
    const Grid& grid = grid_of(precision);
    if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
    value = std::clamp(value, -grid.largest, grid.largest);
    // Round once, from the double: through float first, halves could round twice.
    const double step = step_at(value, grid);
    const double scaled = value / step;  // exact: a power of two
    double rounded = std::floor(scaled);
    const double rest = scaled - rounded;
    if (rest > 0.5 || (rest == 0.5 && std::fmod(rounded, 2) != 0)) rounded += 1;
    return static_cast<float>(rounded * step);
}

}  // namespace lobe::analyze
