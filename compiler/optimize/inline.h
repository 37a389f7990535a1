// Calls replaced by the bodies of what they call.
#pragma once

#include "ir/module.h"

#include <span>

namespace lobe::optimize {

/// The body of a function over these operands, one per input, in `graph`.
ir::ExprId inline_body(ir::Graph& graph, const ir::Function& callee,
                       std::span<const ir::ExprId> operands);

/// The function without calls. Equal subexpressions of different callees become one, so this is
/// also the way to ask whether two functions compute the same.
ir::Function inline_calls(const ir::Module& module, ir::FunctionId id);

}  // namespace lobe::optimize
