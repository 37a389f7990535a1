// Intervals and acceptance intervals over many points: a loop over points, and one over the code.
#include "evaluate/acceptance.h"
#include "evaluate/intervals.h"
#include "evaluate/literals.h"
#include "evaluate/run.h"

#include <cassert>

namespace lobe::evaluate {
namespace {

/// Runs `tape` on `slots`, whose inputs and constants are set.
template <class Number, class Apply>
void run_point(const Tape& tape, std::vector<Number>& slots, Apply apply_op)
{
    for (const Instruction& step : tape.code)
        slots[step.result] =
            apply_op(step.op, slots[step.a], slots[step.b], slots[step.c], slots[step.d]);
}

template <class Number>
void copy_outputs(const Tape& tape, const std::vector<Number>& slots, Results<Number> outputs,
                  std::size_t point)
{
    for (std::size_t i = 0; i < tape.outputs.size(); ++i)
        outputs[i][point] = slots[tape.outputs[i]];
}

Acceptance literal_bounds(const ir::Literal& literal, Precision precision)
{
    // A compiler reads the nearest number of the format.
    const double value =
        precision == Precision::float32 ? static_cast<double>(to_float(literal)) : to_half(literal);
    return {value, value, false};
}

}  // namespace

void run(const Tape& tape, Columns<Interval> inputs, Results<Interval> outputs, std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    std::vector<Interval> slots(tape.slots);
    for (const Constant& constant : tape.constants)
        slots[constant.slot] = to_interval(constant.literal);
    for (std::size_t point = 0; point < count; ++point) {
        for (std::size_t i = 0; i < inputs.size(); ++i) slots[i] = inputs[i][point];
        run_point(tape, slots, [](TapeOp op, Interval a, Interval b, Interval c, Interval d) {
            return apply(op, a, b, c, d);
        });
        copy_outputs(tape, slots, outputs, point);
    }
}

void run_acceptance(const Tape& tape, Precision precision, Columns<Acceptance> inputs,
                    Results<Acceptance> outputs, std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    const Rules& table = rules(precision);
    std::vector<Acceptance> slots(tape.slots);
    for (const Constant& constant : tape.constants)
        slots[constant.slot] = admit(table, literal_bounds(constant.literal, precision));
    for (std::size_t point = 0; point < count; ++point) {
        for (std::size_t i = 0; i < inputs.size(); ++i) slots[i] = admit(table, inputs[i][point]);
        run_point(tape, slots,
                  [&table](TapeOp op, const Acceptance& a, const Acceptance& b, const Acceptance& c,
                           const Acceptance& d) { return apply(table, op, a, b, c, d); });
        copy_outputs(tape, slots, outputs, point);
    }
}

}  // namespace lobe::evaluate
