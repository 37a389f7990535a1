#include "optimize/neutral.h"

#include "optimize/literal.h"
#include "optimize/truth.h"

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

bool finite(const Interval& range) { return std::isfinite(range.low) && std::isfinite(range.high); }
bool excludes_zero(const Interval& range) { return range.low > 0 || range.high < 0; }

class Site {
public:
    Site(Graph& graph, const Draft& draft)
        : graph_{graph}, expr_{draft.expr}, operands_{draft.operands}, ranges_{draft.ranges},
          span_{draft.span}
    {
    }

    /// Something simpler, or nothing.
    std::optional<ExprId> simpler()
    {
        if (const auto folded = fold()) return folded;
        const auto id = identity();
        return id ? std::optional{widen(*id)} : std::nullopt;
    }

private:
    ExprId operand(std::size_t i) const { return operands_[i]; }
    const Interval& range(std::size_t i) const { return ranges_[i]; }
    ExprId literal(double value) { return graph_.literal(value, span_); }
    ExprId make(Op op, std::initializer_list<ExprId> operands)
    {
        return graph_.apply(op, operands, span_);
    }
    bool is(std::size_t i, double value) const
    {
        return exact_literal(graph_, operand(i)) == value;
    }
    bool same(std::size_t i, std::size_t j) const
    {
        return spread_of(graph_, operand(i)) == spread_of(graph_, operand(j));
    }
    bool is_op(ExprId id, Op op) const { return graph_[id].op == op; }
    ExprId inside(ExprId id, std::size_t i = 0) const { return graph_.operands(id)[i]; }

    /// The same value in the type of this expression.
    ExprId widen(ExprId id)
    {
        if (graph_[id].type == expr_.type) return id;
        const ExprId scalar = spread_of(graph_, id);
        return graph_.construct(expr_.type, {&scalar, 1}, span_);
    }

    std::optional<ExprId> fold();
    std::optional<double> fold_component(std::size_t component) const;
    std::optional<ExprId> identity();
    std::optional<ExprId> add();
    std::optional<ExprId> subtract();
    std::optional<ExprId> multiply();
    std::optional<ExprId> divide();
    std::optional<ExprId> power();
    std::optional<ExprId> negate();
    std::optional<ExprId> clamp();
    std::optional<ExprId> lerp();
    std::optional<ExprId> select();
    std::optional<ExprId> logic();
    std::optional<ExprId> compare();
    std::optional<ExprId> construct();
    /// A negative literal or a negation, without its sign.
    std::optional<ExprId> negated(ExprId id);

    Graph& graph_;
    const Expr& expr_;
    const std::vector<ExprId>& operands_;
    const std::vector<Interval>& ranges_;
    Span span_;
};

std::optional<double> Site::fold_component(std::size_t component) const
{
    std::vector<double> values;
    for (const ExprId id : operands_) {
        ExprId scalar = spread_of(graph_, id);
        if (graph_[scalar].op == Op::construct) scalar = graph_.operands(scalar)[component];
        if (graph_[scalar].op != Op::literal) return std::nullopt;
        const auto value = exact_value(graph_.literal_of(scalar));
        if (!value) return std::nullopt;
        values.push_back(*value);
    }
    return fold_exactly(expr_.op, values);
}

std::optional<ExprId> Site::fold()
{
    if (shape(expr_.op) != Shape::each || expr_.op == Op::select) return std::nullopt;
    std::vector<ExprId> parts;
    for (int i = 0; i < components(expr_.type); ++i) {
        const auto value = fold_component(static_cast<std::size_t>(i));
        if (!value) return std::nullopt;
        parts.push_back(literal(*value));
    }
    if (expr_.type == Type::scalar) return parts[0];
    return graph_.construct(expr_.type, parts, span_);
}

std::optional<ExprId> Site::negated(ExprId id)
{
    if (is_op(id, Op::negate)) return inside(id);
    const auto value = exact_literal(graph_, id);
    if (value && *value < 0 && is_op(id, Op::literal)) return literal(-*value);
    return std::nullopt;
}

std::optional<ExprId> Site::add()
{
    if (is(1, 0)) return operand(0);
    if (is(0, 0)) return operand(1);
    if (const auto positive = negated(operand(1)))
        return make(Op::subtract, {operand(0), *positive});
    if (const auto positive = negated(operand(0)))
        return make(Op::subtract, {operand(1), *positive});
    return std::nullopt;
}

