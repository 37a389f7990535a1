#include "analyze/residual/contribution.h"

#include "evaluate/bounds.h"
#include "evaluate/intervals.h"
#include "evaluate/literals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

using namespace evaluate;

constexpr Interval nothing{0, 0};
constexpr Interval one{1, 1};
constexpr Interval unit{0, 1};

using Factor = std::optional<Interval>;

bool is_finite(Interval x) { return std::isfinite(x.low) && std::isfinite(x.high); }
bool excludes_zero(Interval x) { return x.low > 0 || x.high < 0; }
bool is_same(const Contribution& x) { return x.change == nothing; }
bool is_positive(const Contribution& x) { return x.without.low >= 0 && x.with.low >= 0; }
bool is_negative(const Contribution& x) { return x.without.high <= 0 && x.with.high <= 0; }

Factor hull_of(Factor a, Factor b)
{
    if (!a || !b) return std::nullopt;
    return hull(*a, *b);
}

/// One operation: `change` and `factor` as its rule knows them, the rest from the values.
class Rule {
public:
    Rule(const RoundingNode& node, const std::array<Contribution, 4>& operands)
        : op_(node.op), x_(operands)
    {
        result_.without = apply(op_, x_[0].without, x_[1].without, x_[2].without, x_[3].without);
        bool same = true;
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
            same = same && is_same(x_[k]);
        if (same) {
            result_ = untouched(result_.without);
            return;
        }
        result_.with = apply(op_, x_[0].with, x_[1].with, x_[2].with, x_[3].with);
        result_.change = subtract(result_.with, result_.without);
        known();
        join();
    }

    const Contribution& result() const { return result_; }

private:
    void change(Interval by) { result_.change = common(result_.change, by); }
    /// Unbounded, it says nothing, and 0 need not stay 0.
    void factor(const Factor& by)
    {
        if (!by || !is_finite(*by)) return;
        result_.factor = result_.factor ? common(*result_.factor, *by) : *by;
    }

    /// Operands that are added; all of one sign, the ratio of their sum lies between theirs.
    void sum(std::size_t count)
    {
        Interval by = x_[0].change;
        Factor between = x_[0].factor;
        bool positive = is_positive(x_[0]);
        bool negative = is_negative(x_[0]);
        for (std::size_t k = 1; k < count; ++k) {
            by = add(by, x_[k].change);
            between = hull_of(between, x_[k].factor);
            positive = positive && is_positive(x_[k]);
            negative = negative && is_negative(x_[k]);
        }
        change(by);
        if (positive || negative) factor(between);
    }

    void difference()
    {
        change(subtract(x_[0].change, x_[1].change));
        if ((is_positive(x_[0]) && is_negative(x_[1])) ||
            (is_negative(x_[0]) && is_positive(x_[1])))
            factor(hull_of(x_[0].factor, x_[1].factor));
    }

    void product()
    {
        const Contribution& a = x_[0];
        const Contribution& b = x_[1];
        change(add(multiply(a.without, b.change), multiply(a.change, b.with)));
        change(add(multiply(a.with, b.change), multiply(a.change, b.without)));
        if (a.factor && b.factor) factor(multiply(*a.factor, *b.factor));
    }

    void quotient()
    {
        const Contribution& a = x_[0];
        const Contribution& b = x_[1];
        if (!excludes_zero(b.with)) return;
        change(divide(subtract(a.change, multiply(result_.without, b.change)), b.with));
        if (a.factor && b.factor && excludes_zero(*b.factor)) factor(divide(*a.factor, *b.factor));
    }

