#include "optimize/complement.h"

#include "optimize/rewrite.h"
#include "optimize/rules.h"

#include <algorithm>

namespace lobe::optimize {

using namespace ir;

namespace {

bool is_unit_argument(const Input& input)
{
    return input.origin == Origin::argument && input.type == Type::scalar && !input.complement &&
           input.range.low >= 0 && input.range.high <= 1;
}

/// The arguments whose complement a function would use, on its own or for those it calls.
std::vector<bool> wanted_by(const Module& module, const Function& function,
                            const Complements& wanted)
{
    std::vector<bool> eligible;
    for (const Input& input : function.inputs) eligible.push_back(is_unit_argument(input));

    std::vector<bool> result(function.inputs.size());
    if (std::ranges::find(eligible, true) == eligible.end()) return result;
    const Graph& graph = function.graph;
    const auto matches = match_rules(subject(module, function, eligible));
    for (const ExprId id : graph.ids()) {
        const Expr& expr = graph[id];
        const auto& match = matches[id];
        if (match && match->rule->source == Source::argument)
            result[graph[match->variable].aux] = true;
        if (expr.op != Op::call) continue;
        const auto operands = graph.operands(id);
        for (std::size_t i = 0; i < operands.size(); ++i) {
            const Expr& operand = graph[operands[i]];
            if (wanted[expr.aux][i] && operand.op == Op::input && eligible[operand.aux])
                result[operand.aux] = true;
        }
    }
    return result;
}

/// True when a caller has one minus this operand without a subtraction.
bool has_complement(const Function& caller, const std::vector<bool>& complemented, ExprId operand)
{
    const Expr& expr = caller.graph[operand];
    if (expr.op != Op::input) return one_minus(caller.graph, operand).has_value();
    return complemented[expr.aux] || stable_field(caller.inputs[expr.aux]).has_value();
}

}  // namespace

std::optional<GeometryField> stable_field(const Input& input)
{
    if (input.origin != Origin::geometry) return std::nullopt;
    const auto field = static_cast<GeometryField>(input.which);
    if (field == GeometryField::cos_h) return GeometryField::one_minus_cos_h;
    if (field == GeometryField::cos_d) return GeometryField::one_minus_cos_d;
    return std::nullopt;
}

std::optional<ExprId> one_minus(const Graph& graph, ExprId id)
{
    const Op op = graph[id].op;
    if (op != Op::subtract && op != Op::add) return std::nullopt;
    const auto operands = graph.operands(id);
    const auto negated = [&](ExprId operand) -> std::optional<ExprId> {
        if (graph[operand].op != Op::negate) return std::nullopt;
        return graph.operands(operand)[0];
    };
    if (op == Op::subtract)
        return graph.is_literal(operands[0], 1) ? std::optional{operands[1]} : std::nullopt;
    if (graph.is_literal(operands[0], 1)) return negated(operands[1]);
    if (graph.is_literal(operands[1], 1)) return negated(operands[0]);
    return std::nullopt;
}

Complements find_complements(const Module& module)
{
    const std::vector<bool> is_root = root_flags(module);

    // Up from the callees: who would use a complement.
    Complements wanted;
    for (const Function& function : module.functions)
        wanted.push_back(is_root[wanted.size()] ? std::vector<bool>(function.inputs.size())
                                                : wanted_by(module, function, wanted));

    // Down from the callers: who can be given one.
    Complements given;
    for (const Function& function : module.functions) given.emplace_back(function.inputs.size());
    std::vector<bool> is_reachable(module.functions.size());
    for (const FunctionId id : module.reachable(all_roots(module))) is_reachable[id.index] = true;
    for (std::size_t i = module.functions.size(); i-- > 0;) {
        if (!is_reachable[i]) continue;
        const Function& caller = module.functions[i];
        const auto uses = use_counts(caller.graph, caller.result);
        for (const ExprId id : caller.graph.ids()) {
            const Expr& expr = caller.graph[id];
            if (expr.op != Op::call || uses[id] == 0) continue;
            const auto operands = caller.graph.operands(id);
            for (std::size_t k = 0; k < operands.size(); ++k)
                if (wanted[expr.aux][k] && has_complement(caller, given[i], operands[k]))
                    given[expr.aux][k] = true;
        }
    }
    return given;
}

}  // namespace lobe::optimize
