#include "syntax/characters.h"

#include <algorithm>
#include <array>

namespace lobe::syntax {
namespace {

constexpr std::array look_alikes{
    LookAlike{"\u2212", "-"},      // minus sign
    LookAlike{"\u2013", "-"},      // en dash
    LookAlike{"\u2014", "-"},      // em dash
    LookAlike{"\u00D7", "*"},      // multiplication sign
    LookAlike{"\u00B7", "*"},      // middle dot
    LookAlike{"\u22C5", "*"},      // dot operator
    LookAlike{"\u00F7", "/"},      // division sign
    LookAlike{"\u2215", "/"},      // division slash
    LookAlike{"\u2264", "<="},     // less-than or equal
    LookAlike{"\u2265", ">="},     // greater-than or equal
    LookAlike{"\u2260", "!="},     // not equal
    LookAlike{"\u2192", "->"},     // rightwards arrow
    LookAlike{"\u201C", "\""},     // left double quotation mark
    LookAlike{"\u201D", "\""},     // right double quotation mark
    LookAlike{"\u2026", "..."},    // ellipsis
    LookAlike{"\u00A0", " "},      // no-break space
    LookAlike{"\u00B2", "^2"},     // superscript two
    LookAlike{"\u00B3", "^3"},     // superscript three
    LookAlike{"\u221A", "sqrt"},   // square root
    LookAlike{"\u03C0", "pi"},     // small pi
    LookAlike{"\u03B1", "alpha"},  // small alpha
    LookAlike{"\u03B8", "theta"},  // small theta
    LookAlike{"\u03C6", "phi"},    // small phi
};

}  // namespace

const LookAlike* look_alike(std::string_view text)
{
    const auto* const found =
        std::find_if(look_alikes.begin(), look_alikes.end(),
                     [&](const LookAlike& candidate) { return text.starts_with(candidate.text); });
    return found == look_alikes.end() ? nullptr : found;
}

}  // namespace lobe::syntax
