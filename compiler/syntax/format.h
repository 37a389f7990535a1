// Tree to canonical text. `parse(format(t))` means what `t` means; `format` is idempotent.
#pragma once

#include "syntax/tree.h"

#include <string>

namespace lobe::syntax {

/// The one way to write this tree. Keeps every comment and at most one blank line between
/// items; aligns runs of `param` lines; breaks lines at 100 columns where the grammar allows.
/// The tree must come from a parse without errors.
std::string format(const Tree& tree);

}  // namespace lobe::syntax
