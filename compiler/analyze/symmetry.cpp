#include "analyze/symmetry.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

bool commutes(ir::Op op)
{
    switch (op) {
    case ir::Op::add:
    case ir::Op::multiply:
    case ir::Op::minimum:
    case ir::Op::maximum:
    case ir::Op::equal:
    case ir::Op::not_equal:
    case ir::Op::logical_and:
    case ir::Op::logical_or:
    case ir::Op::dot: return true;
    default: return false;
    }
}

/// Copies the function's graph into `out` with inputs a and b exchanged and the operands of
/// commutative operations in the order of their ids there. Hash-consing then makes graphs that
/// differ only in that order the same expression.
ir::ExprId canonical(ir::Graph& out, const ir::Function& function, std::uint32_t a, std::uint32_t b)
{
    const ir::Graph& graph = function.graph;
    std::vector<ir::ExprId> moved(graph.size());
    for (const ir::ExprId id : graph.ids()) {
        const ir::Expr& expr = graph[id];
        if (expr.op == ir::Op::input) {
            const std::uint32_t index = expr.aux == a ? b : expr.aux == b ? a : expr.aux;
            moved[id.index] = out.input(index, expr.type);
            continue;
        }
        std::vector<ir::ExprId> operands;
        for (const ir::ExprId operand : graph.operands(id))
            operands.push_back(moved[operand.index]);
        if (commutes(expr.op)) std::ranges::sort(operands);
        moved[id.index] = out.copy(graph, id, operands);
    }
    return moved[function.result.index];
}

}  // namespace

bool is_symmetric(const ir::Function& function, std::uint32_t a, std::uint32_t b)
{
    if (function.inputs[a].type != function.inputs[b].type) return false;
    ir::Graph both;
    const ir::ExprId plain = canonical(both, function, a, a);
    return plain == canonical(both, function, a, b);
}

}  // namespace lobe::analyze