std::optional<ExprId> Site::subtract()
{
    if (is(1, 0)) return operand(0);
    if (is(0, 0)) return make(Op::negate, {operand(1)});
    if (same(0, 1) && finite(range(0))) return literal(0);
    if (const auto positive = negated(operand(1))) return make(Op::add, {operand(0), *positive});
    return std::nullopt;
}

std::optional<ExprId> Site::multiply()
{
    for (const std::size_t i : {0U, 1U}) {
        const std::size_t other = 1 - i;
        if (is(i, 1)) return operand(other);
        if (is(i, -1)) return make(Op::negate, {operand(other)});
        if (is(i, 0) && finite(range(other))) return literal(0);
    }
    const bool both = is_op(operand(0), Op::negate) && is_op(operand(1), Op::negate);
    if (both) return make(Op::multiply, {inside(operand(0)), inside(operand(1))});
    return std::nullopt;
}

std::optional<ExprId> Site::divide()
{
    if (is(1, 1)) return operand(0);
    if (is(1, -1)) return make(Op::negate, {operand(0)});
    if (is(0, 0) && excludes_zero(range(1))) return literal(0);
    if (same(0, 1) && excludes_zero(range(0)) && finite(range(0))) return literal(1);
    // Where the divisor can be 0, a select tests just this divisor; it must not change its sign.
    const bool both = is_op(operand(0), Op::negate) && is_op(operand(1), Op::negate);
    if (both && excludes_zero(range(1)))
        return make(Op::divide, {inside(operand(0)), inside(operand(1))});
    return std::nullopt;
}

std::optional<ExprId> Site::power()
{
    if (is(1, 0)) return literal(1);
    if (is(1, 1)) return operand(0);
    if (is(0, 1)) return literal(1);
    // A guarded base of 0 is the least normal float; its tenth power is 0 in double.
    if (is(0, 0) && range(1).low > (expr_.op == Op::power ? 0 : 10)) return literal(0);
    return std::nullopt;
}

std::optional<ExprId> Site::negate()
{
    const ExprId x = operand(0);
    if (is_op(x, Op::negate)) return inside(x);
    if (is_op(x, Op::subtract)) return make(Op::subtract, {inside(x, 1), inside(x, 0)});
    // Rounding is symmetric, so the sign may move into the text of any literal.
    if (is_op(x, Op::literal) && graph_.literal_of(x).text != "pi") {
        const std::string text = graph_.literal_of(x).text;
        return graph_.literal(text[0] == '-' ? text.substr(1) : "-" + text, span_);
    }
    return std::nullopt;
}

/// minimum, maximum, clamp, saturate, absolute, sign and step, where ranges decide.
std::optional<ExprId> Site::clamp()
{
    const Interval& x = range(0);
    switch (expr_.op) {
    case Op::saturate:
        if (x.low >= 0 && x.high <= 1) return operand(0);
        if (x.high <= 0) return literal(0);
        if (x.low >= 1) return literal(1);
        break;
    case Op::minimum:
        if (same(0, 1) || x.high <= range(1).low) return operand(0);
        if (range(1).high <= x.low) return operand(1);
        break;
    case Op::maximum:
        if (same(0, 1) || x.low >= range(1).high) return operand(0);
        if (range(1).low >= x.high) return operand(1);
        break;
    case Op::clamp:
        if (x.low >= range(1).high && x.high <= range(2).low) return operand(0);
        if (is(1, 0) && is(2, 1)) return make(Op::saturate, {operand(0)});
        break;
    case Op::absolute:
        if (x.low >= 0) return operand(0);
        if (x.high <= 0) return make(Op::negate, {operand(0)});
        if (is_op(operand(0), Op::negate)) return make(Op::absolute, {inside(operand(0))});
        break;
    case Op::sign:
        if (x.low > 0) return literal(1);
        if (x.high < 0) return literal(-1);
        break;
    case Op::step:
        if (range(1).low >= x.high) return literal(1);
        if (range(1).high < x.low) return literal(0);
        break;
    default: break;
    }
    return std::nullopt;
}

std::optional<ExprId> Site::lerp()
{
    if (is(2, 0) || same(0, 1)) return operand(0);
    if (is(2, 1)) return operand(1);
    if (is(0, 0) && is(1, 1)) return operand(2);
    return std::nullopt;
}

std::optional<ExprId> Site::select()
{
    if (const auto known = truth(graph_, operand(0))) return operand(*known ? 1 : 2);
    if (same(1, 2)) return operand(1);
    if (is_op(operand(0), Op::logical_not))
        return make(Op::select, {inside(operand(0)), operand(2), operand(1)});
    return std::nullopt;
}

