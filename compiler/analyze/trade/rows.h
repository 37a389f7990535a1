// Points of a yardstick's box in two guises: the floats that a shader gets, and in double what they
// stand for, with the definition's value of it.
#pragma once

#include "analyze/packing/radiance_meter.h"
#include "analyze/trade/yardstick.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// For every input of a tape, the coordinate of a box that has its name.
std::vector<std::size_t> columns_of(const RadianceBox& box, const evaluate::Tape& tape);

class Rows {
public:
    Rows(const Yardstick& yardstick, std::size_t size);

    std::size_t size() const { return size_; }
    float* column(std::size_t coordinate) { return &given_[coordinate * size_]; }
    const float* column(std::size_t coordinate) const { return &given_[coordinate * size_]; }
    std::vector<float> point(std::size_t row) const;

    /// What a meter holds, up to the number of rows.
    void take(RadianceMeter& meter);
    /// After the points are set: what they stand for, and the exact results.
    void settle();

    /// The exact results, component by component.
    const std::vector<double>& exact() const { return exact_; }
    double floor_of(std::size_t row) const { return floors_[row]; }

    /// A tape over these points: over the reals, or in a format. `columns` is `columns_of` it.
    void run(const evaluate::Tape& tape, std::span<const std::size_t> columns,
             std::optional<Format> format, std::vector<double>& results) const;
    /// The same with MPFR, at one point.
    std::vector<double> confirm(const evaluate::Tape& tape, std::span<const std::size_t> columns,
                                std::size_t row) const;

    /// `roughness = 0.5, l = (0, 0, 1)`; the frame is always the axes and left out.
    std::string describe(std::size_t row) const;

private:
    void normalize(std::size_t first);

    const Yardstick* yardstick_;
    std::size_t size_;
    std::vector<float> given_;    ///< column by column, as are all below
    std::vector<double> stands_;  ///< what they stand for
    std::vector<double> exact_;
    std::vector<double> floors_;
};

/// Points over the box, settled, in parts: every second one a usual one (deviation.h), the others
/// where errors are.
std::vector<Rows> survey(const Yardstick& yardstick, std::size_t points, unsigned jobs);

}  // namespace lobe::analyze
