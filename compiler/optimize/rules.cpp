#include "optimize/rules.h"

#include "evaluate/run.h"
#include "optimize/complement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

constexpr std::array rule_table{
    Rule{"one_minus_cos_h", Source::cos_h, 1, false, "k - k cos_h", "k one_minus_cos_h",
         "cos_h rounds to 1 for every h within 2^-12 rad of n, and lobes peak there"},
    Rule{
        "sine_squared_h", Source::cos_h, 2, false, "k - k cos_h^2", "k sin2_h",
        "the exponent of Beckmann's lobe ([Walter07] eq. 25): cos_h^2 knows its distance from 1 to "
        "2^-25, and alpha^2 divides it"},
    Rule{"blend_h", Source::cos_h, 0, true, "cos_h^2 (a - 1) + 1", "a + (1 - a) sin2_h",
         "the denominator of GGX ([Walter07] eq. 33) at its peak, where 2^-25 stands beside "
         "alpha^2; "
         "and the replacement is at least a by inspection"},
    Rule{"one_minus_cos_d", Source::cos_d, 1, false, "k - k cos_d", "k one_minus_cos_d",
         "Schlick's base, whose fifth power multiplies its relative error by five"},
    Rule{"sine_squared_d", Source::cos_d, 2, false, "k - k cos_d^2",
         "k one_minus_cos_d (1 + cos_d)", "as one_minus_cos_d"},
    Rule{"blend_d", Source::cos_d, 0, true, "cos_d (a - 1) + 1", "a + (1 - a) one_minus_cos_d",
         "as blend_h, where light and view coincide"},
    Rule{"one_minus_v_dot_l", Source::v_dot_l, 1, false, "k - k v_dot_l",
         "2 k one_minus_cos_d (1 + cos_d)",
         "v.l rounds to 1 for all directions within 2^-12 rad of each other"},
    Rule{"one_plus_v_dot_l", Source::v_dot_l, 1, false, "k + k v_dot_l", "2 k cos_d^2",
         "h = (l + v) / sqrt(2 + 2 v.l), as ports have it: nothing is left of 1 + v.l where light "
         "and view are opposite"},
    Rule{"one_minus_argument", Source::argument, 1, false, "k - k x", "k one_minus_x",
         "the caller has the vectors and the callee does not"},
    Rule{"sine_squared_argument", Source::argument, 2, false, "k - k x^2", "k one_minus_x (1 + x)",
         "as one_minus_argument"},
    Rule{"blend_argument", Source::argument, 0, true, "x^2 (a - 1) + 1",
         "a + (1 - a) one_minus_x (1 + x)", "as one_minus_argument"},
    Rule{"power_of_complement", Source::complement, 0, false, "k - k (1 - y)^3",
         "k y (1 + x + x^2), x = 1 - y",
         "the smooth terminator's mask where both directions graze: y is tiny, and 1 - y has "
         "rounded it away"},
    Rule{"difference_of_squares", Source::factored, 2, false, "k - k x^2", "k (1 - x)(1 + x)",
         "x^2 rounds before the subtraction; 1 - x is exact from 1/2 to 2 (Sterbenz)"},
    Rule{"blend_of_squares", Source::factored, 2, true, "x^2 (a - 1) + 1",
         "a + (1 - a)(1 - x)(1 + x)",
         "GGX from a cosine alone: all that the cosine still knows of its distance from 1"},
};

/// Where x stays away from 1 and -1 the subtraction loses less than one bit, and costs nothing.
bool reaches_one(const Interval& range, int degree)
{
    const double largest = std::max(std::fabs(range.low), std::fabs(range.high));
    const bool spans_zero = range.low <= 0 && range.high >= 0;
    const double smallest = spans_zero ? 0 : std::min(std::fabs(range.low), std::fabs(range.high));
    return std::pow(largest, degree) > 0.5 && std::pow(smallest, degree) < 2;
}

bool opposite(const Interval& a, const Interval& b)
{
    const bool both_positive = a.low >= 0 && b.low >= 0;
    const bool both_negative = a.high <= 0 && b.high <= 0;
    return !both_positive && !both_negative;
}

class Matcher {
public:
    explicit Matcher(const Subject& given)
        : subject_{given}, graph_{given.function->graph}, users_(graph_.size()),
          matches_(graph_.size()), awaited_(graph_.size())
    {
        for (const ExprId id : graph_.ids())
            for (const ExprId operand : graph_.operands(id)) users_[operand].push_back(id);
    }

    Matches run()
    {
        // From the result down: whether a factored square is worth it depends on where it goes.
        for (std::size_t i = graph_.size(); i-- > 0;) {
            const ExprId id{i};
            // How much the x of a replacement matters shows once the replacement is there.
            if (awaited_[i] || !is_candidate(id)) continue;
            matches_[id] = best(id);
            if (matches_[id]) awaited_[matches_[id]->variable.index] = true;
        }
        return std::move(matches_);
    }

private:
    bool is_candidate(ExprId id) const
    {
        if (graph_[id].type != Type::scalar || subject_.sums[id].size() < 2) return false;
        switch (graph_[id].op) {
        case Op::add:
        case Op::subtract:
        case Op::lerp: return true;
        case Op::multiply:  // (1 - x)(1 + x)
            return std::ranges::all_of(graph_.operands(id), [&](ExprId operand) {
                return subject_.sums[operand].size() == 2;
            });
        default: return false;
        }
    }

