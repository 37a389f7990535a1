#include "evaluate/rounding_bounds.h"

#include "evaluate/rounding_rules.h"

namespace lobe::evaluate {
namespace {

/// The part of `x` that satisfies the limit. Where there is none the value is not wanted.
Interval cut(Interval x, Limit::Kind kind, Interval other)
{
    switch (kind) {
    case Limit::Kind::at_least: x.low = std::max(x.low, other.low); break;
    case Limit::Kind::at_most: x.high = std::min(x.high, other.high); break;
    case Limit::Kind::size_least:
        if (x.low > -other.low) x.low = std::max(x.low, other.low);
        if (x.high < other.low) x.high = std::min(x.high, -other.low);
        break;
    }
    if (x.low > x.high) {
        if (kind == Limit::Kind::at_most)
            x.low = x.high;
        else
            x.high = x.low;
    }
    return x;
}

/// True where the exact result may jump from one value to another within the box.
bool is_choice(TapeOp op, Interval first)
{
    switch (op) {
    case TapeOp::select: return first.low != first.high;
    case TapeOp::sign: return !(first.low > 0 || first.high < 0 || first.low == first.high);
    case TapeOp::floor:
    case TapeOp::step:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal: return true;
    default: return false;
    }
}

double middle(Interval x) { return x.low / 2 + x.high / 2; }

/// True for an operand whose error an adjoint may carry in these units.
bool carries(Interval slope, double error) { return error == 0 || is_bounded(slope); }

Interval scaled(Interval adjoint, Interval slope)
{
    return is_bounded(slope) ? multiply(adjoint, slope) : Interval{};
}

/// What is squared, of a root of a sum of squares; else nothing.
std::vector<std::uint32_t> components(const RoundingTape& tape, const RoundingNode& root)
{
    if (root.kind != RoundingNode::Kind::operation || root.op != TapeOp::square_root) return {};
    const RoundingNode& sum = tape.nodes[root.operands[0]];
    if (sum.kind != RoundingNode::Kind::operation ||
        (sum.op != TapeOp::add && sum.op != TapeOp::sum3 && sum.op != TapeOp::sum4))
        return {};
    std::vector<std::uint32_t> result;
    for (std::size_t k = 0; k < static_cast<std::size_t>(sum.arity); ++k) {
        const RoundingNode& square = tape.nodes[sum.operands[k]];
        if (square.kind != RoundingNode::Kind::operation || square.op != TapeOp::square) return {};
        result.push_back(square.operands[0]);
    }
    return result;
}

}  // namespace

RoundingBounds::RoundingBounds(const RoundingTape& tape, const Rounding& rounding, double floor,
                               std::vector<Rounded> given)
    : tape_{tape}, rounding_{rounding}, floor_{floor}, given_{std::move(given)},
      values_(tape.nodes.size()), ranges_(tape.nodes.size()), steps_(tape.nodes.size()),
      operands_(tape.nodes.size()), adjoint_(tape.nodes.size()),
      trend_(std::max(tape.inputs.size(), given_.size()))
{
    for (const RoundingNode& node : tape.nodes) components_.push_back(components(tape, node));
    for (std::size_t i = 0; i < tape.nodes.size(); ++i)
        if (tape.nodes[i].kind == RoundingNode::Kind::literal)
            values_[i] = rounded_literal(rounding, tape.nodes[i].literal);
}

Rounded RoundingBounds::limited(const RoundingNode& node, std::size_t operand) const
{
    Rounded value = values_[node.operands[operand]];
    for (const Limit& limit : node.limits) {
        if (limit.operand != operand) continue;
        value.exact = cut(value.exact, limit.kind, values_[limit.other].exact);
        value.computed = cut(value.computed, limit.kind, values_[limit.other].computed);
    }
    return value;
}

void RoundingBounds::forward(std::span<const Interval> box)
{
    start_centers(box);
    for (std::size_t i = 0; i < tape_.nodes.size(); ++i) {
        const RoundingNode& node = tape_.nodes[i];
        if (node.kind == RoundingNode::Kind::input)
            values_[i] = given_.empty() ? rounded_input(rounding_, box[node.input])
                                        : rounded_part(given_[node.input], box[node.input]);
        if (node.kind != RoundingNode::Kind::operation) continue;
        const auto arity = static_cast<std::size_t>(node.arity);
        for (std::size_t k = 0; k < arity; ++k)
            operands_[i][k] = node.limits.empty() ? values_[node.operands[k]] : limited(node, k);
        steps_[i] = step(rounding_, node.op, {operands_[i].data(), arity});
        values_[i] = steps_[i].value;
        if (!components_[i].empty()) as_length(i);
        if (!middle_.empty()) center(i, box);
    }
}

void RoundingBounds::start_centers(std::span<const Interval> box)
{
    // On narrow boxes of a few sides it pays.
    constexpr std::size_t most_sides = 6;
    if (box.size() > most_sides) return;
    middle_.resize(tape_.nodes.size());
    gradient_.assign(tape_.nodes.size() * box.size(), Interval{});
    for (std::size_t i = 0; i < tape_.nodes.size(); ++i) {
        const RoundingNode& node = tape_.nodes[i];
        if (node.kind == RoundingNode::Kind::literal) middle_[i] = values_[i].exact;
        if (node.kind != RoundingNode::Kind::input) continue;
        const double at = middle(box[node.input]);
        middle_[i] = {at, at};
        gradient_[i * box.size() + node.input] = {1, 1};
    }
}

/// f(x) is f(m) and no more than its slopes over the box times x - m ([Moore79]): on a narrow box
/// that is less than what the operations one by one can be, for they forget that their operands
/// move together.
void RoundingBounds::center(std::size_t i, std::span<const Interval> box)
{
    const RoundingNode& node = tape_.nodes[i];
    const auto arity = static_cast<std::size_t>(node.arity);
    std::array<Interval, 4> in{};
    bool is_smooth = !is_choice(node.op, operands_[i][0].exact);
    for (std::size_t k = 0; k < arity; ++k) {
        in[k] = middle_[node.operands[k]];
        // Where a limit holds is no box.
        is_smooth = is_smooth && operands_[i][k].exact == values_[node.operands[k]].exact;
    }
    middle_[i] = value_of(node.op, in);
    Interval range = middle_[i];
    for (std::size_t side = 0; side < box.size(); ++side) {
        Interval& total = gradient_[i * box.size() + side];
        total = is_smooth ? Interval{} : everything;
        for (std::size_t k = 0; is_smooth && k < arity; ++k) {
            const Interval& inner = gradient_[node.operands[k] * box.size() + side];
            const Interval& slope = steps_[i].slopes[k].aa;
            if (inner == Interval{}) continue;
            const bool is_known = is_bounded(slope) && is_bounded(inner);
            total = is_known ? add(total, multiply(slope, inner)) : everything;
            if (!is_known) break;
        }
        if (!is_bounded(total) || !is_bounded(range)) {
            range = everything;
            continue;
        }
        const double at = middle(box[side]);
        range = add(range, multiply(total, subtract(box[side], {at, at})));
    }
    const Interval tighter = common(values_[i].exact, range);
    if (tighter.low > tighter.high || tighter == values_[i].exact) return;
    const Rounded whole = values_[i];
    values_[i] = rounded_part(whole, tighter);
}

/// A length is off by no more than the length of what its components are off by, however short it
/// is: next to 0 the slope of the root says nothing.
void RoundingBounds::as_length(std::size_t root)
{
    double squares = 0;
    for (const std::uint32_t node : components_[root]) {
        const double off = values_[node].absolute;
        squares = outward(squares + times(off, off));
    }
    const double moved = outward(root_up(squares));
    Rounded& value = values_[root];
    if (!(moved < infinity) || !is_bounded(value.computed)) return;
    // The root of the squares of what was computed, and what was computed of them: a rounding of
    // each square and of every addition, half of it under the root, and the root's own.
    const bool any = rounding_.machine == Machine::vulkan;
    const auto count = static_cast<double>(components_[root].size());
    const double own = (count / 2 + (any ? 4.5 : 1)) * rounding_.unit * (1 + 0x1p-6);
    const double least = rounding_.flushes ? rounding_.least_normal : rounding_.least;
    const double small = root_up(4 * (count + 1) * least);
    value.absolute = std::min(
        value.absolute, outward(moved + times(own, outward(size(value.exact) + moved)) + small));
    const Rounded whole = value;
    value = rounded_part(whole, whole.exact);
}

/// The values over the reals alone.
Interval RoundingBounds::exact_range(std::span<const Interval> box) const
{
    for (std::size_t i = 0; i < tape_.nodes.size(); ++i) {
        const RoundingNode& node = tape_.nodes[i];
        if (node.kind == RoundingNode::Kind::input) ranges_[i] = box[node.input];
        if (node.kind == RoundingNode::Kind::literal) ranges_[i] = values_[i].exact;
        if (node.kind != RoundingNode::Kind::operation) continue;
        std::array<Interval, 4> in{};
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
            in[k] = ranges_[node.operands[k]];
        for (const Limit& limit : node.limits)
            in[limit.operand] = cut(in[limit.operand], limit.kind, ranges_[limit.other]);
        ranges_[i] = value_of(node.op, in);
    }
    return ranges_.back();
}

/// The same, with every input in which the result rises or falls all over the box at the end where
/// the result is least, then greatest.
Interval RoundingBounds::monotone_range(std::span<const Interval> box) const
{
    Interval result = values_.back().exact;
    if (std::ranges::all_of(trend_, [](int trend) { return trend == 0; })) return result;
    std::vector<Interval> least(box.begin(), box.end());
    std::vector<Interval> greatest = least;
    for (std::size_t i = 0; i < box.size(); ++i) {
        if (trend_[i] == 0) continue;
        const bool rises = trend_[i] > 0;
        least[i].low = least[i].high = rises ? box[i].low : box[i].high;
        greatest[i].low = greatest[i].high = rises ? box[i].high : box[i].low;
    }
    result.low = std::max(result.low, exact_range(least).low);
    result.high = std::min(result.high, exact_range(greatest).high);
    return result.low <= result.high ? result : values_.back().exact;
}

/// Slopes enclose derivatives, so the sign of a product of them is one of a derivative: of
/// logarithms where a node's value keeps its sign, for there they cancel best. What lies behind a
/// choice or an unbounded slope is unknown.
void RoundingBounds::find_trends()
{
    std::ranges::fill(trend_, 0);
    std::ranges::fill(adjoint_, Interval{});
    adjoint_.back() = {1, 1};
    const auto sign = [](Interval x) { return x.low >= 0 ? 1 : x.high <= 0 ? -1 : 0; };
    const auto is_relative = [](const Rounded& x) { return least_size(x.exact) > 0; };
    for (std::size_t i = tape_.nodes.size(); i-- > 0;) {
        const Interval adjoint = adjoint_[i];
        if (adjoint == Interval{}) continue;
        const RoundingNode& node = tape_.nodes[i];
        if (node.kind == RoundingNode::Kind::input) {
            trend_[node.input] = sign(adjoint);
            for (const Rounded* logarithmic : {&values_[i], &values_.back()})
                if (is_relative(*logarithmic)) trend_[node.input] *= sign(logarithmic->exact);
        }
        if (node.kind != RoundingNode::Kind::operation) continue;
        const bool unknown = is_choice(node.op, operands_[i][0].exact);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
            const Slope& all = steps_[i].slopes[k];
            // In the operand's own units, that all its users share, whatever limits this one knows.
            const bool of_relative = is_relative(values_[node.operands[k]]);
            const Interval slope = is_relative(values_[i]) ? (of_relative ? all.rr : all.ra)
                                                           : (of_relative ? all.ar : all.aa);
            Interval& operand = adjoint_[node.operands[k]];
            operand = unknown || !is_bounded(slope) || !is_bounded(adjoint)
                          ? everything
                          : add(operand, multiply(adjoint, slope));
        }
    }
}

