// The inputs of an entry point as a space to search: steps to a neighbor, and the same thing said
// more simply.
#pragma once

#include "analyze/entry_inputs.h"
#include "analyze/random.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace lobe::analyze {

class HazardSpace {
public:
    using Point = EntryInputs::Values;  ///< numbers of the grid

    HazardSpace(const ir::Module& module, ir::FunctionId function, evaluate::Precision precision);

    const EntryInputs& inputs() const { return inputs_; }
    const Grid& grid() const { return *grid_; }

    /// A point beside this one: one input moved by some floats, or to an end of its range, or a
    /// direction turned, or put on another one; or all directions turned together.
    Point neighbor(const Point& point, Random& random) const;

    /// The points that cannot be told from this one but for the last digit of one column: what is
    /// known of an input. A component of a direction is known to half a unit in the last place
    /// of 1.
    std::vector<Point> indistinguishable(const Point& point) const;

    /// The simplest point found at which `holds` still does: few digits, directions in one plane,
    /// parameters at their defaults.
    Point simplest(const Point& point, const std::function<bool(const Point&)>& holds) const;

private:
    void place(Point& point, std::size_t first, const Vector& value) const;
    /// All directions, so that they keep their angles but not their digits.
    void reflect(Point& point, const Vector& mirror) const;
    double inside(double value, const Scalar& scalar) const;
    void simplify_directions(Point& point, const std::function<bool(const Point&)>& holds) const;
    void simplify_scalar(Point& point, std::size_t column,
                         const std::function<bool(const Point&)>& holds) const;

    const Grid* grid_;
    EntryInputs inputs_;
    std::vector<std::size_t> vectors_;   ///< first columns of unit vectors, the frame's too
    std::vector<std::size_t> turnable_;  ///< those that are no n, x or y
    std::vector<std::size_t> numbers_;   ///< columns that are no vectors'
};

}  // namespace lobe::analyze
