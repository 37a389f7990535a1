// The typographic twins of operators that documents and papers are full of.
#pragma once

#include <string_view>

namespace lobe::syntax {

/// A character that is no token but looks like one.
struct LookAlike {
    std::string_view text;   ///< in UTF-8
    std::string_view ascii;  ///< what to write instead
};

/// The look-alike that the text starts with, or null.
const LookAlike* look_alike(std::string_view text);

}  // namespace lobe::syntax
