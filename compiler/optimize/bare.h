// A module as it is typed by hand: the opposite of legalize.
#pragma once

#include "ir/module.h"

namespace lobe::optimize {

/// Every guard gone: powers, smoothsteps, normalizations and divisions are bare, `a / b else c` is
/// a / b, cosines of directions are not held in [-1, 1], and entry points compute the geometry
/// unguarded. x^2 is x * x, every other power `pow`.
/// Not legal, and not the same function where the guards counted.
ir::Module bare(const ir::Module& module);

}  // namespace lobe::optimize
