#include "optimize/binary.h"

#include "optimize/literal.h"
#include "optimize/rewrite.h"

#include <algorithm>

namespace lobe::optimize {

using namespace ir;

namespace {

/// Whether every component of an expression is 0 or 1, by expression.
using Ends = Facts<Expr, bool>;

/// By function and input: everything that is passed to it is 0 or 1, or it is named so.
using InputEnds = std::vector<std::vector<bool>>;

bool is_positive_literal(const Graph& graph, ExprId id)
{
    const ExprId scalar = spread_of(graph, id);
    return graph[scalar].op == Op::literal && graph.literal_of(scalar).value > 0;
}

bool is_end(const Graph& graph, ExprId id, const Ends& ends, const std::vector<bool>& inputs)
{
    const Expr& expr = graph[id];
    const auto operands = graph.operands(id);
    const auto all = [&] {
        return std::ranges::all_of(operands, [&](ExprId operand) { return ends[operand]; });
    };
    switch (expr.op) {
    case Op::literal: return graph.is_literal(id, 0) || graph.is_literal(id, 1);
    case Op::input: return inputs[expr.aux];
    case Op::step: return true;
    case Op::subtract: return exact_literal(graph, operands[0]) == 1 && ends[operands[1]];
    case Op::select: return ends[operands[1]] && ends[operands[2]];
    case Op::power:
    case Op::guarded_power: return ends[operands[0]] && is_positive_literal(graph, operands[1]);
    case Op::multiply:
    case Op::minimum:
    case Op::maximum:
    case Op::lerp:
    case Op::saturate:
    case Op::absolute:
    case Op::floor:
    case Op::square_root:
    case Op::component:
    case Op::construct: return all();
    default: return false;
    }
}

Ends ends_of(const Function& function, const std::vector<bool>& inputs)
{
    Ends ends(function.graph.size());
    for (const ExprId id : function.graph.ids())
        ends[id] = is_end(function.graph, id, ends, inputs);
    return ends;
}

/// What callers pass, from the roots down.
InputEnds input_ends(const Module& module, const std::set<std::string>& binary)
{
    InputEnds result;
    std::vector<std::vector<bool>> passed;
    for (const Function& function : module.functions) {
        auto& inputs = result.emplace_back();
        for (const Input& input : function.inputs)
            inputs.push_back(
                (input.origin == Origin::parameter || input.origin == Origin::surface) &&
                binary.contains(input.name));
        passed.emplace_back(function.inputs.size(), true);
    }
    const std::vector<bool> is_root = root_flags(module);
    const std::vector<FunctionId> reachable = module.reachable(all_roots(module));
    // Callers come after what they call.
    for (auto at = reachable.rbegin(); at != reachable.rend(); ++at) {
        const Function& function = module[*at];
        for (std::size_t i = 0; i < function.inputs.size() && !is_root[at->index]; ++i)
            if (function.inputs[i].origin == Origin::argument)
                result[at->index][i] = passed[at->index][i];
        const Ends ends = ends_of(function, result[at->index]);
        const auto uses = use_counts(function.graph, function.result);
        for (const ExprId id : function.graph.ids()) {
            if (function.graph[id].op != Op::call || uses[id] == 0) continue;
            const auto operands = function.graph.operands(id);
            for (std::size_t i = 0; i < operands.size(); ++i)
                if (!ends[operands[i]]) passed[function.graph[id].aux][i] = false;
        }
    }
    return result;
}

}  // namespace

Module choose_ends(const Module& module, const std::set<std::string>& binary)
{
    if (binary.empty()) return module;
    const InputEnds inputs = input_ends(module, binary);
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        const Function& old = rebuild.old();
        Ends ends = ends_of(old, inputs[rebuild.id().index]);
        return [&rebuild, &old, ends = std::move(ends)](ExprId id) {
            const Graph& graph = old.graph;
            const auto operands = graph.operands(id);
            switch (graph[id].op) {
            case Op::multiply:
                if (operands[0] == operands[1] && ends[operands[0]])
                    return rebuild.moved(operands[0]);
                break;
            case Op::power:
            case Op::guarded_power:
                if (ends[id] && graph[operands[0]].type == graph[id].type)
                    return rebuild.moved(operands[0]);
                break;
            case Op::saturate:
            case Op::absolute:
            case Op::floor:
            case Op::square_root:
                if (ends[operands[0]]) return rebuild.moved(operands[0]);
                break;
            case Op::lerp: {
                const ExprId weight = spread_of(graph, operands[2]);
                if (components(graph[id].type) == 1 || graph[weight].type != Type::scalar ||
                    !ends[weight])
                    break;
                Graph& to = rebuild.graph;
                const Span span = graph.span(id);
                const ExprId is_one =
                    to.apply(Op::less, {to.literal("0.5", span), rebuild.moved(weight)}, span);
                return to.apply(Op::select,
                                {is_one, rebuild.moved(operands[1]), rebuild.moved(operands[0])},
                                span);
            }
            default: break;
            }
            return rebuild.copy(id);
        };
    });
}

}  // namespace lobe::optimize
