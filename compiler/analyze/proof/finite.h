// Is every result finite on any Vulkan device? Acceptance intervals over boxes, divided where they
// cannot tell.
#pragma once

#include "analyze/proof/subject.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

struct Finite {
    std::vector<Box> open;  ///< where it is not proved; neighbors joined, largest first
    std::size_t boxes = 0;  ///< that were looked at
};

/// `budget`: how many boxes to look at (`boxes_within`) before what is left counts as open.
Finite prove_finite(const Subject& subject, const Box& box, std::size_t budget);

/// The first operation that may leave its domain or the format's range somewhere in the box, in
/// words; empty if none may.
std::string first_hazard(const Subject& subject, const Box& box);

/// A part of the box in which the result is finite: lower ends raised and upper ends lowered by
/// powers of two, no further than needed. Nothing if none of them does.
std::optional<Box> finite_part(const Subject& subject, std::size_t budget);

}  // namespace lobe::analyze
