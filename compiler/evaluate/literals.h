// A literal is a real number; these are the nearest numbers of each kind, or the tightest bounds.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/real.h"
#include "ir/graph.h"

namespace lobe::evaluate {

/// Nearest, ties to even; infinite beyond the largest finite number.
float to_float(const ir::Literal& literal);
double to_double(const ir::Literal& literal);
/// The nearest binary16, as a double. Denormals are kept.
double to_half(const ir::Literal& literal);

/// The two doubles around the number, or one double twice when it is that double.
Interval to_interval(const ir::Literal& literal);

Real to_real(const ir::Literal& literal, int bits);

}  // namespace lobe::evaluate
