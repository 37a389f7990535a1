// Literals fold where the fold is exact, neutral operands go, what is unused goes.
//
// Over the real numbers the result is the same function. Evaluated in double it agrees bit for
// bit wherever the original is finite, with two exceptions that are improvements: the sign of a
// zero, and powers and elementary functions of literals, where the fold is exact and a kernel
// rounds. Rewrites that need a proof (`0 * x` needs a finite x, `saturate(x)` an x in [0, 1])
// use the ranges of evaluate, which hold for real numbers and for float evaluation alike.
//
// Comparisons that ranges decide become the constants `0 == 0` and `0 != 0`, the only booleans
// that the graph can write down. Nothing here reassociates.
#include "evaluate/run.h"
#include "optimize/literal.h"
#include "optimize/neutral.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/truth.h"

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

/// A literal, or a vector of them.
bool is_constant(const Graph& graph, ExprId id)
{
    if (graph[id].op == Op::literal || truth(graph, id)) return true;
    return graph[id].op == Op::construct &&
           std::ranges::all_of(graph.operands(id),
                               [&](ExprId part) { return graph[part].op == Op::literal; });
}

Interval range_of_constant(const Graph& graph, ExprId id)
{
    const auto value = exact_literal(graph, id);
    return value ? Interval{*value, *value} : Interval{-HUGE_VAL, HUGE_VAL};
}

/// The body of a function over these operands, simplified on the way.
ExprId inlined(Graph& graph, const Function& callee, std::span<const ExprId> arguments)
{
    Facts<Expr, ExprId> moved(callee.graph.size());
    for (const ExprId id : callee.graph.ids()) {
        Draft draft{callee.graph[id], {}, {}, callee.graph.span(id)};
        if (draft.expr.op == Op::input) {
            moved[id] = arguments[draft.expr.aux];
            continue;
        }
        for (const ExprId operand : callee.graph.operands(id)) {
            draft.operands.push_back(moved[operand]);
            draft.ranges.push_back(range_of_constant(graph, moved[operand]));
        }
        const auto better = simpler(graph, draft);
        moved[id] = better ? *better : graph.copy(callee.graph, id, draft.operands);
    }
    return moved[callee.result];
}

/// A call that is not worth its name: of a constant, of one of its own operands, or with nothing
/// but constants for operands and a value that folds exactly.
std::optional<ExprId> simpler_call(Rebuild& rebuild, ExprId call)
{
    Graph& graph = rebuild.graph;
    const Function& callee = rebuild.rebuilt(FunctionId{graph[call].aux});
    const Expr& body = callee.graph[callee.result];
    const auto written = graph.operands(call);
    const std::vector<ExprId> operands{written.begin(), written.end()};

    if (body.op == Op::input) return operands[body.aux];
    const bool constant =
        is_constant(callee.graph, callee.result) ||
        std::ranges::all_of(operands, [&](ExprId id) { return is_constant(graph, id); });
    if (!constant) return std::nullopt;
    const ExprId value = inlined(graph, callee, operands);
    return is_constant(graph, value) ? std::optional{value} : std::nullopt;
}

Step simplify_function(Rebuild& rebuild)
{
    const Function& old = rebuild.old();
    auto ranges = evaluate::ranges(rebuild.old_module(), old, evaluate::declared_ranges(old));
    return [&rebuild, &old, ranges = std::move(ranges)](ExprId id) {
        const Expr expr = old.graph[id];
        if (shape(expr.op) == Shape::leaf) return rebuild.copy(id);
        if (expr.op == Op::call) {
            const ExprId call = rebuild.copy(id);
            return simpler_call(rebuild, call).value_or(call);
        }
        Draft draft{expr, rebuild.moved_operands(id), {}, old.graph.span(id)};
        for (const ExprId operand : old.graph.operands(id)) draft.ranges.push_back(ranges[operand]);
        const auto better = simpler(rebuild.graph, draft);
        return better ? *better : rebuild.copy(id);
    };
}

/// Which functions differ between two modules, or call one that does.
std::vector<bool> changed(const Module& before, const Module& after)
{
    std::vector<bool> result;
    for (std::size_t i = 0; i < after.functions.size(); ++i) {
        const Function& function = after.functions[i];
        result.push_back(!same_function(before.functions[i], function) ||
                         any_expression(function.graph, [&](ExprId id) {
                             const Expr& expr = function.graph[id];
                             return expr.op == Op::call && result[expr.aux];
                         }));
    }
    return result;
}

Module simplify_where(std::vector<bool> open, const Module& module)
{
    // A fold may expose another one to the left of it, or sharpen a range. Every round removes
    // something or is the last; the bound is for the reader's peace of mind.
    constexpr int most_rounds = 32;
    Module current = module;
    for (int round = 0; round < most_rounds && std::ranges::find(open, true) != open.end();
         ++round) {
        Module next = rewrite(current, [&open](Rebuild& rebuild) {
            return open[rebuild.id().index] ? simplify_function(rebuild) : Step{};
        });
        open = changed(current, next);
        current = std::move(next);
    }
    return current;
}

}  // namespace

Module simplify(const Module& module)
{
    return simplify_where(std::vector<bool>(module.functions.size(), true), module);
}

Module simplify_again(const Module& simple, const Module& module)
{
    return simplify_where(changed(simple, module), module);
}

}  // namespace lobe::optimize
