// Line to slots: where each value lives while the tape runs.
//
// Inputs and constants keep their slots for the whole run, inputs first. A temporary's slot is
// free again after its last use, so that a block of all slots stays in the first-level cache;
// the result of an operation may take the slot of an operand that dies there, which every kernel
// allows because it reads a lane before it writes that lane.
#pragma once

#include "evaluate/line.h"

namespace lobe::evaluate {

enum class Reuse {
    no,
    yes
};

struct Slots {
    std::vector<bool> live;  ///< by value; what is dead has no slot, except inputs
    std::vector<Slot> of;    ///< by value
    Slot count = 0;
};

/// With `Reuse::no` every value is live and has a slot of its own.
Slots assign_slots(const Line& line, Reuse reuse);

}  // namespace lobe::evaluate
