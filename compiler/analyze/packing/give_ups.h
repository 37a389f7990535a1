// What one could do without, and what that would gain: measured, not guessed.
#pragma once

#include "analyze/packing/sharing.h"

#include <string>
#include <vector>

namespace lobe::analyze {

/// The best layout in the room, if anything fits.
struct Best {
    const Shared* shared = nullptr;
    int most_bits = 0;  ///< of one field
};

/// Alternatives to it, each with the worst error that it would have, best first: channels whose
/// contents are lent, half the range of a parameter at either end (of those that are worst alone),
/// a parameter left at its default. Those that are hardly better are left out; where nothing fits,
/// all that would are named.
std::vector<std::string> give_ups(const ir::Module& module, const CodeSearch& subject,
                                  const std::vector<FittedCurve>& curves,
                                  const SuggestOptions& options, const Best& best);

}  // namespace lobe::analyze
