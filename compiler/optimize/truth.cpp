#include "optimize/truth.h"

namespace lobe::optimize {

using namespace ir;

std::optional<bool> truth(const Graph& graph, ExprId condition)
{
    const Op op = graph[condition].op;
    if (op != Op::equal && op != Op::not_equal) return std::nullopt;
    for (const ExprId operand : graph.operands(condition))
        if (!graph.is_literal(operand, 0)) return std::nullopt;
    return op == Op::equal;
}

ExprId boolean(Graph& graph, bool value)
{
    const ExprId zero = graph.literal("0");
    return graph.apply(value ? Op::equal : Op::not_equal, {zero, zero});
}

}  // namespace lobe::optimize
