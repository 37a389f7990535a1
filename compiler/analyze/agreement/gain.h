// What the passes gain a function in accuracy: its float error as written and as emitted.
#pragma once

#include "ir/module.h"

#include <cstddef>

namespace lobe::analyze {

/// Of a function in one spelling, against the same expressions in double (see reference.h), over
/// the points of the checker, hostile ones among them.
struct FloatError {
    double typical = 0;          ///< relative, not exceeded by half of the results
    double worst_of_99 = 0;      ///< not exceeded by 99 of 100
    std::size_t not_finite = 0;  ///< results that are NaN or infinite
    std::size_t results = 0;
};

/// `module` went through optimize or spell. Darker than 2^-13 of the median a result is compared
/// with that: nobody sees more.
FloatError float_error(const ir::Module& module, ir::FunctionId function, std::size_t count);

}  // namespace lobe::analyze
