// Ranges of expressions: a line with everything kept, run once on the intervals of the inputs.
#include "evaluate/acceptance.h"
#include "evaluate/bounds.h"
#include "evaluate/intervals.h"
#include "evaluate/line.h"
#include "evaluate/literals.h"
#include "evaluate/run.h"

namespace lobe::evaluate {
namespace {

/// Runs a line on numbers of one kind: `input(scalar)`, `constant(literal)`, `operation(op, …)`.
template <class Number, class Input, class Constant, class Operation>
std::vector<Number> run_line(const Line& line, Input input, Constant constant, Operation operation)
{
    std::vector<Number> values;
    values.reserve(line.steps.size());
    for (const Step& step : line.steps) {
        const auto at = [&](std::size_t i) -> const Number& { return values[step.operands[i]]; };
        switch (step.kind) {
        case Step::Kind::input: values.push_back(input(line.inputs[step.index].input)); break;
        case Step::Kind::constant: values.push_back(constant(line.constants[step.index])); break;
        case Step::Kind::operation:
            // Operands past the arity are value 0, which is there: an operation has operands.
            values.push_back(operation(step.op, at(0), at(1), at(2), at(3)));
            break;
        }
    }
    return values;
}

std::vector<Interval> run_reals(const Line& line, std::span<const Interval> inputs)
{
    return run_line<Interval>(
        line, [&](std::uint32_t input) { return inputs[input]; }, to_interval,
        [](TapeOp op, Interval a, Interval b, Interval c, Interval d) {
            return apply(op, a, b, c, d);
        });
}

/// What a device may return contains the value over the reals of the same operands, so these
/// ranges hold for both. That the contract lets a device return anything (`undefined`) is left
/// out: the checker has proved that no such operation counts.
std::vector<Interval> run_float32(const Line& line, std::span<const Interval> inputs)
{
    const Rules& table = rules(Precision::float32);
    const auto accepted = run_line<Acceptance>(
        line,
        [&](std::uint32_t input) {
            return admit(table, {inputs[input].low, inputs[input].high, false});
        },
        [&](const ir::Literal& literal) {
            const Interval exact = to_interval(literal);
            const double nearest = static_cast<double>(to_float(literal));
            return admit(table,
                         {std::min(exact.low, nearest), std::max(exact.high, nearest), false});
        },
        [&](TapeOp op, const Acceptance& a, const Acceptance& b, const Acceptance& c,
            const Acceptance& d) {
            Acceptance result = apply(table, op, a, b, c, d);
            result.undefined = false;
            return result;
        });
    std::vector<Interval> bounds;
    bounds.reserve(accepted.size());
    for (const Acceptance& value : accepted) bounds.push_back({value.low, value.high});
    return bounds;
}

}  // namespace

Facts<ir::Expr, Interval> ranges(const ir::Module& module, const ir::Function& function,
                                 std::span<const Interval> inputs, Arithmetic arithmetic)
{
    const Line line = scalarize(module, function, Trace::all);
    const std::vector<Interval> values =
        arithmetic == Arithmetic::float32 ? run_float32(line, inputs) : run_reals(line, inputs);

    Facts<ir::Expr, Interval> result(function.graph.size());
    for (const ir::ExprId id : function.graph.ids()) {
        const Components& components = line.values_of[id.index];
        Interval range = values[components[0]];
        for (const Value value : components) range = hull(range, values[value]);
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