    /// x1^y1 / x0^y0 = (x1 / x0)^y1 x0^(y1 - y0)
    void power()
    {
        const Contribution& x = x_[0];
        const Contribution& y = x_[1];
        if (!is_positive(x)) return;
        const bool stays = is_same(y) || x.without.low > 0 || (y.without.low > 0 && y.with.low > 0);
        if (x.factor && x.factor->low >= 0 && stays)
            factor(
                multiply(evaluate::power(*x.factor, y.with), evaluate::power(x.without, y.change)));
        // By the mean value, x^e ln(x) (y1 - y0) for an e between them; of x in [0, 1] that is at
        // most 1 / (exp(1) e) as x goes.
        const Interval between = hull(y.without, y.with);
        if (!is_same(x) || x.without.high > 1 || !(between.low > 0)) return;
        const double steepest = evaluate::divide(one, multiply({std::numbers::e, std::numbers::e},
                                                               {between.low, between.low}))
                                    .high *
                                (1 + 0x1p-50);
        Interval slope{-steepest, 0};
        if (x.without.low > 0)
            slope = common(slope, multiply(evaluate::power(x.without, between), log(x.without)));
        change(multiply(slope, y.change));
    }

    /// From `a` to `b` by `t`.
    void blend()
    {
        const Contribution& a = x_[0];
        const Contribution& b = x_[1];
        const Contribution& t = x_[2];
        const Interval rest = subtract(one, t.without);
        change(add(add(multiply(rest, a.change), multiply(t.without, b.change)),
                   multiply(t.change, subtract(b.with, a.with))));
        const bool inside = t.without.low >= 0 && t.without.high <= 1;
        const bool one_sign =
            (is_positive(a) && is_positive(b)) || (is_negative(a) && is_negative(b));
        if (is_same(t) && inside && one_sign) factor(hull_of(a.factor, b.factor));
    }

    /// The greater or the lesser of two: never moves by more than they do.
    void choice()
    {
        const Contribution& a = x_[0];
        const Contribution& b = x_[1];
        change(hull(a.change, b.change));
        const bool greater = op_ == TapeOp::maximum;
        const bool both = is_positive(a) && is_positive(b);
        const bool either = is_positive(a) || is_positive(b);
        const bool ratio = a.factor && b.factor && a.factor->low >= 0 && b.factor->low >= 0;
        if (ratio && (both || (greater && either))) factor(hull_of(a.factor, b.factor));
    }

    /// Held between two values that stay; of a positive value the ratio is at most its own.
    void hold(Interval low)
    {
        change(hull(x_[0].change, nothing));
        if (low.low >= 0 && x_[0].factor && x_[0].factor->low >= 0)
            factor(hull(*x_[0].factor, one));
    }

    void known()
    {
        const Contribution& a = x_[0];
        switch (op_) {
        case TapeOp::negate:
            change(evaluate::negate(a.change));
            factor(a.factor);
            return;
        case TapeOp::absolute: {
            const double size = std::max(std::abs(a.change.low), std::abs(a.change.high));
            change({-size, size});
            if (a.factor) factor(evaluate::absolute(*a.factor));
            return;
        }
        case TapeOp::square:
            change(multiply(a.change, add(a.with, a.without)));
            if (a.factor) factor(evaluate::square(*a.factor));
            return;
        case TapeOp::square_root:
            if (a.factor && a.factor->low >= 0) factor(evaluate::square_root(*a.factor));
            return;
        case TapeOp::inverse_square_root:
            if (a.factor && a.factor->low > 0) factor(evaluate::inverse_square_root(*a.factor));
            return;
        case TapeOp::exp2: factor(evaluate::exp2(a.change)); return;
        case TapeOp::exp: factor(evaluate::exp(a.change)); return;
        case TapeOp::log2:
            if (a.factor && a.factor->low > 0) change(evaluate::log2(*a.factor));
            return;
        case TapeOp::log:
            if (a.factor && a.factor->low > 0) change(evaluate::log(*a.factor));
            return;
        case TapeOp::sine:
        case TapeOp::cosine:
        case TapeOp::arc_tangent: {
            const double size = std::max(std::abs(a.change.low), std::abs(a.change.high));
            change({-size, size});
            return;
        }
        case TapeOp::add: sum(2); return;
        case TapeOp::sum3: sum(3); return;
        case TapeOp::sum4: sum(4); return;
        case TapeOp::subtract: difference(); return;
        case TapeOp::multiply: product(); return;
        case TapeOp::divide: quotient(); return;
        case TapeOp::power: power(); return;
        case TapeOp::lerp: blend(); return;
        case TapeOp::minimum:
        case TapeOp::maximum: choice(); return;
        case TapeOp::saturate: hold(unit); return;
        case TapeOp::clamp:
            if (is_same(x_[1]) && is_same(x_[2])) hold(x_[1].without);
            return;
        case TapeOp::select:
            if (!is_same(a)) return;
            if (a.without.low > 0 || a.without.high <= 0) {
                const Contribution& taken = a.without.low > 0 ? x_[1] : x_[2];
                change(taken.change);
                factor(taken.factor);
                return;
            }
            change(hull(x_[1].change, x_[2].change));
            factor(hull_of(x_[1].factor, x_[2].factor));
            return;
        case TapeOp::sign:
        case TapeOp::floor:
        case TapeOp::tangent:
        case TapeOp::arc_sine:
        case TapeOp::arc_cosine:
        case TapeOp::step:
        case TapeOp::normalized:
        case TapeOp::smoothstep:
        case TapeOp::less:
        case TapeOp::less_equal:
        case TapeOp::equal:
        case TapeOp::not_equal:
        case TapeOp::logical_and:
        case TapeOp::logical_or:
        case TapeOp::logical_not: return;
        }
    }

