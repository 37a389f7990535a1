#include "analyze/minimax/parts.h"

#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace lobe::analyze {
namespace {

using ir::ExprId;
using ir::Op;

bool is_side(const ir::Input& input)
{
    return input.type == ir::Type::scalar && input.quantity == ir::Quantity::number &&
           std::isfinite(input.range.low) && std::isfinite(input.range.high) &&
           input.range.low < input.range.high;
}

/// The expression as a function of its own, of the inputs that it reads.
ir::Function alone(const ir::Function& term, ExprId root, const std::vector<std::uint32_t>& inputs)
{
    ir::Function result = ir::without_body(term);
    result.module.clear();
    result.declared_range.reset();
    result.quantity = ir::Quantity::number;
    for (const std::uint32_t input : inputs) result.inputs.push_back(term.inputs[input]);

    const auto uses = ir::use_counts(term.graph, root);
    Facts<ir::Expr, ExprId> moved(term.graph.size());
    for (const ExprId id : term.graph.ids()) {
        if (uses[id] == 0) continue;
        const ir::Expr& expr = term.graph[id];
        if (expr.op == Op::input) {
            const auto place = std::ranges::find(inputs, expr.aux) - inputs.begin();
            moved[id] = result.graph.input(static_cast<std::uint32_t>(place), expr.type);
            continue;
        }
        std::vector<ExprId> operands;
        for (const ExprId operand : term.graph.operands(id)) operands.push_back(moved[operand]);
        moved[id] = result.graph.copy(term.graph, id, operands);
    }
    result.result = moved[root];
    return result;
}

}  // namespace

std::vector<Part> parts_of(const ir::Module& module, ir::FunctionId term)
{
    const ir::Function& function = module[term];
    const ir::Graph& graph = function.graph;
    const auto uses = ir::use_counts(graph, function.result);

    // What every expression reads, and whether it can be a part.
    std::vector<std::set<std::uint32_t>> reads(graph.size());
    std::vector<bool> fits(graph.size(), false);
    for (const ExprId id : graph.ids()) {
        const ir::Expr& expr = graph[id];
        if (expr.op == Op::input) reads[id.index].insert(expr.aux);
        for (const ExprId operand : graph.operands(id))
            reads[id.index].insert(reads[operand.index].begin(), reads[operand.index].end());
        const auto& mine = reads[id.index];
        fits[id.index] = uses[id] > 0 && expr.type == ir::Type::scalar && expr.op != Op::input &&
                         (expr.op != Op::call || id == function.result) && !mine.empty() &&
                         mine.size() <= 2 && std::ranges::all_of(mine, [&](std::uint32_t input) {
                             return is_side(function.inputs[input]);
                         });
    }

    // The largest: those that the result reaches without passing another one.
    std::vector<bool> reached(graph.size(), false);
    reached[function.result.index] = true;
    for (std::size_t i = graph.size(); i-- > 0;) {
        if (!reached[i] || fits[i]) continue;
        for (const ExprId operand : graph.operands(ExprId{i})) reached[operand.index] = true;
    }

    std::vector<Part> result;
    const auto known = evaluate::ranges(module, function, evaluate::declared_ranges(function));
    for (const ExprId id : graph.ids()) {
        if (!reached[id.index] || !fits[id.index]) continue;
        const std::vector<std::uint32_t> inputs(reads[id.index].begin(), reads[id.index].end());
        Part part{id, inputs, alone(function, id, inputs)};
        part.function.range =
            id == function.result ? function.range : ir::Range{known[id].low, known[id].high};
        part.function.name = fmt::format("{} part {}", function.name, result.size());
        result.push_back(std::move(part));
    }
    return result;
}

}  // namespace lobe::analyze
