// Acceptance intervals: every operation of the tape by the Vulkan precision table.
//
// What a result contains: everything that a conforming device may return for any operands in
// the operands' intervals. docs/numerics.md has the table, a line per operation with its source.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/run.h"
#include "evaluate/tape.h"

namespace lobe::evaluate {

/// The floating-point format of a precision, and its column of the table.
struct Rules {
    int digits;      ///< of the significand, with the hidden one
    double epsilon;  ///< 2^(1 - digits): one rounding in either direction, relative
    double largest;  ///< finite number
    double least_normal;
    double largest_divisor;  ///< division promises nothing outside [1 / this, this]
    double exp2_units;       ///< exp2 x is off by this many units in the last place, plus 2 |x|
    double log2_error;       ///< absolute, for operands in [1/2, 2]; 3 units outside
    double sine_error;       ///< absolute, in [-pi, pi]
    double atan2_units;
};

const Rules& rules(Precision precision);

/// What a device may read for this number: itself, or 0 where it is denormal. Ends that are no
/// numbers of the format move outward.
Acceptance admit(const Rules& rules, Acceptance x);

/// Any operation of the tape. Operands past the arity are not read.
Acceptance apply(const Rules& rules, TapeOp op, const Acceptance& a, const Acceptance& b,
                 const Acceptance& c, const Acceptance& d);

}  // namespace lobe::evaluate
