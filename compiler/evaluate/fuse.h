// Line to fused line: neighbors joined for the float kernels.
//
// Operations that are used once, by an operation that can take them in, disappear into it; a
// power becomes the logarithm of its base, which other powers of that base share, and the rest.
#pragma once

#include "evaluate/fused.h"
#include "evaluate/line.h"

namespace lobe::evaluate {

struct FusedLine {
    Line line;                 ///< `Step::op` means nothing here
    std::vector<FusedOp> ops;  ///< by value, of operations
};

/// The same outputs, in the same bits. Inputs and constants keep their order.
FusedLine fuse(const Line& line);

}  // namespace lobe::evaluate
