// What a tree says, as text without spans, comments and parentheses: two trees mean the same if
// their texts are equal.
#pragma once

#include "syntax/parse.h"

#include <string>
#include <string_view>
#include <vector>

namespace lobe::tests {

/// `(+ a (* b c))`
std::string meaning(const syntax::Tree& tree, syntax::ExpressionId id);

/// One line per item.
std::string meaning(const syntax::Tree& tree);

/// Every comment of a tree in the order of its text, doc comments with `/` in front.
std::vector<std::string> comments(const syntax::Tree& tree);

/// A parsed text with all that tests ask about it.
struct Parsed {
    Sources sources;
    Diagnostics diagnostics;
    syntax::Tree tree;
};
Parsed parsed(std::string text);

/// The short ids of what was reported, in source order, separated by spaces.
std::string codes(const Diagnostics& diagnostics);

/// The meaning of one expression, read as the value of a term.
std::string expression(std::string_view text);

}  // namespace lobe::tests
