// Looks for hazards in one spelling of a function: over many points, then by climbing from the best
// of them; and makes each witness as simple as it can be.
#pragma once

#include "analyze/hazards/hazards.h"
#include "analyze/hazards/judge.h"
#include "analyze/hazards/space.h"
#include "analyze/points.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A hazard of a watched line, before it is put into words. All that is kept in a store.
struct FoundHazard {
    HazardKind kind{};
    std::size_t instruction = 0;
    double share = 0;      ///< of the points
    double lost_bits = 0;  ///< at the witness
    HazardSpace::Point witness;
};

/// The result of one component that is farthest off.
struct WorstResult {
    std::size_t component = 0;
    double result = 0;
    double exact = 0;
    double error = 0;  ///< scaled
};
/// Of a point that both traces ran: the outputs of one as a device computes them, against the exact
/// ones of the other.
WorstResult worst_result(const Trace& trace, const Trace& truth);

/// `truth` is the line of the emitted spelling: over the reals it is the function, defined
/// everywhere. One hazard per expression as written and kind, worst first.
std::vector<FoundHazard> search_hazards(const WatchedLine& line, const WatchedLine& truth,
                                        const HazardSpace& space, const Points& points,
                                        evaluate::Precision precision);

/// The share of the points where the result of a line is NaN or infinite on a device.
double not_finite_share(const WatchedLine& line, const Points& points,
                        evaluate::Precision precision);

}  // namespace lobe::analyze
