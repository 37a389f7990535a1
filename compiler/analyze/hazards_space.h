// The inputs of an entry point as a space to search: steps to a neighbor, and the same thing said
// more simply.
#pragma once

#include "analyze/grid.h"
#include "analyze/random.h"
#include "ir/module.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lobe::analyze {

class HazardSpace {
public:
    using Point = std::vector<double>;  ///< one number of the grid per column

    HazardSpace(const ir::Module& module, ir::FunctionId function, evaluate::Precision precision);

    const ir::Function& entry() const { return entry_; }
    const std::vector<std::string>& names() const { return names_; }

    /// A point beside this one: one input moved by some floats, or to an end of its range, or a
    /// direction turned, or put on another one.
    Point neighbor(const Point& point, Random& random) const;

    /// The points that cannot be told from this one but for the last digit of one column: what is
    /// known of an input. A component of a direction is known to half a unit in the last place
    /// of 1.
    std::vector<Point> indistinguishable(const Point& point) const;

    /// The simplest point found at which `holds` still does: few digits, directions in one plane,
    /// parameters at their defaults.
    Point simplest(const Point& point, const std::function<bool(const Point&)>& holds) const;

    /// `falloff = 1, l = (0, 0, 1)`; parameters at their defaults are left out.
    std::string describe(const Point& point) const;

private:
    struct Scalar {
        double low = 0;
        double high = 0;
        double neutral = 0;
        bool whole = false;
    };
    using Triple = std::array<double, 3>;

    void place(Point& point, std::size_t first, const Triple& value) const;
    Triple at(const Point& point, std::size_t first) const;
    double inside(double value, const Scalar& scalar) const;
    void simplify_directions(Point& point, const std::function<bool(const Point&)>& holds) const;
    void simplify_scalar(Point& point, std::size_t column,
                         const std::function<bool(const Point&)>& holds) const;

    ir::Function entry_;
    const Grid* grid_;
    std::vector<std::string> names_;
    std::vector<Scalar> scalars_;            ///< by column; those of vectors are not used
    std::vector<std::size_t> vectors_;       ///< first columns of unit vectors free to turn: all
                                             ///< but the frame n, x, y
    std::vector<std::size_t> geometry_;      ///< of l, v, n and then x, y
    std::vector<std::size_t> free_scalars_;  ///< columns that are no vectors'
    std::vector<std::vector<double>> defaults_;  ///< by input; empty where there is none
};

}  // namespace lobe::analyze
