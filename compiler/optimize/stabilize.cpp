// Cancelling sums replaced by sums that only add; rules.h says which and why.
//
// Over the real numbers the result is the same function of unit vectors: the stable fields equal
// what they replace by Lagrange's identity and the half-angle formula. An evaluation from
// rounded vectors changes, for the better: that is the point.
//
// Only rules that remove a cancellation live here. Nothing is made faster, and a sum that the
// ranges prove free of cancellation is left as it was written.
#include "optimize/stabilize.h"

#include "optimize/complement.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

namespace lobe::optimize {

using namespace ir;

namespace {

/// Builds replacements in the new graph out of what old factors became.
class Builder {
public:
    Builder(Rebuild& rebuild, const Subject& subject, Span span)
        : rebuild_{rebuild}, subject_{subject}, span_{span}
    {
    }

    /// The old expressions that the replacement is built from.
    std::vector<ExprId> reads;

    /// rest + slope * (1 - variable^degree)
    ExprId replacement(const Match& match, ExprId before)
    {
        ExprId product = complement(match);
        const bool negative = bounds(match.slope, subject_.ranges).high <= 0;
        const Sum slope = negative ? negate(match.slope) : match.slope;
        if (slope.size() != 1 || !slope[0].factors.empty() || slope[0].coefficient != 1)
            product = apply(Op::multiply, sum(slope, before), product);
        if (match.rest.empty())
            return negative ? graph().apply(Op::negate, {product}, span_) : product;
        const ExprId rest = sum(match.rest, before);
        return apply(negative ? Op::subtract : Op::add, rest, product);
    }

private:
    Graph& graph() { return rebuild_.graph; }
    ExprId apply(Op op, ExprId a, ExprId b) { return graph().apply(op, {a, b}, span_); }
    ExprId read(ExprId old_id)
    {
        reads.push_back(old_id);
        return rebuild_.moved(old_id);
    }

    /// 1 - variable^degree from its best source.
    ExprId complement(const Match& match)
    {
        const ExprId x = read(match.variable);
        const ExprId one = graph().literal("1");
        const auto squared = [&](ExprId one_minus_x) {
            return apply(Op::multiply, one_minus_x, apply(Op::add, one, x));
        };
        switch (match.rule->source) {
        case Source::cos_h:
            return rebuild_.input(match.degree == 2 ? GeometryField::sin2_h
                                                    : GeometryField::one_minus_cos_h);
        case Source::cos_d: {
            const ExprId field = rebuild_.input(GeometryField::one_minus_cos_d);
            return match.degree == 2 ? squared(field) : field;
        }
        case Source::v_dot_l: {
            const ExprId cos = rebuild_.input(GeometryField::cos_d);
            const ExprId two = graph().literal("2");
            if (match.mirrored) return apply(Op::multiply, two, apply(Op::multiply, cos, cos));
            const ExprId field = rebuild_.input(GeometryField::one_minus_cos_d);
            return apply(Op::multiply, two, apply(Op::multiply, field, apply(Op::add, one, cos)));
        }
        case Source::argument: {
            const std::uint32_t index = rebuild_.old().graph[match.variable].aux;
            const ExprId argument = rebuild_.complement_input(index);
            return match.degree == 2 ? squared(argument) : argument;
        }
        case Source::complement: {
            const ExprId y = read(*one_minus(rebuild_.old().graph, match.variable));
            if (match.degree == 1) return y;
            const ExprId tail =
                match.degree == 2 ? x : apply(Op::multiply, x, apply(Op::add, one, x));
            return apply(Op::multiply, y, apply(Op::add, one, tail));
        }
        case Source::factored: return squared(apply(Op::subtract, one, x));
        }
        return {};
    }

    /// A sum in the new graph: the expression it already was, if one before `before` is this
    /// sum, else what adds first and then subtracts.
    ExprId sum(const Sum& wanted, ExprId before)
    {
        if (const auto existing = find(wanted, before)) return *existing;
        std::optional<ExprId> result;
        for (const bool positive : {true, false})
            for (const Monomial& monomial : wanted) {
                if ((monomial.coefficient > 0) != positive) continue;
                const ExprId part = product(monomial, before);
                if (!result)
                    result = positive ? part : graph().apply(Op::negate, {part}, span_);
                else
                    result = apply(positive ? Op::add : Op::subtract, *result, part);
            }
        assert(result && "a zero sum is not built");
        return *result;
    }

    /// |coefficient| * factors
    ExprId product(const Monomial& monomial, ExprId before)
    {
        const double coefficient = std::fabs(monomial.coefficient);
        if (monomial.factors.empty()) return graph().literal(coefficient);
        std::optional<ExprId> result = find({{1, monomial.factors}}, before);
        if (!result)
            for (const ExprId factor : monomial.factors) {
                const ExprId moved = read(factor);
                result = result ? apply(Op::multiply, *result, moved) : moved;
            }
        if (coefficient == 1) return *result;
        return apply(Op::multiply, graph().literal(coefficient), *result);
    }

    std::optional<ExprId> find(const Sum& wanted, ExprId before)
    {
        const Graph& old = rebuild_.old().graph;
        for (const ExprId id : old.ids()) {
            if (before <= id) break;
            if (old[id].type == Type::scalar && subject_.sums[id] == wanted) return read(id);
        }
        return std::nullopt;
    }

