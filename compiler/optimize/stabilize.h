// What stabilize did, for reports and tests.
#pragma once

#include "ir/module.h"
#include "optimize/rules.h"

#include <vector>

namespace lobe::optimize {

/// A rule and where it was used.
struct Application {
    const Rule* rule = nullptr;
    ir::FunctionId function;
    Span span;  ///< of the expression as written
};

/// As `stabilize` of optimize.h; appends what it did to `log`, functions in order. With
/// `Inputs::given` no function gains an input.
ir::Module stabilize(const ir::Module& module, std::vector<Application>& log,
                     Inputs inputs = Inputs::from_vectors);

}  // namespace lobe::optimize