    std::optional<Match> best(ExprId id) const
    {
        std::vector<ExprId> variables;
        for (const Monomial& monomial : subject_.sums[id])
            for (const ExprId factor : monomial.factors)
                if (std::ranges::find(variables, factor) == variables.end())
                    variables.push_back(factor);
        // The best source first; among equals the first written.
        std::ranges::stable_sort(variables, {}, [&](ExprId variable) { return source(variable); });
        for (const ExprId variable : variables)
            for (const int degree : {3, 2, 1})
                if (auto match = fit(id, variable, degree)) return match;
        return std::nullopt;
    }

    Source source(ExprId variable) const
    {
        const Expr& expr = graph_[variable];
        if (one_minus(graph_, variable)) return Source::complement;
        if (expr.op != Op::input) return Source::factored;
        const Input& input = subject_.function->inputs[expr.aux];
        if (subject_.inputs == Inputs::given) return Source::factored;
        if (input.origin == Origin::geometry) {
            const auto field = static_cast<GeometryField>(input.which);
            if (field == GeometryField::cos_h) return Source::cos_h;
            if (field == GeometryField::cos_d) return Source::cos_d;
            if (field == GeometryField::v_dot_l) return Source::v_dot_l;
        }
        return subject_.complemented[expr.aux] ? Source::argument : Source::factored;
    }

    /// k + k v_dot_l, which is 0 where light and view are opposite.
    std::optional<Match> fit_mirrored(ExprId id, ExprId variable) const
    {
        const auto parts = split(subject_.sums[id], variable, 1);
        if (!parts || parts->constant != parts->slope) return std::nullopt;
        const auto rule = std::ranges::find(rule_table, "one_plus_v_dot_l", &Rule::name);
        return Match{&*rule, variable, 1, {}, parts->slope, true};
    }

    std::optional<Match> fit(ExprId id, ExprId variable, int degree) const
    {
        const Source from = source(variable);
        if (from == Source::v_dot_l && degree != 1) return std::nullopt;
        if (from == Source::v_dot_l)
            if (auto mirrored = fit_mirrored(id, variable)) return mirrored;
        if (from == Source::factored && degree == 1) return std::nullopt;  // 1 - x is itself
        if (from != Source::complement && degree == 3) return std::nullopt;
        if (!reaches_one(subject_.ranges[variable], degree)) return std::nullopt;

        const auto parts = split(subject_.sums[id], variable, degree);
        if (!parts || parts->constant.empty()) return std::nullopt;
        const auto range = [&](const Sum& sum) { return bounds(sum, subject_.ranges); };
        if (!opposite(range(parts->constant), range(parts->slope))) return std::nullopt;

        Match match{nullptr, variable, degree, add(parts->constant, parts->slope),
                    negate(parts->slope)};
        // Of a sum with numbers alone nothing is left over; how much they cancel shows below.
        const bool cancels =
            match.rest.size() + 2 <= parts->constant.size() + parts->slope.size() ||
            (is_number(parts->constant) && is_number(parts->slope));
        if (!cancels || opposite(range(match.rest), range(match.slope))) return std::nullopt;
        const bool is_field = match.rest.empty() && degree == 1 && is_at_hand(variable);
        if (!is_field && is_absorbed(id, parts->slope, degree)) return std::nullopt;
        // Beyond 1 the factor 1 - x^d changes sign, and a rest would meet it from the other side.
        const Interval& x = subject_.ranges[variable];
        if (!match.rest.empty() && (x.high > 1 || x.low < (degree == 2 ? -1 : 0)))
            return std::nullopt;
        if (from == Source::factored && (is_factored(id, variable) || harmless(id, variable)))
            return std::nullopt;

        const bool blend = !match.rest.empty();
        const auto rule = std::ranges::find_if(rule_table, [&](const Rule& candidate) {
            return candidate.source == from && candidate.blend == blend &&
                   (candidate.degree == 0 || candidate.degree == degree);
        });
        if (rule == rule_table.end()) return std::nullopt;
        match.rule = &*rule;
        return match;
    }

    bool is_number(const Sum& sum) const
    {
        return std::ranges::all_of(sum, [&](const Monomial& monomial) {
            return std::ranges::all_of(
                monomial.factors, [&](ExprId factor) { return graph_[factor].op == Op::literal; });
        });
    }

    /// One minus a variable is a field that is computed anyway.
    bool is_at_hand(ExprId variable) const
    {
        if (graph_[variable].op != Op::input) return false;
        const auto field = stable_field(subject_.function->inputs[graph_[variable].aux]);
        return field && subject_.at_hand.contains(*field);
    }

