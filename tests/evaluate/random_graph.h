// Random modules for property tests: every operation of the language, in its domain.
//
// What comes out is what a checker could have let through: operands of a square root, a logarithm
// or an arc cosine lie in its domain over the declared ranges, divisors are guarded or bounded away
// from zero, calls stay inside the ranges of what they call, and no value grows past 10^4.
#pragma once

#include "ir/module.h"

#include <random>
#include <vector>

namespace lobe::tests {

struct RandomShape {
    int functions = 3;     ///< the later ones may call the earlier ones
    int expressions = 16;  ///< operations drawn per function; some end up dead
    bool vectors = true;
    bool elementary = true;  ///< sines, exponentials, powers with general exponents
    bool selects = true;     ///< comparisons, steps and choices: what may jump
};

/// A module `random` of terms `f0`, `f1`, ...; the last one has everything.
ir::Module random_module(std::mt19937& random, const RandomShape& shape = {});

/// One value per scalar input of the function, in its declared ranges; every fourth at an end,
/// every eighth a denormal where the range has 0. All are floats.
std::vector<double> random_point(std::mt19937& random, const ir::Function& function);

}  // namespace lobe::tests
