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

std::size_t character_size(char lead)
{
    const auto byte = static_cast<unsigned char>(lead);
    if (byte >= 0xF0) return 4;
    if (byte >= 0xE0) return 3;
    if (byte >= 0xC0) return 2;
    return 1;
}

char32_t decode(std::string_view text)
{
    if (text.empty()) return 0;
    const std::size_t size = std::min(character_size(text.front()), text.size());
    const auto lead = static_cast<unsigned char>(text.front());
    if (size == 1) return lead;
    char32_t code = lead & (0x7FU >> size);
    for (std::size_t i = 1; i < size; ++i)
        code = (code << 6) | (static_cast<unsigned char>(text[i]) & 0x3FU);
    return code;
}

bool changes_text_direction(char32_t code)
{
    return (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

const LookAlike* look_alike(std::string_view text)
{
    const auto* const found =
        std::find_if(look_alikes.begin(), look_alikes.end(),
                     [&](const LookAlike& candidate) { return text.starts_with(candidate.text); });
    return found == look_alikes.end() ? nullptr : found;
}

std::size_t first_not_utf8(std::string_view text)
{
    constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
    std::size_t at = 0;
    while (at < text.size()) {
        const auto lead = static_cast<unsigned char>(text[at]);
        const std::size_t size = character_size(text[at]);
        if (size == 1) {
            if (lead >= 0x80) return at;
            ++at;
            continue;
        }
        if (lead > 0xF4 || at + size > text.size()) return at;
        for (std::size_t i = 1; i < size; ++i)
            if ((static_cast<unsigned char>(text[at + i]) & 0xC0) != 0x80) return at;
        const char32_t code = decode(text.substr(at, size));
        const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
        if (code < smallest[size] || code > 0x10FFFF || surrogate) return at;
        at += size;
    }
    return at;
}

}  // namespace lobe::syntax
