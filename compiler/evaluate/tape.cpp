#include "evaluate/tape.h"

#include "evaluate/fuse.h"
#include "evaluate/line.h"
#include "evaluate/slots.h"

#include <fmt/format.h>

#include <array>

namespace lobe::evaluate {
namespace {

struct OpEntry {
    std::string_view name;
    int arity;
};

constexpr std::array op_entries{
#define LOBE_TAPE_OP(name, arity) OpEntry{#name, arity},
#include "evaluate/tape_ops.def"
#undef LOBE_TAPE_OP
};

std::array<Slot, 4> operand_slots(const Step& step, const Slots& slots)
{
    std::array<Slot, 4> operands{};
    for (std::size_t i = 0; i < step.arguments().size(); ++i)
        operands[i] = slots.of[step.operands[i]];
    return operands;
}

Tape write_tape(const Line& line, const Slots& slots)
{
    Tape tape;
    tape.inputs = line.inputs;
    tape.output_names = line.output_names;
    for (Value value = 0; value < line.steps.size(); ++value) {
        const Step& step = line.steps[value];
        if (!slots.live[value]) continue;
        if (step.kind == Step::Kind::constant)
            tape.constants.push_back({slots.of[value], line.constants[step.index]});
        if (step.kind != Step::Kind::operation) continue;
        const std::array<Slot, 4> operands = operand_slots(step, slots);
        tape.code.push_back(
            {step.op, slots.of[value], operands[0], operands[1], operands[2], operands[3]});
    }
    for (const Value output : line.outputs) tape.outputs.push_back(slots.of[output]);
    tape.slots = slots.count;
    return tape;
}

FusedCode write_fused(const FusedLine& fused)
{
    const Slots slots = assign_slots(fused.line, Reuse::yes);
    FusedCode result;
    for (Value value = 0; value < fused.line.steps.size(); ++value) {
        const Step& step = fused.line.steps[value];
        if (step.kind != Step::Kind::operation || !slots.live[value]) continue;
        const std::array<Slot, 4> operands = operand_slots(step, slots);
        result.code.push_back({fused.ops[value], slots.of[value], operands[0], operands[1],
                               operands[2], operands[3]});
    }
    for (const Value output : fused.line.outputs) result.outputs.push_back(slots.of[output]);
    result.slots = slots.count;
    return result;
}

}  // namespace

int arity(TapeOp op) { return op_entries[static_cast<std::size_t>(op)].arity; }
std::string_view name(TapeOp op) { return op_entries[static_cast<std::size_t>(op)].name; }

bool makes_condition(TapeOp op)
{
    switch (op) {
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or:
    case TapeOp::logical_not: return true;
    default: return false;
    }
}

Tape compile(const ir::Module& module, const ir::Function& function)
{
    const Line line = scalarize(module, function, Trace::live);
    Tape tape = write_tape(line, assign_slots(line, Reuse::yes));
    tape.fused = write_fused(fuse(line));
    return tape;
}

Traced compile_traced(const ir::Module& module, const ir::Function& function)
{
    const Line line = scalarize(module, function, Trace::all);
    const Slots slots = assign_slots(line, Reuse::no);
    Traced traced{write_tape(line, slots), {}};
    for (const auto& values : line.values_of) {
        auto& slots_of = traced.slots_of.emplace_back();
        for (const Value value : values) slots_of.push_back(slots.of[value]);
    }
    return traced;
}

std::string component_suffix(ir::Type type, ir::Quantity quantity, int component)
{
    if (components(type) == 1) return "";
    const std::string_view letters = quantity == ir::Quantity::color ? "rgba" : "xyzw";
    return fmt::format(".{}", letters[static_cast<std::size_t>(component)]);
}

std::string dump(const Tape& tape)
{
    std::string text;
    for (std::size_t i = 0; i < tape.inputs.size(); ++i)
        text += fmt::format("s{} = input {}\n", i, tape.inputs[i].name);
    for (const Constant& constant : tape.constants)
        text += fmt::format("s{} = {}\n", constant.slot, constant.literal.text);
    for (const Instruction& instruction : tape.code) {
        text += fmt::format("s{} = {}", instruction.result, name(instruction.op));
        const std::array operands{instruction.a, instruction.b, instruction.c, instruction.d};
        for (std::size_t i = 0; i < static_cast<std::size_t>(arity(instruction.op)); ++i)
            text += fmt::format(" s{}", operands[i]);
        text += "\n";
    }
    for (std::size_t i = 0; i < tape.outputs.size(); ++i)
        text += fmt::format("{} = s{}\n", tape.output_names[i], tape.outputs[i]);
    return text;
}

}  // namespace lobe::evaluate