std::optional<ExprId> Site::logic()
{
    const auto known = truth(graph_, operand(0));
    if (expr_.op == Op::logical_not) {
        if (known) return boolean(graph_, !*known);
        if (is_op(operand(0), Op::logical_not)) return inside(operand(0));
        return std::nullopt;
    }
    const bool neutral = expr_.op == Op::logical_and;
    if (known) return *known == neutral ? operand(1) : operand(0);
    if (const auto other = truth(graph_, operand(1)))
        return *other == neutral ? operand(0) : operand(1);
    if (operand(0) == operand(1)) return operand(0);
    return std::nullopt;
}

std::optional<ExprId> Site::compare()
{
    if (graph_[operand(0)].type == Type::boolean) return std::nullopt;
    const auto decided = [&]() -> std::optional<bool> {
        const Interval& a = range(0);
        const Interval& b = range(1);
        const bool apart = a.high < b.low || b.high < a.low;
        const bool equal = (operand(0) == operand(1) && finite(a)) ||
                           (is_op(operand(0), Op::literal) && is_op(operand(1), Op::literal) &&
                            exact_literal(graph_, operand(0)) &&
                            exact_literal(graph_, operand(0)) == exact_literal(graph_, operand(1)));
        if (!apart && !equal) {
            if (expr_.op == Op::less_equal && a.high <= b.low) return true;
            if (expr_.op == Op::less && b.high <= a.low) return false;
            return std::nullopt;
        }
        switch (expr_.op) {
        case Op::less: return !equal && a.high < b.low;
        case Op::less_equal: return equal || a.high < b.low;
        case Op::equal: return equal;
        case Op::not_equal: return !equal;
        default: return std::nullopt;
        }
    }();
    return decided ? std::optional{boolean(graph_, *decided)} : std::nullopt;
}

std::optional<ExprId> Site::construct()
{
    if (operands_.size() == 1) return std::nullopt;
    const bool alike = std::ranges::all_of(operands_, [&](ExprId id) { return id == operand(0); });
    if (alike) return graph_.construct(expr_.type, {operands_.data(), 1}, span_);
    // A vector taken apart and put together again.
    for (std::size_t i = 0; i < operands_.size(); ++i) {
        const Expr& part = graph_[operand(i)];
        if (part.op != Op::component || part.aux != i) return std::nullopt;
        if (inside(operand(i)) != inside(operand(0))) return std::nullopt;
    }
    const ExprId whole = inside(operand(0));
    return graph_[whole].type == expr_.type ? std::optional{whole} : std::nullopt;
}

std::optional<ExprId> Site::identity()
{
    switch (expr_.op) {
    case Op::add: return add();
    case Op::subtract: return subtract();
    case Op::multiply: return multiply();
    case Op::divide: return divide();
    case Op::power:
    case Op::guarded_power: return power();
    case Op::negate: return negate();
    case Op::saturate:
    case Op::minimum:
    case Op::maximum:
    case Op::clamp:
    case Op::absolute:
    case Op::sign:
    case Op::step: return clamp();
    case Op::lerp: return lerp();
    case Op::guarded_smoothstep:
        // Where the edges are known to be reversed it is a step, within the least divisor.
        if (range(1).high <= range(0).low && expr_.type == Type::scalar)
            return make(Op::select,
                        {make(Op::less, {operand(0), operand(2)}), literal(1), literal(0)});
        return std::nullopt;
    case Op::select: return select();
    case Op::logical_and:
    case Op::logical_or:
    case Op::logical_not: return logic();
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::not_equal: return compare();
    case Op::construct: return construct();
    case Op::component:
        if (is_op(operand(0), Op::construct)) {
            const auto parts = graph_.operands(operand(0));
            return parts.size() == 1 ? parts[0] : parts[expr_.aux];
        }
        return std::nullopt;
    case Op::literal:
    case Op::input:
    case Op::floor:
    case Op::square_root:
    case Op::inverse_square_root:
    case Op::exp2:
    case Op::log2:
    case Op::exp:
    case Op::log:
    case Op::sine:
    case Op::cosine:
    case Op::tangent:
    case Op::arc_sine:
    case Op::arc_cosine:
    case Op::arc_tangent:
    case Op::smoothstep:
    case Op::dot:
    case Op::length:
    case Op::cross:
    case Op::normalize:
    case Op::guarded_normalize:
    case Op::call: return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace

std::optional<ExprId> simpler(Graph& graph, const Draft& draft)
{
    return Site{graph, draft}.simpler();
}

}  // namespace lobe::optimize
