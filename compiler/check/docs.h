// Doc comments as the module keeps them: prose apart from citations, and bodies on one line.
#pragma once

#include "check/program.h"

#include <string>
#include <vector>

namespace lobe::check {

struct Documentation {
    std::string text;  ///< the prose, lines joined by newlines
    std::vector<ir::Citation> citations;
};

/// Splits the `///` lines among comments. A line is a citation when it consists of the name of a
/// source and a place in it: numbers, single letters, and words such as `slide`, `eq`, `section`:
/// `slides 85`, `Walter07 eq 33`, `Karis13b D`, `Karis14`. A line that looks like one but names no
/// declared source is reported (E0308).
Documentation read_documentation(const File& file, const std::vector<syntax::Comment>& comments,
                                 Diagnostics& diagnostics);

/// Source text on one line: comments gone, runs of space one space.
std::string one_line(std::string_view text);

/// A body as written, on one line: `let a = 1; a + x`.
std::string formula(const Sources& sources, const syntax::Tree& tree, const syntax::Body& body);

}  // namespace lobe::check
