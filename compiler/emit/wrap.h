// Lines that fit a page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobe::emit {

/// `line` broken into pieces that fit 100 columns when they start at `column`: behind a comma or
/// before a binary operator, where the fewest parentheses are open, as late as fits; else behind an
/// assignment's `=`. Pieces after the first start with `indent`. A piece without such a place stays
/// too wide.
std::string wrap(std::string_view line, std::size_t column, std::string_view indent);

/// Prose broken at spaces, as lines of at most `width` columns. No line ends in a backslash.
std::vector<std::string> fill(std::string_view prose, std::size_t width);

/// As `fill`, paragraph by paragraph; blank lines between them stay.
std::vector<std::string> paragraphs(std::string_view prose, std::size_t width);

}  // namespace lobe::emit
