// Module to module: the passes, in the order they run. Pure and total.
//
// Every pass keeps what the module means over the real numbers. Each is one file with one test,
// and says in its header which promise it adds.
#pragma once

#include "ir/module.h"

namespace lobe::optimize {

/// Literals folded where the fold is exact, neutral operands gone, dead expressions dropped,
/// unused inputs of functions (but not of roots' own arguments) removed.
ir::Module simplify(const ir::Module& module);

/// The same for a module that another pass made of one that was simple: only what differs from
/// it, and what calls that, is looked at.
ir::Module simplify_again(const ir::Module& simple, const ir::Module& module);

/// Quotients multiplied by their divisor, roots squared, angles undone: each gone.
ir::Module cancel(const ir::Module& module);

/// Cancelling differences over geometry replaced by the stable fields (ir/geometry.h) and by
/// factored forms, through calls.
ir::Module stabilize(const ir::Module& module);

/// Large powers of cosines near 1 from what they lack of 1.
ir::Module near_one(const ir::Module& module);

/// Products of vectors and scalars with the scalars first: fewer operations and roundings.
ir::Module regroup(const ir::Module& module);

/// Every `power`, `smoothstep`, `normalize` and guarded division is either proved safe over the
/// declared ranges and bare, or guarded; integer powers are products. The promise `legal`.
ir::Module legalize(const ir::Module& module);

/// All of the above: what emit, verify and evaluate read.
ir::Module optimize(const ir::Module& module);

}  // namespace lobe::optimize
