// What is 0 or 1 and nothing between chooses; it does not blend.
#pragma once

#include "ir/module.h"

#include <set>
#include <string>

namespace lobe::optimize {

/// The module where these parameters and surface fields, by name, are known to be 0 or 1 in every
/// component: a blend of vectors by such a number is a choice (one comparison and a move for each
/// component, where a blend multiplies and adds), and its powers are itself. The same function of
/// real numbers for these inputs, and no other for any else that is promised of it.
ir::Module choose_ends(const ir::Module& module, const std::set<std::string>& binary);

}  // namespace lobe::optimize
