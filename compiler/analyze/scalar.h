// One scalar input of a function as a place to test: its ends, on the grid of a number format, and
// the value that says nothing.
#pragma once

#include "analyze/grid.h"
#include "ir/module.h"

#include <algorithm>
#include <vector>

namespace lobe::analyze {

struct Scalar {
    double low = 0;
    double high = 0;
    double neutral = 0;  ///< a parameter's default; else 1, or what is nearest to 0
    bool whole = false;  ///< holds integers only; booleans are 0 .. 1
    bool parameter = false;

    bool contains(double value) const { return low <= value && value <= high; }
    double nearest_to_zero() const { return std::clamp(0.0, low, high); }
};

/// One component of an input. Ends are rounded inwards: a range is a promise that points must keep.
Scalar scalar_of(const ir::Module& module, const ir::Input& input, int component, const Grid& grid);

/// All of a function, in the order of the inputs of its tape.
std::vector<Scalar> scalars_of(const ir::Module& module, const ir::Function& function,
                               const Grid& grid);

}  // namespace lobe::analyze
