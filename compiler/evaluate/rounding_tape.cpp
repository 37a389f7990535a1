#include "evaluate/rounding_tape.h"

#include "evaluate/intervals.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::evaluate {
namespace {

/// A condition and whether it holds.
using Fact = std::pair<std::uint32_t, bool>;
using Facts = std::vector<Fact>;  // sorted

Facts with(Facts facts, Fact fact)
{
    const auto at = std::ranges::lower_bound(facts, fact);
    if (at == facts.end() || *at != fact) facts.insert(at, fact);
    return facts;
}

Facts in_both(const Facts& a, const Facts& b)
{
    Facts result;
    std::ranges::set_intersection(a, b, std::back_inserter(result));
    return result;
}

class Builder {
public:
    Builder(const Tape& tape, std::size_t output, Detail detail) : tape_{tape}, detail_{detail}
    {
        build();
        keep(now_[tape.outputs[output]]);
        limit();
    }
    RoundingTape take() { return std::move(out_); }

private:
    std::uint32_t add(RoundingNode node)
    {
        out_.nodes.push_back(std::move(node));
        return static_cast<std::uint32_t>(out_.nodes.size() - 1);
    }
    std::uint32_t operation(TapeOp op, std::initializer_list<std::uint32_t> operands)
    {
        RoundingNode node;
        node.kind = RoundingNode::Kind::operation;
        node.op = op;
        node.arity = static_cast<int>(operands.size());
        std::ranges::copy(operands, node.operands.begin());
        return add(std::move(node));
    }
    std::uint32_t literal(const ir::Literal& value)
    {
        RoundingNode node;
        node.kind = RoundingNode::Kind::literal;
        node.literal = value;
        return add(std::move(node));
    }
    std::uint32_t zero() { return literal({"0", 0}); }
    std::uint32_t one() { return literal({"1", 1}); }

    std::uint32_t bounded(std::uint32_t x, std::uint32_t low, std::uint32_t high)
    {
        return operation(TapeOp::minimum, {operation(TapeOp::maximum, {x, low}), high});
    }
    /// saturate(1 - q) is 1 - saturate(q), to the bit: rounding is monotone. The latter does not
    /// carry the error of a large q to where it is cut off.
    std::uint32_t saturated(std::uint32_t x)
    {
        const RoundingNode& node = out_.nodes[x];
        const bool is_rest = node.kind == RoundingNode::Kind::operation &&
                             node.op == TapeOp::subtract &&
                             out_.nodes[node.operands[0]].kind == RoundingNode::Kind::literal &&
                             out_.nodes[node.operands[0]].literal.value == 1;
        if (!is_rest) return bounded(x, zero(), one());
        const std::uint32_t q = node.operands[1];
        return operation(TapeOp::subtract, {one(), bounded(q, zero(), one())});
    }
    std::uint32_t smooth(std::uint32_t edge0, std::uint32_t edge1, std::uint32_t x)
    {
        // x - 0 rounds nothing, and keeps it plain that the divisor is what a guard compared.
        const RoundingNode& from = out_.nodes[edge0];
        const bool zero_edge = from.kind == RoundingNode::Kind::literal && from.literal.value == 0;
        const std::uint32_t offset = zero_edge ? x : operation(TapeOp::subtract, {x, edge0});
        const std::uint32_t width = zero_edge ? edge1 : operation(TapeOp::subtract, {edge1, edge0});
        const std::uint32_t ratio = operation(TapeOp::divide, {offset, width});
        return operation(TapeOp::smoothstep, {bounded(ratio, zero(), one())});
    }

    /// One instruction, by single roundings if that is asked for.
    std::uint32_t instruction(const Instruction& step)
    {
        const std::uint32_t a = now_[step.a];
        const std::uint32_t b = now_[step.b];
        const std::uint32_t c = now_[step.c];
        const std::uint32_t d = now_[step.d];
        if (detail_ == Detail::steps) switch (step.op) {
            case TapeOp::saturate: return saturated(a);
            case TapeOp::clamp: return bounded(a, b, c);
            case TapeOp::smoothstep: return smooth(a, b, c);
            default: break;
            }
        switch (arity(step.op)) {
        case 1: return operation(step.op, {a});
        case 2: return operation(step.op, {a, b});
        case 3: return operation(step.op, {a, b, c});
        default: return operation(step.op, {a, b, c, d});
        }
    }

    void build()
    {
        now_.resize(tape_.slots);
        for (std::size_t i = 0; i < tape_.inputs.size(); ++i) {
            RoundingNode node;
            node.input = static_cast<std::uint32_t>(i);
            now_[i] = add(std::move(node));
        }
        for (const Constant& constant : tape_.constants)
            now_[constant.slot] = literal(constant.literal);
        for (const Instruction& step : tape_.code) now_[step.result] = instruction(step);
    }

