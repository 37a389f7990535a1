// Ranges of expressions: a traced tape, run once on the intervals of the inputs.
#include "evaluate/acceptance.h"
#include "evaluate/bounds.h"
#include "evaluate/intervals.h"
#include "evaluate/literals.h"
#include "evaluate/run.h"

namespace lobe::evaluate {
namespace {

std::vector<Interval> run_reals(const Tape& tape, const std::vector<Interval>& inputs)
{
    std::vector<Interval> slots(tape.slots);
    std::copy(inputs.begin(), inputs.end(), slots.begin());
    for (const Constant& constant : tape.constants)
        slots[constant.slot] = to_interval(constant.literal);
    for (const Instruction& step : tape.code)
        slots[step.result] =
            apply(step.op, slots[step.a], slots[step.b], slots[step.c], slots[step.d]);
    return slots;
}

/// What a device may return contains the value over the reals of the same operands, so these
/// ranges hold for both. That the contract lets a device return anything (`undefined`) is left
/// out: the checker has proved that no such operation counts.
std::vector<Interval> run_float32(const Tape& tape, const std::vector<Interval>& inputs)
{
    const Rules& table = rules(Precision::float32);
    std::vector<Acceptance> slots(tape.slots);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        slots[i] = admit(table, {inputs[i].low, inputs[i].high, false});
    for (const Constant& constant : tape.constants) {
        const Interval exact = to_interval(constant.literal);
        const double nearest = static_cast<double>(to_float(constant.literal));
        slots[constant.slot] =
            admit(table, {std::min(exact.low, nearest), std::max(exact.high, nearest), false});
    }
    for (const Instruction& step : tape.code) {
        Acceptance& result = slots[step.result];
        result = apply(table, step.op, slots[step.a], slots[step.b], slots[step.c], slots[step.d]);
        result.undefined = false;
    }
    std::vector<Interval> bounds;
    for (const Acceptance& slot : slots) bounds.push_back({slot.low, slot.high});
    return bounds;
}

}  // namespace

Facts<ir::Expr, Interval> ranges(const ir::Module& module, const ir::Function& function,
                                 std::span<const Interval> inputs, Arithmetic arithmetic)
{
    const Traced traced = compile_traced(module, function);
    std::vector<Interval> scalars;
    for (const TapeInput& input : traced.tape.inputs) scalars.push_back(inputs[input.input]);
    const std::vector<Interval> slots = arithmetic == Arithmetic::float32
                                            ? run_float32(traced.tape, scalars)
                                            : run_reals(traced.tape, scalars);

    Facts<ir::Expr, Interval> result(function.graph.size());
    for (const ir::ExprId id : function.graph.ids()) {
        const std::vector<Slot>& components = traced.slots_of[id.index];
        Interval range = slots[components[0]];
        for (const Slot slot : components) range = hull(range, slots[slot]);
        result[id] = range;
    }
    return result;
}

std::vector<Interval> declared_ranges(const ir::Function& function)
{
    std::vector<Interval> result;
    for (const ir::Input& input : function.inputs)
        result.push_back({input.range.low, input.range.high});
    return result;
}

}  // namespace lobe::evaluate