    /// True when the cancellation of a sum is lost in every sum it enters, as that of 1 - x is in
    /// 1 + (1 - x): a float near 1 is half a unit of 2^-24 off, which is less than two units of a
    /// value that is no less than a quarter of what multiplies it.
    bool is_absorbed(ExprId root, const Sum& slope, int degree) const
    {
        constexpr double little = 0.25;
        const Interval range = bounds(slope, subject_.ranges);
        std::vector<double> lost(graph_.size());  // at most so often the rounding of x
        lost[root.index] = degree * std::max(std::fabs(range.low), std::fabs(range.high));
        for (std::size_t i = root.index; i < graph_.size(); ++i) {
            const ExprId id{i};
            const Interval& value = subject_.ranges[id];
            if (lost[i] == 0 || std::max(value.low, -value.high) >= little * lost[i]) continue;
            if (id == subject_.function->result || users_[id].empty()) return false;
            for (const ExprId user : users_[id]) {
                const auto factor = carried_by(user, id);
                if (!factor || matches_[user]) return false;
                lost[user.index] += lost[i] * *factor;
            }
        }
        return true;
    }

    /// By how much an expression multiplies what is lost of an operand, if it is a sum or product.
    std::optional<double> carried_by(ExprId user, ExprId operand) const
    {
        if (graph_[user].type != Type::scalar) return std::nullopt;
        switch (graph_[user].op) {
        case Op::add:
        case Op::subtract:
        case Op::negate: return 1;
        case Op::multiply: {
            const auto operands = graph_.operands(user);
            const Interval& other = subject_.ranges[operands[operands[0] == operand ? 1 : 0]];
            return std::max(std::fabs(other.low), std::fabs(other.high));
        }
        default: return std::nullopt;
        }
    }

    /// True when the square of x is written as (1 - x)(1 + x) already, here or in a part.
    bool is_factored(ExprId root, ExprId variable) const
    {
        const auto linear = [&](ExprId operand) {
            const Sum& sum = subject_.sums[operand];
            return sum.size() == 2 && split(sum, variable, 1).has_value();
        };
        std::vector<bool> seen(root.index + 1);
        seen[root.index] = true;
        for (std::size_t i = root.index + 1; i-- > 0;) {
            if (!seen[i]) continue;
            const ExprId id{i};
            const auto operands = graph_.operands(id);
            switch (graph_[id].op) {
            case Op::multiply:
                if (std::ranges::all_of(operands, linear)) return true;
                [[fallthrough]];
            case Op::add:
            case Op::subtract:
            case Op::negate:
            case Op::lerp:
                for (const ExprId operand : operands) seen[operand.index] = true;
                break;
            default: break;
            }
        }
        return false;
    }

    /// True when the rounding of x^2 in this expression is lost in every sum it enters: in
    /// a + (1 - a) s with a = x^2, what 1 - a lacks near a = 1 is nothing beside a. Also when the
    /// sum it enters is rewritten and does not read it any more.
    bool harmless(ExprId root, ExprId variable) const
    {
        std::vector<bool> carries(graph_.size());  // the rounding gets this far unchanged
        carries[root.index] = true;
        for (std::size_t i = root.index; i < graph_.size(); ++i) {
            const ExprId id{i};
            if (!carries[i]) continue;
            if (id == subject_.function->result || users_[id].empty()) return false;
            for (const ExprId user : users_[id]) {
                if (matches_[user] || absorbs(user, variable)) continue;
                const Op op = graph_[user].op;
                if ((op != Op::multiply && op != Op::negate) || graph_[user].type != Type::scalar)
                    return false;
                carries[user.index] = true;
            }
        }
        return true;
    }

    /// True for a sum in which x^2 and what stands beside it have one sign.
    bool absorbs(ExprId id, ExprId variable) const
    {
        const Op op = graph_[id].op;
        if (op != Op::add && op != Op::subtract && op != Op::lerp) return false;
        if (graph_[id].type != Type::scalar) return false;
        const auto parts = split(subject_.sums[id], variable, 2);
        return parts && !parts->constant.empty() &&
               !opposite(bounds(parts->constant, subject_.ranges),
                         bounds(parts->slope, subject_.ranges));
    }

    const Subject& subject_;
    const Graph& graph_;
    Facts<Expr, std::vector<ExprId>> users_;
    Matches matches_;
    std::vector<bool> awaited_;  ///< the variable of a match
};

}  // namespace

std::span<const Rule> rules() { return rule_table; }

Subject subject(const Module& module, const Function& function, std::vector<bool> complemented,
                Inputs inputs)
{
    Subject result;
    result.inputs = inputs;
    result.function = &function;
    result.sums = expand_sums(function.graph);
    for (const ExprId id : function.graph.ids())
        if (result.sums[id].size() > 1) {
            result.ranges = evaluate::ranges(module, function, evaluate::declared_ranges(function));
            break;
        }
    result.complemented = std::move(complemented);
    return result;
}

Matches match_rules(const Subject& subject) { return Matcher{subject}.run(); }

}  // namespace lobe::optimize
