// Slopes of a flat body with respect to its scalar inputs, for the range analysis: where a slope
// has one sign over a box, the extremes lie on the box's faces.
#pragma once

#include "check/flatten.h"

#include <vector>

namespace lobe::check {

/// A flat body whose roots are slopes: root `i` is the slope of the subject with respect to
/// `wanted[i]`. Evaluated over a box of intervals it contains the slope of every chord within the
/// box, also across kinks and jumps; it says nothing at single points.
struct ScalarInput {
    std::uint32_t input = 0;
    int component = 0;
};
Flat differentiate(const Flat& flat, ir::ExprId subject, const std::vector<ScalarInput>& wanted);

}  // namespace lobe::check
