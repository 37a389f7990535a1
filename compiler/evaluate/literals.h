// A literal is a real number; these are the nearest numbers of each kind, or the tightest bounds.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/real.h"
#include "ir/graph.h"

namespace lobe::evaluate {

/// Nearest, ties to even; infinite beyond the largest finite number.
float to_float(const ir::Literal& literal);
double to_double(const ir::Literal& literal);
/// The nearest binary16, as a double; but never a denormal one, which a target may take for 0:
/// what is not 0 is at least the least normal half, so that a bound that keeps something above 0
/// does so in half too.
double to_half(const ir::Literal& literal);

/// The two doubles around the number, or one double twice when it is that double.
Interval to_interval(const ir::Literal& literal);

Real to_real(const ir::Literal& literal, int bits);

}  // namespace lobe::evaluate
