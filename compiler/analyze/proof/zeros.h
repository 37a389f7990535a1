// Points at which sums on the way vanish: next to them a difference is all rounding, and whatever
// is divided by it, or turned into a direction, is as wrong as it can be. And points at which a
// minimum, a maximum or a condition changes sides, where slopes are often greatest. Random points
// and climbs from them come near to one such place; near to several at once, hardly ever.
#pragma once

#include "analyze/proof/subject.h"

#include <cstddef>
#include <cstdint>

namespace lobe::analyze {

/// Up to `count` points of the box: from a random one, each of one to three sums or choices is
/// brought to where it changes, along one coordinate each; and neighbors of these. Fewer where none
/// does.
std::vector<Point> points_at_zeros(const Subject& subject, const Box& box, std::size_t count,
                                   std::uint64_t key);

}  // namespace lobe::analyze