double RoundingBounds::backward_absolute()
{
    std::ranges::fill(adjoint_, Interval{});
    adjoint_.back() = {1, 1};
    double total = 0;
    for (std::size_t i = tape_.nodes.size(); i-- > 0;) {
        const Interval adjoint = adjoint_[i];
        if (adjoint == Interval{}) continue;
        const RoundingNode& node = tape_.nodes[i];
        if (node.kind != RoundingNode::Kind::operation) {
            total += times(size(adjoint), values_[i].absolute);
            continue;
        }
        const Step& step = steps_[i];
        bool through = is_bounded(adjoint);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
            through = through && carries(step.slopes[k].aa, operands_[i][k].absolute);
        }
        if (!through) {
            total += times(size(adjoint), step.value.absolute);
            continue;
        }
        total += times(size(adjoint), step.own_absolute);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
            Interval& operand = adjoint_[node.operands[k]];
            operand = add(operand, scaled(adjoint, step.slopes[k].aa));
        }
    }
    return outward(total);
}

double RoundingBounds::backward_relative()
{
    const Rounded& result = values_.back();
    if (!(result.relative < infinity)) return infinity;
    std::ranges::fill(adjoint_, Interval{});
    adjoint_.back() = {1, 1};
    double total = 0;
    for (std::size_t i = tape_.nodes.size(); i-- > 0;) {
        const Interval adjoint = adjoint_[i];
        if (adjoint == Interval{}) continue;
        const RoundingNode& node = tape_.nodes[i];
        const Rounded& value = values_[i];
        const bool relative = value.relative < infinity;
        const double whole = relative ? value.relative : value.absolute;
        if (node.kind != RoundingNode::Kind::operation) {
            total += times(size(adjoint), whole);
            continue;
        }
        const Step& step = steps_[i];
        // In which units an operand's error goes on, and whether it can.
        const auto slope = [&](std::size_t k) {
            const bool of_relative = operands_[i][k].relative < infinity;
            const Slope& all = step.slopes[k];
            return relative ? (of_relative ? all.rr : all.ra) : (of_relative ? all.ar : all.aa);
        };
        bool through = is_bounded(adjoint);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
            const Rounded& x = operands_[i][k];
            const double error = x.relative < infinity ? x.relative : x.absolute;
            through = through && carries(slope(k), error);
            if (!relative && x.relative < infinity && x.underflow > 0)
                through = through && is_bounded(step.slopes[k].aa);
        }
        if (!through) {
            total += times(size(adjoint), whole);
            continue;
        }
        total += times(size(adjoint), relative ? step.own_relative : step.own_absolute);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
            const Rounded& x = operands_[i][k];
            Interval& operand = adjoint_[node.operands[k]];
            operand = add(operand, scaled(adjoint, slope(k)));
            if (!relative && x.relative < infinity && x.underflow > 0)
                total += times(size(adjoint), times(size(step.slopes[k].aa), x.underflow));
        }
    }
    return outward(total);
}

BoxError RoundingBounds::error(std::span<const Interval> box)
{
    forward(box);
    const Rounded& value = values_.back();
    BoxError result{value.exact, value.computed, value.absolute, infinity, value.jump};
    double relative = value.relative;
    // A device may flush a value for one of its users and not for another: then it has no one
    // error that could cancel.
    if (rounding_.machine == Machine::kernels) {
        result.absolute = std::min(result.absolute, backward_absolute());
        relative = std::min(relative, backward_relative());
        find_trends();
        result.exact = monotone_range(box);
    }
    if (relative < infinity) {
        result.absolute =
            std::min(result.absolute, outward(relative * size(result.exact) + value.underflow));
        result.relative = outward(relative + value.underflow / floor_);
    }
    result.relative = std::min(
        result.relative, outward(result.absolute / std::max(least_size(result.exact), floor_)));
    return result;
}

}  // namespace lobe::evaluate
