// What one expression simplifies to.
#pragma once

#include "evaluate/interval.h"
#include "ir/graph.h"

#include <optional>
#include <vector>

namespace lobe::optimize {

/// An expression about to be written: what it was, over operands that are simple already and
/// ranges that hold for them.
struct Draft {
    ir::Expr expr;
    std::vector<ir::ExprId> operands;
    std::vector<evaluate::Interval> ranges;
    Span span;
};

/// Something simpler of the same type and value, built in `graph`; nothing when there is none.
/// Over the real numbers exact, in double the same bits: see simplify.cpp. Calls are none of it.
std::optional<ir::ExprId> simpler(ir::Graph& graph, const Draft& draft);

}  // namespace lobe::optimize
