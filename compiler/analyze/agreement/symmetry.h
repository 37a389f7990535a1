// Is a function the same when two of its inputs trade places? A proof, not a test.
#pragma once

#include "ir/module.h"

namespace lobe::analyze {

/// True when swapping inputs a and b of a function of the module turns what it computes into
/// itself, up to the order and grouping of sums and products and the order of the operands of
/// other commutative operations; calls are looked into. Then the two are equal over the reals.
/// False when that does not show it, which proves nothing.
bool is_symmetric(const ir::Module& module, ir::FunctionId function, std::uint32_t a,
                  std::uint32_t b);

}  // namespace lobe::analyze
