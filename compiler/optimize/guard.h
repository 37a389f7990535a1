// The shape of `a / b else c` in a graph: `t <= |b| ? a / b : c`, where t is the least number that
// divides (see docs/numerics.md). The abs is there only where b can be negative.
#pragma once

#include "ir/module.h"

#include <optional>

namespace lobe::optimize {

/// A choice between a quotient and its limit, by the divisor's size.
struct DivisionGuard {
    ir::ExprId quotient;  ///< a / b
    ir::ExprId limit;     ///< c
};

/// What `id` is, if it is such a choice.
std::optional<DivisionGuard> find_guard(const ir::Graph& graph, ir::ExprId id);

/// The divisions of a function whose value counts nowhere where their divisor is too small: every
/// use is the quotient of such a choice.
Facts<ir::Expr, bool> guarded_divisions(const ir::Function& function);

}  // namespace lobe::optimize
