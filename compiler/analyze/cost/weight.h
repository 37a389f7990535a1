// What a tape weighs: about the cycles in which a GPU's vector unit is busy with it. No
// measurement (analyze/cost/cost.h has those); enough to tell which forms are not worth trying.
#pragma once

#include "evaluate/tape.h"

namespace lobe::analyze {

inline constexpr int weight_of_division = 4;

/// 1 per operation, 4 for those that run at a quarter of the rate. Free: a sum with a product that
/// nothing else reads (they become one operation), signs and saturations (they are modifiers), and
/// what does not depend on an input.
int weight(const evaluate::Tape& tape);

}  // namespace lobe::analyze
