// Expressions to canonical text; inside `syntax` only.
#pragma once

#include "syntax/tree.h"

#include <string>
#include <vector>

namespace lobe::syntax {

/// Writes expressions with as few parentheses as their meaning and a reader need, on one line
/// where it fits and broken before operators and after commas where not.
class ExpressionWriter {
public:
    explicit ExpressionWriter(const Tree& tree);

    /// Columns that the expression takes on one line.
    std::size_t width(ExpressionId id) const { return widths_[id.index]; }

    /// On one line, but for sums that are blocks.
    std::string flat(ExpressionId id) const;

    /// Starting in `column`; further lines are indented by `indent` or more.
    std::string broken(ExpressionId id, std::size_t column, std::size_t indent) const;

    /// Whether it is a sum, or ends in one: it opens a block beside what stands before it.
    bool is_block(ExpressionId id) const;
    /// Whether it needs parentheses where an `else` that follows is not its own.
    bool parenthesize_before_else(ExpressionId id) const;
    /// Whether the value of a block needs them, so as not to continue the `let` before it.
    bool parenthesize_value(const Body& body) const;
    /// Whether it needs parentheses as an operand of a comparison.
    bool parenthesize_as_sum(ExpressionId id) const;

    static constexpr std::size_t widest_line = 100;

private:
    class Layout;

    const Tree& tree_;
    std::vector<std::size_t> widths_;  ///< of each, without its own parentheses; of what takes
                                       ///< several lines more than `widest_line`
};

/// A comment as it is written, `// …` or `/// …`.
std::string slashes(const Comment& comment);

/// Characters of a text in UTF-8.
std::size_t character_count(std::string_view text);

}  // namespace lobe::syntax
