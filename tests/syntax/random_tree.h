// Random trees that a parse without errors could have made.
#pragma once

#include "syntax/tree.h"

#include <random>

namespace lobe::tests {

/// A whole file: every kind of item, comments and empty lines among them, names that are words of
/// the grammar, and expressions of up to `depth` levels.
syntax::Tree random_tree(std::mt19937& random, int depth);

}  // namespace lobe::tests