    /// Each from the others.
    void join()
    {
        if (excludes_zero(result_.without)) {
            factor(divide(result_.with, result_.without));
            factor(add(one, divide(result_.change, result_.without)));
        }
        if (result_.factor) change(multiply(result_.without, subtract(*result_.factor, one)));
        result_.with = common(result_.with, add(result_.without, result_.change));
        if (result_.factor)
            result_.with = common(result_.with, multiply(result_.without, *result_.factor));
    }

    TapeOp op_;
    const std::array<Contribution, 4>& x_;
    Contribution result_;
};

/// The part of `x` that satisfies a limit (see rounding_tape.h); `x` where nothing does, which is
/// then not wanted.
Interval part(Interval x, Limit::Kind kind, Interval other)
{
    switch (kind) {
    case Limit::Kind::at_least: return common(x, {other.low, infinity});
    case Limit::Kind::at_most: return common(x, {-infinity, other.high});
    case Limit::Kind::size_least:
        if (x.low > -other.low) return common(x, {other.low, infinity});
        if (x.high < other.low) return common(x, {-infinity, -other.low});
        return x;
    }
    return x;
}

}  // namespace

Contribution untouched(Interval range) { return {range, range, nothing, one}; }

Contribution changed(double without, Interval with)
{
    if (with == Interval{without, without}) return untouched(with);
    Contribution result{{without, without}, with, subtract(with, {without, without}), {}};
    if (without != 0) result.factor = divide(with, {without, without});
    return result;
}

Contribution contribution(const RoundingTape& tape, std::span<const Contribution> box,
                          std::vector<Contribution>& values)
{
    values.resize(tape.nodes.size());
    std::array<Contribution, 4> operands;
    for (std::size_t i = 0; i < tape.nodes.size(); ++i) {
        const RoundingNode& node = tape.nodes[i];
        switch (node.kind) {
        case RoundingNode::Kind::input: values[i] = box[node.input]; break;
        case RoundingNode::Kind::literal: values[i] = untouched(to_interval(node.literal)); break;
        case RoundingNode::Kind::operation:
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
                operands[k] = values[node.operands[k]];
            for (const Limit& limit : node.limits) {
                Contribution& operand = operands[limit.operand];
                const Contribution& other = values[limit.other];
                operand.without = part(operand.without, limit.kind, other.without);
                operand.with = part(operand.with, limit.kind, other.with);
            }
            values[i] = Rule{node, operands}.result();
            break;
        }
    }
    return values.back();
}

}  // namespace lobe::analyze
