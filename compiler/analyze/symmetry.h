// Is a function the same when two of its inputs trade places? A proof, not a test.
#pragma once

#include "ir/module.h"

namespace lobe::analyze {

/// True when swapping inputs a and b turns the function's graph into itself, up to the order of
/// the operands of commutative operations: then the two are equal over the reals. False when that
/// does not show it, which proves nothing.
bool is_symmetric(const ir::Function& function, std::uint32_t a, std::uint32_t b);

}  // namespace lobe::analyze
