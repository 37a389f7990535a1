// Constant conditions. The graph has no boolean literal: `0 == 0` is true and `0 != 0` is false.
#pragma once

#include "ir/graph.h"

#include <optional>

namespace lobe::optimize {

/// What a condition is known to be, if it is one of the two constants. The answer to whether an
/// effect is off: the result of its condition once its parameters are fixed and simplified.
std::optional<bool> truth(const ir::Graph& graph, ir::ExprId condition);

/// The constant condition with this value.
ir::ExprId boolean(ir::Graph& graph, bool value);

}  // namespace lobe::optimize
