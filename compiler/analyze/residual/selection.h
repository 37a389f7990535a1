// The cheapest few of many shaders that serve everything: an exact search.
#pragma once

#include <cstddef>
#include <vector>

namespace lobe::analyze {

/// Groups that have to be served, each with a weight, by candidates, each at a price.
struct Selection {
    std::vector<double> weights;
    std::vector<double> prices;
    std::vector<std::vector<bool>> serves;  ///< by candidate, then group
};

struct Selected {
    std::vector<std::size_t> candidates;  ///< ascending
    std::vector<std::size_t> of_group;    ///< which of all candidates serves each group
    double cost = 0;                      ///< sum of weights times prices
    bool is_proved = true;                ///< false: the search gave up before it had seen enough
};

/// The cheapest choice of one candidate, of two, and so on, as long as one more makes it cheaper;
/// `most` at most (0: no limit). Empty if no candidate serves everything.
///
/// Candidates that another makes needless are never looked at; of the rest, branches are cut that
/// cannot become cheaper than what is known, even if every further pick saved all that it would
/// save alone.
std::vector<Selected> cheapest(const Selection& selection, std::size_t most);

}  // namespace lobe::analyze
