#include "evaluate/run.h"

#include "evaluate/blocks.h"
#include "evaluate/kernels.h"
#include "evaluate/literals.h"

#include <cassert>

namespace lobe::evaluate {
namespace {

double to_number(const ir::Literal& literal, double) { return to_double(literal); }
float to_number(const ir::Literal& literal, float) { return to_float(literal); }

/// Runs `code`, the tape's or its fused twin, with `table`'s kernels.
template <class Number, class Code, class Table>
void run_blocks(const Tape& tape, const Code& code, const std::vector<Slot>& results, Slot slots,
                const Table& table, Columns<Number> inputs, Results<Number> outputs,
                std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    Blocks<Number> blocks{tape.inputs.size(), slots};
    for (const Constant& constant : tape.constants)
        blocks.fill(constant.slot, to_number(constant.literal, Number{}));
    for (std::size_t begin = 0; begin < count; begin += block_lanes) {
        const std::size_t size = std::min(block_lanes, count - begin);
        blocks.enter(inputs, begin, size);
        for (const auto& step : code)
            table[static_cast<std::size_t>(step.op)](blocks[step.result], blocks[step.a],
                                                     blocks[step.b], blocks[step.c],
                                                     blocks[step.d]);
        blocks.leave(results, outputs, begin, size);
    }
}

}  // namespace

void run_on(InstructionSet set, const Tape& tape, Columns<float> inputs, Results<float> outputs,
            std::size_t count)
{
    run_blocks(tape, tape.fused.code, tape.fused.outputs, tape.fused.slots, fused_kernels(set),
               inputs, outputs, count);
}

void run(const Tape& tape, Columns<float> inputs, Results<float> outputs, std::size_t count)
{
    run_on(widest(), tape, inputs, outputs, count);
}

void run(const Tape& tape, Columns<double> inputs, Results<double> outputs, std::size_t count)
{
    run_blocks(tape, tape.code, tape.outputs, tape.slots, kernels<double>(widest()), inputs,
               outputs, count);
}

}  // namespace lobe::evaluate
