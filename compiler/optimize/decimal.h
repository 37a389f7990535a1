// Literals as decimals: arithmetic that a double would round, exact as on paper.
//
// A setting of 0.7 is seven tenths, so 5 * (2 * (1 - 0.7)) is 3 and a power with that exponent two
// products. No double is 0.7, and with doubles alone the exponent would be a hair off 3.
#pragma once

#include "ir/module.h"

namespace lobe::optimize {

/// Sums, differences, products, whole powers, and quotients that end, of literals: one literal, in
/// every component. Where the exact decimal has more than 17 digits everything stays.
ir::Module fold_decimals(const ir::Module& module);

/// The narrowest range around another whose ends have six digits or less: what a shader is
/// promised, as people read it. 0.30000001192092896 is a float, and says nothing that 0.3 does not.
ir::Range in_digits(const ir::Range& range);

}  // namespace lobe::optimize
