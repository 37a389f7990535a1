// The value of an expression that has to be known now: the ends of a range, a default.
#pragma once

#include "base/diagnostic.h"
#include "syntax/tree.h"

#include <optional>

namespace lobe::check {

/// Numbers, `pi`, `true` and `false` (1 and 0), `inf`-free arithmetic on them. Anything else is
/// reported (E0508), as is a value that is not finite; poison stays silent.
std::optional<double> constant_value(const syntax::Tree& tree, syntax::ExpressionId root,
                                     Diagnostics& diagnostics);

}  // namespace lobe::check
