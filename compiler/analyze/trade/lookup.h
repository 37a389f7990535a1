// A term of two numbers as engines often have it: a table that a texture unit reads.
//
// N x N texels over the declared ranges, the first and the last on their ends, filtered bilinearly.
// Model error: what interpolation loses. Rounding: what the texels' format and the filter's weights
// of 8 bits lose (Vulkan asks for 4, hardware has 8).
#pragma once

#include "analyze/pareto.h"
#include "analyze/trade/candidates.h"
#include "analyze/trade/yardstick.h"

#include <vector>

namespace lobe::analyze {

/// A few sizes and formats, to compare with: a build emits none, and what a sample costs is the
/// memory's matter. None for a term that a table does not suit: of other arguments, or so short
/// that computing it is no more than finding the place in a table.
std::vector<Candidate> lookup_candidates(const TradeSubject& subject, const Yardstick& yardstick,
                                         const ParetoOptions& options);

}  // namespace lobe::analyze
