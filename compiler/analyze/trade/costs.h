// Which candidates of a trade are worth measuring, when all would take too long.
//
// The cost of a joint choice is estimated: that of the definitions, and for every chosen form what
// it alone changes. What an estimate cannot exclude from a frontier is measured, until everything
// else is dominated by something that was measured, even if its estimate were further off than any
// has been.
#pragma once

#include "analyze/trade/trade.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace lobe::analyze {

/// Which candidate a choice in a spelling is: the first of its formats.
class Ledger {
public:
    void note(const optimize::Choice& choice, optimize::Spelling spelling, std::size_t candidate)
    {
        candidates_[{choice, spelling}] = candidate;
    }
    std::size_t operator()(const optimize::Choice& choice, optimize::Spelling spelling) const
    {
        return candidates_.at({choice, spelling});
    }

private:
    std::map<std::pair<optimize::Choice, optimize::Spelling>, std::size_t> candidates_;
};

/// Fills in costs, drops the candidates that were not measured, and says how many those were:
/// `costs of 212, the others …`; nothing where all were.
std::string fill_in_costs(Trade& trade, const TradeSubject& subject, const Ledger& ledger,
                          const ParetoOptions& options, const Measurer& measurer);

}  // namespace lobe::analyze
