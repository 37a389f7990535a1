#include "evaluate/run.h"

#include "evaluate/blocks.h"
#include "evaluate/kernels.h"
#include "evaluate/literals.h"

#include <cassert>
#include <type_traits>

namespace lobe::evaluate {
namespace {

template <class Number>
void run_blocks(const Tape& tape, const KernelTable<Number>& table, Columns<Number> inputs,
                Results<Number> outputs, std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    Blocks<Number> blocks{tape.inputs.size(), tape.slots};
    for (const Constant& constant : tape.constants) {
        if constexpr (std::is_same_v<Number, float>)
            blocks.fill(constant.slot, to_float(constant.literal));
        else
            blocks.fill(constant.slot, to_double(constant.literal));
    }
    for (std::size_t begin = 0; begin < count; begin += block_lanes) {
        const std::size_t size = std::min(block_lanes, count - begin);
        blocks.enter(inputs, begin, size);
        for (const Instruction& step : tape.code)
            table[static_cast<std::size_t>(step.op)](blocks[step.result], blocks[step.a],
                                                     blocks[step.b], blocks[step.c],
                                                     blocks[step.d]);
        blocks.leave(tape.outputs, outputs, begin, size);
    }
}

}  // namespace

void run(const Tape& tape, Columns<float> inputs, Results<float> outputs, std::size_t count)
{
    run_blocks(tape, kernels<float>(widest()), inputs, outputs, count);
}

void run(const Tape& tape, Columns<double> inputs, Results<double> outputs, std::size_t count)
{
    run_blocks(tape, kernels<double>(widest()), inputs, outputs, count);
}

}  // namespace lobe::evaluate
