// What the compiler does about a hazard: the rule or the guard that the emitted spelling has at the
// place of the expression.
#pragma once

#include "analyze/hazards.h"
#include "analyze/hazards_line.h"
#include "optimize/stabilize.h"

#include <optional>
#include <span>
#include <vector>

namespace lobe::analyze {

/// The remedy of a hazard at `expression` of the naive line, if the emitted line has one; without
/// its cycles. `applied` are the rules that stabilizing used in the module.
std::optional<Remedy> remedy_of(const WatchedLine& naive, ir::ExprId expression,
                                const WatchedLine& emitted,
                                std::span<const optimize::Application> applied);

/// The emitted module without the guards at a place: what they cost is the difference.
ir::Module without_guards_at(const ir::Module& emitted, const Span& span);

}  // namespace lobe::analyze
