#include "evaluate/slots.h"

#include <algorithm>

namespace lobe::evaluate {

Slots assign_slots(const Line& line, Reuse reuse)
{
    const std::size_t size = line.steps.size();
    constexpr std::size_t never = static_cast<std::size_t>(-1);

    // The last value that reads each value; outputs are read after all of them.
    std::vector<std::size_t> last_use(size, never);
    Slots slots;
    slots.live.assign(size, reuse == Reuse::no);
    slots.of.resize(size);
    for (const Value output : line.outputs) {
        slots.live[output] = true;
        last_use[output] = size;
    }
    for (std::size_t i = size; i-- > 0;) {
        if (!slots.live[i]) continue;
        for (const Value operand : line.steps[i].arguments()) {
            slots.live[operand] = true;
            if (last_use[operand] == never) last_use[operand] = i;
        }
    }

    // Inputs and constants come first, dead inputs too: callers pass every column.
    slots.count = static_cast<Slot>(line.inputs.size());
    for (std::size_t i = 0; i < size; ++i) {
        const Step& step = line.steps[i];
        if (step.kind == Step::Kind::input) slots.of[i] = step.index;
        if (step.kind == Step::Kind::constant && slots.live[i]) slots.of[i] = slots.count++;
    }

    std::vector<Slot> free;
    for (std::size_t i = 0; i < size; ++i) {
        const Step& step = line.steps[i];
        if (step.kind != Step::Kind::operation || !slots.live[i]) continue;

        if (reuse == Reuse::yes) {
            std::vector<Value> dying;
            for (const Value operand : step.arguments())
                if (line.steps[operand].kind == Step::Kind::operation && last_use[operand] == i &&
                    std::ranges::find(dying, operand) == dying.end())
                    dying.push_back(operand);
            for (const Value operand : dying) free.push_back(slots.of[operand]);
        }
        if (free.empty()) {
            slots.of[i] = slots.count++;
        } else {
            slots.of[i] = free.back();
            free.pop_back();
        }
    }
    return slots;
}

}  // namespace lobe::evaluate