    Rebuild& rebuild_;
    const Subject& subject_;
    Span span_;
};

/// One minus an operand, for a callee that asks for it.
ExprId complement_operand(Rebuild& rebuild, const std::vector<bool>& complemented, ExprId operand)
{
    const Graph& old = rebuild.old().graph;
    if (old[operand].op == Op::input) {
        const std::uint32_t index = old[operand].aux;
        if (const auto field = stable_field(rebuild.old().inputs[index]))
            return rebuild.input(*field);
        if (complemented[index]) return rebuild.complement_input(index);
    }
    if (const auto inner = one_minus(old, operand)) return rebuild.moved(*inner);
    return rebuild.graph.apply(Op::subtract, {rebuild.graph.literal("1"), rebuild.moved(operand)});
}

/// Logs the rules whose replacement is part of the function: a sum inside a sum that was rewritten
/// is gone.
void report(const Rebuild& rebuild, const Matches& matches,
            const Facts<Expr, std::vector<ExprId>>& reads, std::vector<Application>& log)
{
    const Function& old = rebuild.old();
    std::vector<bool> needed(old.graph.size());
    needed[old.result.index] = true;
    std::vector<Application> found;
    for (std::size_t i = old.graph.size(); i-- > 0;) {
        if (!needed[i]) continue;
        const ExprId id{i};
        if (matches[id]) {
            found.push_back({matches[id]->rule, rebuild.id(), old.graph.span(id)});
            for (const ExprId operand : reads[id]) needed[operand.index] = true;
        } else {
            for (const ExprId operand : old.graph.operands(id)) needed[operand.index] = true;
        }
    }
    log.insert(log.end(), found.rbegin(), found.rend());
}

/// Per function and input: none is to be had.
Complements no_complements(const Module& module)
{
    Complements result;
    for (const Function& function : module.functions) result.emplace_back(function.inputs.size());
    return result;
}

/// Stable fields by function.
using AtHand = std::vector<std::set<GeometryField>>;

/// What all that call a function compute anyway, be it a model, with all of its outputs, or a root
/// by itself. The sine is made of one_minus_cos_h.
AtHand fields_at_hand(const Module& module)
{
    std::vector<std::vector<FunctionId>> callers;
    std::vector<bool> is_output(module.functions.size());
    for (const Model& model : module.models) {
        std::vector<FunctionId>& outputs = callers.emplace_back();
        for (const ModelOutput& output : model.outputs) {
            outputs.push_back(output.function);
            is_output[output.function.index] = true;
        }
    }
    for (const FunctionId root : all_roots(module))
        if (!is_output[root.index]) callers.push_back({root});

    AtHand result(module.functions.size());
    std::vector<bool> is_called(module.functions.size());
    for (const std::vector<FunctionId>& together : callers) {
        std::set<GeometryField> fields;
        for (const FunctionId id : together)
            for (const Input& input : module[id].inputs)
                if (input.origin == Origin::geometry)
                    fields.insert(static_cast<GeometryField>(input.which));
        if (fields.contains(GeometryField::sin2_h)) fields.insert(GeometryField::one_minus_cos_h);
        for (const FunctionId id : module.reachable(together)) {
            std::set<GeometryField>& at_hand = result[id.index];
            if (!is_called[id.index])
                at_hand = fields;
            else
                std::erase_if(at_hand,
                              [&](GeometryField field) { return !fields.contains(field); });
            is_called[id.index] = true;
        }
    }
    return result;
}

Module stabilize_once(const Module& module, std::vector<Application>& log, Inputs inputs)
{
    const Complements complements =
        inputs == Inputs::given ? no_complements(module) : find_complements(module);
    const AtHand at_hand = fields_at_hand(module);
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        const std::vector<bool>& complemented = complements[rebuild.id().index];
        rebuild.complement = [&rebuild, &complemented](ExprId operand) {
            return complement_operand(rebuild, complemented, operand);
        };
        auto found = subject(rebuild.old_module(), rebuild.old(), complemented, inputs);
        found.at_hand = at_hand[rebuild.id().index];
        auto matches = match_rules(found);
        const auto has_rule = [&](ExprId id) { return matches[id].has_value(); };
        if (!any_expression(rebuild.old().graph, has_rule)) return {};
        const auto reads =
            std::make_shared<Facts<Expr, std::vector<ExprId>>>(rebuild.old().graph.size());
        const auto known = std::make_shared<const Subject>(std::move(found));
        const auto rules = std::make_shared<const Matches>(std::move(matches));
        rebuild.finished = [&rebuild, &log, reads, rules] { report(rebuild, *rules, *reads, log); };
        return [&rebuild, reads, known, rules](ExprId id) {
            const auto& match = (*rules)[id];
            if (!match) return rebuild.copy(id);
            Builder builder{rebuild, *known, rebuild.old().graph.span(id)};
            const ExprId result = builder.replacement(*match, id);
            (*reads)[id] = builder.reads;
            return result;
        };
    });
}

}  // namespace

Module stabilize(const Module& module, std::vector<Application>& log, Inputs inputs)
{
    // What one round builds, the next may still improve: a factor 1 - a that was no expression
    // before. Every rule takes a cancellation away and adds none, so this ends.
    constexpr int most_rounds = 8;
    Module current = module;
    for (int round = 0; round < most_rounds; ++round) {
        Module next = stabilize_once(current, log, inputs);
        if (same_graphs(current, next)) return next;
        current = std::move(next);
    }
    return current;
}

Module stabilize(const Module& module)
{
    std::vector<Application> log;
    return stabilize(module, log);
}

}  // namespace lobe::optimize
