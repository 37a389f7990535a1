// The files of data/stability, and how far spellings of their functions are off.
#pragma once

#include "base/source.h"
#include "evaluate/run.h"
#include "ir/module.h"
#include "optimize/spelling.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::tests {

/// As the checker leaves it, with the texts it was made from.
struct StabilityCase {
    ir::Module module;
    Sources sources;
};

/// data/stability/<name>.lobe, which may import shipped models; read once.
const StabilityCase& stability_case(const std::string& name);

/// Of a spelling, as a device computes it, against the exact value of the emitted one; over the
/// points of analyze::points, hostile ones among them.
struct Errors {
    double greatest = 0;  ///< relative, of 0.18 where the exact value is smaller
    double often = 0;     ///< what 99 of 100 points have less of
    double relative = 0;  ///< greatest, where the exact value is a normal number
    double absolute = 0;  ///< greatest
    std::size_t not_finite = 0;
};
Errors errors_of(const StabilityCase& which, const std::string& function,
                 optimize::Spelling spelling, evaluate::Precision precision);

/// The results of a function as emitted, in double; inputs in the order of its entry point's.
std::vector<double> exact_results(const StabilityCase& which, const std::string& function,
                                  const std::vector<double>& inputs);

}  // namespace lobe::tests
