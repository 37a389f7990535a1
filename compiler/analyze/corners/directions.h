// Pairs of directions at and next to every boundary that geometry has: along the normal, at the
// horizon and a float above and below it, coinciding, mirrored and opposed, exactly and nearly.
//
// "Next to" is a float away, and where squares and fourth powers of a cosine reach what `else`
// counts as 0 (2^-64), become subnormal or vanish.
#pragma once

#include "analyze/directions.h"

#include <vector>

namespace lobe::analyze {

/// All of them, in double: every pair of elevations around an axis, fewer around other normals.
std::vector<Directional> corner_directions();

/// The few of them that every setting of the other inputs is tried with.
std::vector<Directional> core_directions();

}  // namespace lobe::analyze
