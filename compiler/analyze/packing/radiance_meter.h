// The error of many points at once: radiance of what was asked for, and of what is stored of it.
//
// Points are floats and stored values what a shader gets, but radiance is computed in double: what
// float loses in an expression, as between two highlights of different size, it loses with and
// without a packing.
#pragma once

#include "analyze/packing/radiance_box.h"
#include "analyze/packing/steps.h"

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace lobe::analyze {

/// Radiance of an 18 % grey card, over n.l: what errors are relative to where a pixel is darker.
inline constexpr double grey_card = 0.18 / std::numbers::pi;

/// Which coordinates are stored, and as what: one entry per coordinate, null where it is not.
using StoredAs = std::vector<const Steps*>;

class RadianceMeter {
public:
    RadianceMeter(const RadianceBox& box, std::size_t rows);

    std::size_t rows() const { return rows_; }
    /// The points, to be filled in.
    double* column(std::size_t coordinate) { return &points_[coordinate * rows_]; }
    void set(std::size_t row, std::span<const float> point);
    void set_all(std::span<const float> point);
    std::vector<float> point(std::size_t row) const;

    /// The radiance of the points as they are. Comes before `compare`.
    void light();
    /// The error of every point with some coordinates stored (see radiance.h); 0 where the radiance
    /// is not finite, infinite where only the packed one is not.
    const std::vector<double>& compare(const StoredAs& stored);

    /// Of the last two, for one point: the channel with the error.
    struct Detail {
        double error = 0;
        double exact = 0;
        double packed = 0;
    };
    Detail detail(std::size_t row) const;
    /// The same point on a display: the greatest difference of a channel in 8-bit codes
    /// (trade/deviation.h).
    double codes(std::size_t row) const;

private:
    std::vector<const double*> heads() const;
    double floor_of(std::size_t row) const;

    const RadianceBox& box_;
    std::size_t rows_;
    std::vector<double> points_;  ///< column by column, as are all below
    std::vector<double> stored_;
    std::vector<double> exact_;
    std::vector<double> packed_;
    std::vector<double> errors_;
};

}  // namespace lobe::analyze
