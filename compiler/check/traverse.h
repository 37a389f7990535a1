// Walking an expression of the tree without recursion: chains of operators may be thousands long.
#pragma once

#include "syntax/tree.h"

#include <vector>

namespace lobe::check {

/// The operands of an expression as written, left to right. A conditional's condition is first. A
/// sum has none: its ends are constants, and its body has a value per term.
std::vector<syntax::ExpressionId> children(const syntax::Expression& expression);

/// Under which choice an expression stands: inside the taken arm of a conditional. Guards form
/// chains towards the root of the expression; index 0 is no guard.
struct Guard {
    std::size_t outer = 0;
    syntax::ExpressionId condition;
    bool holds = true;  ///< false in the `else` arm
};

struct Visit {
    syntax::ExpressionId id;
    std::size_t guard = 0;  ///< index into `Walk::guards`
};

/// Every expression below a root, operands before what uses them, left to right.
struct Walk {
    std::vector<Visit> visits;
    std::vector<Guard> guards;
};
Walk walk(const syntax::Tree& tree, syntax::ExpressionId root);

}  // namespace lobe::check