    /// Only what the output depends on.
    void keep(std::uint32_t output)
    {
        std::vector<bool> needed(out_.nodes.size());
        needed[output] = true;
        for (std::uint32_t i = output + 1; i-- > 0;)
            if (needed[i])
                for (int k = 0; k < out_.nodes[i].arity; ++k)
                    needed[out_.nodes[i].operands[static_cast<std::size_t>(k)]] = true;
        std::vector<std::uint32_t> moved(out_.nodes.size());
        std::vector<RoundingNode> kept;
        for (std::uint32_t i = 0; i <= output; ++i) {
            if (!needed[i]) continue;
            RoundingNode& node = out_.nodes[i];
            for (int k = 0; k < node.arity; ++k) {
                std::uint32_t& operand = node.operands[static_cast<std::size_t>(k)];
                operand = moved[operand];
            }
            if (node.kind == RoundingNode::Kind::input) {
                out_.inputs.push_back(node.input);
                node.input = static_cast<std::uint32_t>(out_.inputs.size() - 1);
            }
            moved[i] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(std::move(node));
        }
        out_.nodes = std::move(kept);
    }

    /// The facts under which each node is wanted: those of all its users.
    std::vector<Facts> facts() const
    {
        const std::size_t count = out_.nodes.size();
        std::vector<Facts> facts(count);
        std::vector<bool> used(count);
        const auto use = [&](std::uint32_t node, const Facts& under) {
            facts[node] = used[node] ? in_both(facts[node], under) : under;
            used[node] = true;
        };
        for (std::size_t i = count; i-- > 0;) {
            const RoundingNode& node = out_.nodes[i];
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k) {
                Facts under = facts[i];
                if (node.op == TapeOp::select && k > 0)
                    under = with(std::move(under), {node.operands[0], k == 1});
                use(node.operands[k], under);
            }
        }
        return facts;
    }

    /// What a condition says of node `x`, as limits of operand `k` of `node`.
    void say(RoundingNode& node, std::uint32_t k, std::uint32_t x, Fact fact) const
    {
        const RoundingNode& condition = out_.nodes[fact.first];
        if (condition.kind != RoundingNode::Kind::operation) return;
        const std::uint32_t p = condition.operands[0];
        const std::uint32_t q = condition.operands[1];
        switch (condition.op) {
        case TapeOp::logical_and:
            if (fact.second) {
                say(node, k, x, {p, true});
                say(node, k, x, {q, true});
            }
            return;
        case TapeOp::logical_or:
            if (!fact.second) {
                say(node, k, x, {p, false});
                say(node, k, x, {q, false});
            }
            return;
        case TapeOp::logical_not: say(node, k, x, {p, !fact.second}); return;
        case TapeOp::less:
        case TapeOp::less_equal:
        case TapeOp::step: {
            // p below q, or q below p where the condition does not hold.
            const std::uint32_t low = fact.second ? p : q;
            const std::uint32_t high = fact.second ? q : p;
            if (x == high) node.limits.push_back({Limit::Kind::at_least, k, low});
            if (x == low) node.limits.push_back({Limit::Kind::at_most, k, high});
            const RoundingNode& size = out_.nodes[high];
            if (size.kind == RoundingNode::Kind::operation && size.op == TapeOp::absolute &&
                size.operands[0] == x)
                node.limits.push_back({Limit::Kind::size_least, k, low});
            return;
        }
        default: return;
        }
    }

    void limit()
    {
        const std::vector<Facts> under = facts();
        for (std::size_t i = 0; i < out_.nodes.size(); ++i) {
            RoundingNode& node = out_.nodes[i];
            for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(node.arity); ++k)
                for (const Fact& fact : under[i]) say(node, k, node.operands[k], fact);
            // What is compared with has to be known by then.
            std::erase_if(node.limits, [i](const Limit& limit) { return limit.other >= i; });
        }
    }

    const Tape& tape_;
    Detail detail_;
    RoundingTape out_;
    std::vector<std::uint32_t> now_;  // node in each slot
};

}  // namespace

RoundingTape rounding_tape(const Tape& tape, std::size_t output, Detail detail)
{
    return Builder{tape, output, detail}.take();
}

Interval value_of(TapeOp op, const std::array<Interval, 4>& operands)
{
    const auto& [a, b, c, d] = operands;
    return op == TapeOp::smoothstep ? smoothstep({0, 0}, {1, 1}, a) : apply(op, a, b, c, d);
}

std::string dump(const RoundingTape& tape)
{
    std::string text;
    for (std::size_t i = 0; i < tape.nodes.size(); ++i) {
        const RoundingNode& node = tape.nodes[i];
        text += fmt::format("%{} = ", i);
        if (node.kind == RoundingNode::Kind::input) text += fmt::format("input {}", node.input);
        if (node.kind == RoundingNode::Kind::literal) text += node.literal.text;
        if (node.kind == RoundingNode::Kind::operation) {
            text += name(node.op);
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
                text += fmt::format(" %{}", node.operands[k]);
            for (const Limit& limit : node.limits)
                text += fmt::format(", operand {} {} %{}", limit.operand,
                                    limit.kind == Limit::Kind::at_least  ? ">="
                                    : limit.kind == Limit::Kind::at_most ? "<="
                                                                         : "at least",
                                    limit.other);
        }
        text += '\n';
    }
    return text;
}

}  // namespace lobe::evaluate
