// What one could do without, and what that would gain: measured, not guessed.
#pragma once

#include "analyze/sharing.h"

#include <string>
#include <vector>

namespace lobe::analyze {

/// Alternatives to the best layout in the room, each with the worst error that it would have, best
/// first: channels whose contents are lent, half the range of a parameter at either end, a
/// parameter left at its default. Those that are not better than `error` are left out; without an
/// `error` nothing fits and all that would are named.
std::vector<std::string> give_ups(const ir::Module& module, const Subject& subject,
                                  const std::vector<FittedCurve>& curves,
                                  const SuggestOptions& options, int most_bits,
                                  std::optional<double> error);

}  // namespace lobe::analyze
