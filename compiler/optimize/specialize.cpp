#include "optimize/specialize.h"

#include "optimize/decimal.h"
#include "optimize/inline.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace lobe::optimize {

using namespace ir;

namespace {

ExprId constant(Graph& graph, Type type, const std::vector<double>& value, Span span)
{
    std::vector<ExprId> parts;
    for (const double part : value) parts.push_back(graph.literal(fmt::format("{}", part), span));
    return type == Type::scalar ? parts[0] : graph.construct(type, parts, span);
}

bool is_constant(const Graph& graph, ExprId id)
{
    if (graph[id].op == Op::literal) return true;
    return graph[id].op == Op::construct &&
           std::ranges::all_of(graph.operands(id),
                               [&](ExprId part) { return graph[part].op == Op::literal; });
}

bool same_constant(const Graph& a, ExprId x, const Graph& b, ExprId y)
{
    if (a[x].op != b[y].op || a[x].type != b[y].type || a[x].count != b[y].count) return false;
    if (a[x].op == Op::literal) return a.literal_of(x).text == b.literal_of(y).text;
    return std::ranges::equal(a.operands(x), b.operands(y), [&](ExprId p, ExprId q) {
        return a.literal_of(p).text == b.literal_of(q).text;
    });
}

/// A constant in the graph of some caller.
struct Passed {
    const Graph* graph = nullptr;
    ExprId id;
};

/// What the live calls of a module pass to one argument.
struct Traffic {
    bool seen = false;
    std::optional<Passed> constant;  ///< the one that all pass, when they agree
};

using AllTraffic = std::vector<std::vector<Traffic>>;

AllTraffic observe_calls(const Module& module)
{
    AllTraffic traffic;
    for (const Function& function : module.functions) traffic.emplace_back(function.inputs.size());
    for (const FunctionId id : module.reachable(all_roots(module))) {
        const Graph& graph = module[id].graph;
        const auto uses = use_counts(graph, module[id].result);
        for (const ExprId call : graph.ids()) {
            if (graph[call].op != Op::call || uses[call] == 0) continue;
            const auto operands = graph.operands(call);
            for (std::size_t i = 0; i < operands.size(); ++i) {
                Traffic& known = traffic[graph[call].aux][i];
                if (!is_constant(graph, operands[i]))
                    known.constant.reset();
                else if (!known.seen)
                    known.constant = {&graph, operands[i]};
                else if (known.constant && !same_constant(*known.constant->graph,
                                                          known.constant->id, graph, operands[i]))
                    known.constant.reset();
                known.seen = true;
            }
        }
    }
    return traffic;
}

Module fix_inputs(const Module& module, const KnownValue& known)
{
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        return [&](ExprId id) {
            const Function& old = rebuild.old();
            if (old.graph[id].op != Op::input) return rebuild.copy(id);
            const Input& input = old.inputs[old.graph[id].aux];
            const std::vector<double>* const value = known(old, input);
            if (value == nullptr || static_cast<int>(value->size()) != components(input.type))
                return rebuild.copy(id);
            return constant(rebuild.graph, input.type, *value, old.graph.span(id));
        };
    });
}

/// One step of constants into callees. Arguments that all callers set to one constant become it;
/// calls that pass a constant on which callers do not agree are inlined.
Module push_constants(const Module& module)
{
    const AllTraffic traffic = observe_calls(module);
    const std::vector<bool> is_root = root_flags(module);
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        return [&](ExprId id) {
            const Graph& old = rebuild.old().graph;
            const Expr& expr = old[id];
            if (expr.op == Op::input && !rebuild.is_root()) {
                const auto& agreed = traffic[rebuild.id().index][expr.aux].constant;
                if (!agreed) return rebuild.copy(id);
                std::vector<ExprId> parts;
                for (const ExprId part : agreed->graph->operands(agreed->id))
                    parts.push_back(rebuild.graph.copy(*agreed->graph, part, {}));
                return rebuild.graph.copy(*agreed->graph, agreed->id, parts);
            }
            if (expr.op != Op::call) return rebuild.copy(id);

            const ExprId call = rebuild.copy(id);
            const auto operands = old.operands(id);
            bool differs = false;
            for (std::size_t i = 0; i < operands.size(); ++i)
                differs |= is_constant(old, operands[i]) &&
                           (is_root[expr.aux] || !traffic[expr.aux][i].constant);
            if (!differs) return call;
            const auto passed = rebuild.graph.operands(call);
            const std::vector<ExprId> arguments{passed.begin(), passed.end()};
            return inline_body(rebuild.graph, rebuild.rebuilt(FunctionId{expr.aux}), arguments);
        };
    });
}

/// A constant goes one call deeper per step, and steps past the deepest change nothing.
template <class Folded>
Module pushed_down(Module current, const Folded& folded)
{
    for (std::size_t depth = 0; depth < current.functions.size(); ++depth) {
        Module next = folded(push_constants(current));
        if (same_graphs(current, next)) return next;
        current = std::move(next);
    }
    return current;
}

Module folded_on_paper(const Module& module) { return simplify(fold_decimals(module)); }

}  // namespace

Module specialize_where(const Module& module, const KnownValue& known)
{
    return pushed_down(folded_on_paper(fix_inputs(module, known)), folded_on_paper);
}

Module specialize(const Module& module, const Settings& settings)
{
    if (settings.empty())
        return pushed_down(simplify(module), [](const Module& each) { return simplify(each); });
    return specialize_where(module, [&](const Function&, const Input& input) {
        const bool is_known = input.origin == Origin::parameter || input.origin == Origin::surface;
        const auto found = is_known ? settings.find(input.name) : settings.end();
        return found == settings.end() ? nullptr : &found->second;
    });
}

Settings defaults(const Module& module)
{
    Settings settings;
    for (const Parameter& parameter : module.parameters)
        settings[parameter.name] = parameter.default_value;
    return settings;
}

}  // namespace lobe::optimize
