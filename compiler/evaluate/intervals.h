// Interval arithmetic over the reals: every operation of the tape, rounded outward in double.
//
// What a result contains: the value of the operation at every point of its operands where the
// operation is defined. Sharper than the sum of its parts where BRDF terms need it: a square is
// not negative, lerp is monotone in each operand, smoothstep and saturate stay in [0, 1].
#pragma once

#include "evaluate/interval.h"
#include "evaluate/tape.h"

namespace lobe::evaluate {

inline bool contains(Interval x, double value) { return x.low <= value && value <= x.high; }
Interval hull(Interval a, Interval b);
/// The numbers in both; they must have some in common.
Interval common(Interval a, Interval b);

Interval negate(Interval x);
Interval absolute(Interval x);
Interval add(Interval a, Interval b);
Interval subtract(Interval a, Interval b);
Interval multiply(Interval a, Interval b);
/// Unbounded on the sides where `b` reaches 0.
Interval divide(Interval a, Interval b);
Interval square(Interval x);
Interval square_root(Interval x);
Interval inverse_square_root(Interval x);
Interval minimum(Interval a, Interval b);
Interval maximum(Interval a, Interval b);
Interval power(Interval x, Interval y);
Interval lerp(Interval a, Interval b, Interval t);
Interval smoothstep(Interval edge0, Interval edge1, Interval x);
Interval normalized(Interval x, Interval squares);
Interval exp2(Interval x);
Interval log2(Interval x);
Interval exp(Interval x);
Interval log(Interval x);
Interval sine(Interval x);
Interval cosine(Interval x);
Interval tangent(Interval x);
Interval arc_sine(Interval x);
Interval arc_cosine(Interval x);
Interval arc_tangent(Interval x);
/// The two values of a condition that is always, never or sometimes true.
Interval truth(bool always, bool never);
Interval less(Interval a, Interval b);
Interval less_equal(Interval a, Interval b);
Interval equal(Interval a, Interval b);

/// Any operation of the tape. Operands past the arity are not read.
Interval apply(TapeOp op, Interval a, Interval b, Interval c, Interval d);

}  // namespace lobe::evaluate
