#include "optimize/guard.h"

namespace lobe::optimize {

using namespace ir;

std::optional<DivisionGuard> find_guard(const Graph& graph, ExprId id)
{
    if (graph[id].op != Op::select) return std::nullopt;
    const auto operands = graph.operands(id);
    const ExprId condition = operands[0];
    const Op op = graph[condition].op;
    if (op != Op::equal && op != Op::not_equal) return std::nullopt;
    const DivisionGuard guard = op == Op::equal ? DivisionGuard{operands[2], operands[1]}
                                                : DivisionGuard{operands[1], operands[2]};
    if (graph[guard.quotient].op != Op::divide) return std::nullopt;
    const ExprId divisor = graph.operands(guard.quotient)[1];
    const auto sides = graph.operands(condition);
    const bool is_zero_test = (sides[0] == divisor && graph.is_literal(sides[1], 0)) ||
                              (sides[1] == divisor && graph.is_literal(sides[0], 0));
    return is_zero_test ? std::optional{guard} : std::nullopt;
}

Facts<Expr, bool> guarded_divisions(const Function& function)
{
    const Graph& graph = function.graph;
    const auto uses = use_counts(graph, function.result);
    Facts<Expr, int> guarded_uses(graph.size());
    for (const ExprId id : graph.ids()) {
        if (uses[id] == 0) continue;
        if (const auto guard = find_guard(graph, id)) ++guarded_uses[guard->quotient];
    }
    Facts<Expr, bool> result(graph.size());
    for (const ExprId id : graph.ids())
        result[id] = graph[id].op == Op::divide && uses[id] > 0 && uses[id] == guarded_uses[id];
    return result;
}

}  // namespace lobe::optimize
