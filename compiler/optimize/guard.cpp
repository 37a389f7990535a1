#include "optimize/guard.h"

namespace lobe::optimize {

using namespace ir;

std::optional<DivisionGuard> find_guard(const Graph& graph, ExprId id)
{
    if (graph[id].op != Op::select) return std::nullopt;
    const auto operands = graph.operands(id);
    const ExprId condition = operands[0];
    const ExprId quotient = operands[1];
    if (graph[condition].op != Op::less_equal || graph[quotient].op != Op::divide)
        return std::nullopt;
    const ExprId least = graph.operands(condition)[0];
    const ExprId size = graph.operands(condition)[1];
    const ExprId divisor = graph.operands(quotient)[1];
    if (graph[least].op != Op::literal || !(graph.literal_of(least).value > 0)) return std::nullopt;
    const bool is_size =
        size == divisor || (graph[size].op == Op::absolute && graph.operands(size)[0] == divisor);
    return is_size ? std::optional{DivisionGuard{quotient, operands[2]}} : std::nullopt;
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
