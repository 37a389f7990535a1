// A function in packed half precision: two evaluations at once, one per half of a register.
//
// No target emits this; it is written from the tape, whose scalars become f16vec2, so that what it
// would cost can be measured. Half of the hardware's vector instructions have packed forms.
#pragma once

#include "emit/cost_harness.h"
#include "ir/module.h"

#include <vector>

namespace lobe::analyze {

/// As emit::evaluation, for NumberFormat::packed16.
emit::Evaluation packed_evaluation(const ir::Module& module,
                                   const std::vector<ir::FunctionId>& functions, bool from_vectors);

}  // namespace lobe::analyze
