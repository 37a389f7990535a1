// Literals as exact numbers: which ones a double holds, and arithmetic that is exact or refused.
//
// A literal is a real number. `5 * 0.5` is 2.5 for the paper, for a double and for a float, so
// it may be folded; `0.1 * 3` is 0.3 for the paper and another number for a double, so it stays
// and every evaluator rounds it its own way.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <span>

namespace lobe::optimize {

/// The value of a literal whose real number is exactly a double; nothing for 0.1 and pi.
std::optional<double> exact_value(const ir::Literal& literal);

/// The scalar that an expression is in every component: itself, or what a vector is spread from.
ir::ExprId spread_of(const ir::Graph& graph, ir::ExprId id);

/// The exact value of an expression that is a literal, or a vector spread from one.
std::optional<double> exact_literal(const ir::Graph& graph, ir::ExprId id);

/// `op` over exact operands, where the result is exactly a double too and no step on the way to
/// it rounds; nothing elsewhere.
std::optional<double> fold_exactly(ir::Op op, std::span<const double> operands);

}  // namespace lobe::optimize
