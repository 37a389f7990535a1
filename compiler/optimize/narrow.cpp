// What a scene says about ranges, handed down from the roots to everything they call.
#include "evaluate/run.h"
#include "optimize/decimal.h"
#include "optimize/rewrite.h"
#include "optimize/specialize.h"

#include <algorithm>
#include <optional>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

Range intersection(const Range& declared, const Range& wanted)
{
    const Range both{std::max(declared.low, wanted.low), std::min(declared.high, wanted.high)};
    return both.low <= both.high ? both : declared;
}

void limit_inputs(Module& module, const KnownRange& known)
{
    for (Function& function : module.functions)
        for (Input& input : function.inputs)
            if (const Range* const range = known(function, input))
                input.range = intersection(input.range, *range);
}

/// The hull of what was passed to each argument, if anything was.
using Passed = std::vector<std::vector<std::optional<Range>>>;

void observe(const Module& module, const Function& caller, Passed& passed)
{
    const Graph& graph = caller.graph;
    const auto uses = use_counts(graph, caller.result);
    const auto ranges = evaluate::ranges(module, caller, evaluate::declared_ranges(caller));
    for (const ExprId id : graph.ids()) {
        if (graph[id].op != Op::call || uses[id] == 0) continue;
        const auto operands = graph.operands(id);
        for (std::size_t i = 0; i < operands.size(); ++i) {
            // What is handed on has the range that it came with; what is computed, one of floats.
            const Expr& operand = graph[operands[i]];
            const Interval& computed = ranges[operands[i]];
            const Range range = operand.op == Op::input ? caller.inputs[operand.aux].range
                                                        : in_digits({computed.low, computed.high});
            auto& hull = passed[graph[id].aux][i];
            hull = hull ? Range{std::min(hull->low, range.low), std::max(hull->high, range.high)}
                        : range;
        }
    }
}

}  // namespace

Module narrow(const Module& module, const Limits& limits)
{
    Module result = narrow_where(module, [&](const Function&, const Input& input) -> const Range* {
        if (input.origin == Origin::argument || input.origin == Origin::geometry) return nullptr;
        const auto found = limits.find(input.name);
        return found == limits.end() ? nullptr : &found->second;
    });
    for (Parameter& parameter : result.parameters)
        if (const auto found = limits.find(parameter.name); found != limits.end())
            parameter.range = intersection(parameter.range, found->second);
    return result;
}

Module narrow_where(const Module& module, const KnownRange& known)
{
    Module result = module;
    limit_inputs(result, known);

    const std::vector<bool> is_root = root_flags(result);
    const std::vector<FunctionId> reachable = result.reachable(all_roots(result));
    Passed passed;
    for (const Function& function : result.functions) passed.emplace_back(function.inputs.size());
    // Callers come after their callees, so from the back every range is final when it is read.
    for (auto id = reachable.rbegin(); id != reachable.rend(); ++id) {
        Function& function = result.functions[id->index];
        for (std::size_t i = 0; i < function.inputs.size() && !is_root[id->index]; ++i) {
            Input& input = function.inputs[i];
            const auto& hull = passed[id->index][i];
            if (input.origin == Origin::argument && hull)
                input.range = intersection(input.range, *hull);
        }
        observe(result, function, passed);
    }
    return result;
}

}  // namespace lobe::optimize
