#include "evaluate/fuse.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace lobe::evaluate {
namespace {

using Kind = Step::Kind;

class Fuser {
public:
    explicit Fuser(const Line& line)
        : line_{line}, uses_(line.steps.size()), moved_(line.steps.size()),
          absorbed_(line.steps.size())
    {
    }

    FusedLine run();

private:
    /// What a value absorbs.
    struct Absorbed {
        std::vector<Value> inner;  ///< innermost first
        bool is_tree = false;
    };

    void count_uses();
    bool is_arithmetic(Value value) const;
    bool is_constant(Value value) const { return line_.steps[value].kind == Kind::constant; }
    /// The operands of `value` that it may absorb.
    std::vector<Value> candidates(Value value) const;
    std::vector<Value> taken(Value value) const;
    void plan();
    void write(Value value);
    void write_chain(Value value);
    void write_taken(Value value);
    void write_power(Value value);
    Value emit(FusedOp op, std::initializer_list<Value> operands);

    Pair pair(Value value, std::vector<Value>& operands) const;
    Link link(Value value, Value inner, std::vector<Value>& operands) const;

    const Line& line_;
    std::vector<int> uses_;
    std::vector<Value> moved_;
    std::vector<bool> absorbed_;
    std::vector<Absorbed> plans_;
    std::unordered_map<Value, Value> logarithms_;  ///< by base, in the new line
    FusedLine out_;
};

void Fuser::count_uses()
{
    for (const Value output : line_.outputs) uses_[output] += 2;  // never absorbed
    for (std::size_t i = line_.steps.size(); i-- > 0;)
        if (uses_[i] > 0)
            for (const Value operand : line_.steps[i].arguments()) ++uses_[operand];
}

bool Fuser::is_arithmetic(Value value) const
{
    const Step& step = line_.steps[value];
    if (step.kind != Kind::operation) return false;
    return step.op == TapeOp::add || step.op == TapeOp::subtract || step.op == TapeOp::multiply ||
           step.op == TapeOp::square;
}

std::vector<Value> Fuser::candidates(Value value) const
{
    std::vector<Value> found;
    // x * x would need its operand twice.
    if (line_.steps[value].op == TapeOp::square) return found;
    for (const Value operand : line_.steps[value].arguments())
        if (is_arithmetic(operand) && uses_[operand] == 1) found.push_back(operand);
    return found;
}

/// What an operation that is not arithmetic itself takes in.
std::vector<Value> Fuser::taken(Value value) const
{
    const Step& step = line_.steps[value];
    const auto takes = [&](std::size_t i) {
        return is_arithmetic(step.operands[i]) && uses_[step.operands[i]] == 1;
    };
    if (step.op == TapeOp::square_root && takes(0)) {
        const Value last = step.operands[0];
        const std::vector<Value> first = candidates(last);
        if (!first.empty()) return {first[0], last};
    }
    if (step.op == TapeOp::select && is_constant(step.operands[2]) && takes(1))
        return {step.operands[1]};
    if (step.op == TapeOp::lerp && is_constant(step.operands[0])) {
        if (takes(1)) return {step.operands[1]};
        if (takes(2)) return {step.operands[2]};
    }
    return {};
}

/// From the last value down, so that a value is absorbed by the longest chain that needs it.
void Fuser::plan()
{
    plans_.resize(line_.steps.size());
    for (std::size_t i = line_.steps.size(); i-- > 0;) {
        const auto value = static_cast<Value>(i);
        if (uses_[value] == 0 || absorbed_[value] || line_.steps[value].kind != Kind::operation)
            continue;
        Absorbed& plan = plans_[value];
        if (!is_arithmetic(value)) {
            plan.inner = taken(value);
        } else {
            const std::vector<Value> first = candidates(value);
            if (first.size() == 2) {
                plan = {first, true};
            } else if (first.size() == 1) {
                const std::vector<Value> second = candidates(first[0]);
                if (!second.empty()) plan.inner.push_back(second[0]);
                plan.inner.push_back(first[0]);
            }
        }
        for (const Value inner : plan.inner) absorbed_[inner] = true;
    }
}

Value Fuser::emit(FusedOp op, std::initializer_list<Value> operands)
{
    Step step{Kind::operation, {}, static_cast<std::uint8_t>(operands.size()), 0, {}};
    std::copy(operands.begin(), operands.end(), step.operands.begin());
    out_.line.steps.push_back(step);
    out_.ops.push_back(op);
    return static_cast<Value>(out_.line.steps.size() - 1);
}

/// The innermost operation; its operands go to `operands`, a constant last.
Pair Fuser::pair(Value value, std::vector<Value>& operands) const
{
    const Step& step = line_.steps[value];
    Value a = step.operands[0];
    Value b = step.op == TapeOp::square ? a : step.operands[1];
    const bool swapped = is_constant(a) && !is_constant(b);
    if (swapped) std::swap(a, b);
    const bool constant = is_constant(b);
    operands.push_back(moved_[a]);
    operands.push_back(moved_[b]);
    switch (step.op) {
    case TapeOp::add: return constant ? Pair::add_constant : Pair::add;
    case TapeOp::subtract:
        if (swapped) return Pair::constant_subtract;
        return constant ? Pair::subtract_constant : Pair::subtract;
    default: return constant ? Pair::multiply_constant : Pair::multiply;
    }
}

/// An operation on `inner`; its other operand goes to `operands`.
Link Fuser::link(Value value, Value inner, std::vector<Value>& operands) const
{
    const Step& step = line_.steps[value];
    const bool first = step.operands[0] == inner;
    const Value other = step.operands[first ? 1 : 0];
    const bool constant = is_constant(other);
    operands.push_back(moved_[other]);
    switch (step.op) {
    case TapeOp::add: return constant ? Link::add_constant : Link::add;
    case TapeOp::subtract:
        if (first) return constant ? Link::subtract_constant : Link::subtract;
        return constant ? Link::subtract_from_constant : Link::subtract_from;
    default: return constant ? Link::multiply_constant : Link::multiply;
    }
}

void Fuser::write_chain(Value value)
{
    const Absorbed& chain = plans_[value];
    std::vector<Value> operands;
    const Pair first = pair(chain.inner[0], operands);
    if (chain.is_tree) {
        const Pair second = pair(chain.inner[1], operands);
        const TapeOp op = line_.steps[value].op;
        const Join join = op == TapeOp::add        ? Join::add
                          : op == TapeOp::subtract ? Join::subtract
                                                   : Join::multiply;
        moved_[value] =
            emit(tree(first, second, join), {operands[0], operands[1], operands[2], operands[3]});
    } else if (chain.inner.size() == 1) {
        const Link last = link(value, chain.inner[0], operands);
        moved_[value] = emit(evaluate::chain(first, last), {operands[0], operands[1], operands[2]});
    } else {
        const Link middle = link(chain.inner[1], chain.inner[0], operands);
        const Link last = link(value, chain.inner[1], operands);
        moved_[value] = emit(evaluate::chain(first, middle, last),
                             {operands[0], operands[1], operands[2], operands[3]});
    }
}

/// A root, select or lerp with what it takes in.
void Fuser::write_taken(Value value)
{
    const Step& step = line_.steps[value];
    const std::vector<Value>& inner = plans_[value].inner;
    std::vector<Value> operands;
    const Pair first = pair(inner[0], operands);
    if (step.op == TapeOp::square_root) {
        const Link last = link(inner[1], inner[0], operands);
        moved_[value] = emit(root(first, last), {operands[0], operands[1], operands[2]});
        return;
    }
    // The constant comes third, and what is neither constant nor taken in comes last.
    const auto write_as = [&](std::size_t family, std::size_t constant, std::size_t other) {
        moved_[value] = emit(paired_op(family, first),
                             {operands[0], operands[1], moved_[step.operands[constant]],
                              moved_[step.operands[other]]});
    };
    if (step.op == TapeOp::select) return write_as(first_select, 2, 0);
    if (step.operands[1] == inner[0]) return write_as(first_lerp_to, 0, 2);
    write_as(first_lerp_by, 0, 1);
}

void Fuser::write_power(Value value)
{
    const Step& step = line_.steps[value];
    const Value base = step.operands[0];
    const auto [found, added] = logarithms_.try_emplace(base, Value{});
    if (added) found->second = emit(plain(TapeOp::log2), {moved_[base]});
    moved_[value] =
        emit(static_cast<FusedOp>(power_of_log2), {found->second, moved_[step.operands[1]]});
}

void Fuser::write(Value value)
{
    const Step& step = line_.steps[value];
    if (!plans_[value].inner.empty())
        return is_arithmetic(value) ? write_chain(value) : write_taken(value);
    if (step.op == TapeOp::power) return write_power(value);

    FusedOp op = plain(step.op);
    if (step.op == TapeOp::lerp && is_constant(step.operands[0])) op = lerp_from_constant;
    if (step.op == TapeOp::select && is_constant(step.operands[2])) op = select_or_constant;
    const auto at = [&](std::size_t i) { return moved_[step.operands[i]]; };
    switch (step.count) {
    case 1: moved_[value] = emit(op, {at(0)}); break;
    case 2: moved_[value] = emit(op, {at(0), at(1)}); break;
    case 3: moved_[value] = emit(op, {at(0), at(1), at(2)}); break;
    default: moved_[value] = emit(op, {at(0), at(1), at(2), at(3)}); break;
    }
}

FusedLine Fuser::run()
{
    count_uses();
    plan();
    out_.line.inputs = line_.inputs;
    out_.line.constants = line_.constants;
    for (std::size_t i = 0; i < line_.steps.size(); ++i) {
        const auto value = static_cast<Value>(i);
        const Step& step = line_.steps[value];
        if (step.kind != Kind::operation) {
            moved_[value] = static_cast<Value>(out_.line.steps.size());
            out_.line.steps.push_back(step);
            out_.ops.push_back(0);
        } else if (uses_[value] > 0 && !absorbed_[value]) {
            write(value);
        }
    }
    for (const Value output : line_.outputs) out_.line.outputs.push_back(moved_[output]);
    return std::move(out_);
}

}  // namespace

FusedLine fuse(const Line& line) { return Fuser{line}.run(); }

}  // namespace lobe::evaluate
