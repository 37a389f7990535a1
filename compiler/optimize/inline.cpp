#include "optimize/inline.h"

#include <vector>

namespace lobe::optimize {

using namespace ir;

ExprId inline_body(Graph& graph, const Function& callee, std::span<const ExprId> operands)
{
    Facts<Expr, ExprId> moved(callee.graph.size());
    std::vector<ExprId> moved_operands;
    for (const ExprId id : callee.graph.ids()) {
        if (callee.graph[id].op == Op::input) {
            moved[id] = operands[callee.graph[id].aux];
            continue;
        }
        moved_operands.clear();
        for (const ExprId operand : callee.graph.operands(id))
            moved_operands.push_back(moved[operand]);
        moved[id] = graph.copy(callee.graph, id, moved_operands);
    }
    return moved[callee.result];
}

Function inline_calls(const Module& module, FunctionId id)
{
    // Callees come first, so the bodies that are needed have no calls any more.
    std::vector<Function> flat;
    for (std::size_t i = 0; i <= id.index; ++i) {
        const Function& function = module.functions[i];
        Function result = function;
        result.graph = {};
        Facts<Expr, ExprId> moved(function.graph.size());
        std::vector<ExprId> operands;
        for (const ExprId expr : function.graph.ids()) {
            operands.clear();
            for (const ExprId operand : function.graph.operands(expr))
                operands.push_back(moved[operand]);
            moved[expr] = function.graph[expr].op == Op::call
                              ? inline_body(result.graph, flat[function.graph[expr].aux], operands)
                              : result.graph.copy(function.graph, expr, operands);
        }
        result.result = moved[function.result];
        flat.push_back(std::move(result));
    }
    return flat[id.index];
}

}  // namespace lobe::optimize
