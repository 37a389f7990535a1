// One trade: every way to compute a term or a model, how far each is off, and what it costs.
#pragma once

#include "analyze/pareto.h"
#include "analyze/trade/candidates.h"

#include <functional>
#include <set>
#include <span>
#include <utility>

namespace lobe::analyze {

/// How costs are had: `measure_costs`, or a stand-in.
using Measurer = std::function<Costs(std::span<const CostSubject>)>;

/// Terms and forms that the compiler found.
using FoundNames = std::set<std::pair<std::string, std::string>>;

/// For a term the costs of all candidates are measured. For a model, errors are, and costs of
/// those that can be on a frontier; the others are left out and `Trade::search` says so.
Trade trade(const TradeSubject& subject, const FoundNames& found, const ParetoOptions& options,
            const Measurer& measurer, const Store& store);

/// What cannot be emitted takes no place from what can.
bool may_dominate(const Candidate& one, const Candidate& other);

/// Sets the standing of every candidate.
void judge(Trade& trade);

}  // namespace lobe::analyze
