// What the lexer knows about Unicode: enough to accept UTF-8 in comments and strings, to refuse
// characters that make a text read differently from what it says, and to recognize the
// typographic twins of operators that documents and papers are full of.
#pragma once

#include <cstddef>
#include <string_view>

namespace lobe::syntax {

inline constexpr std::string_view utf8_signature = "\xEF\xBB\xBF";

/// Bytes of the UTF-8 sequence that starts with `lead`; 1 if none does.
std::size_t character_size(char lead);

/// The offset of the first byte that is not UTF-8 (overlong forms and surrogates are not), or
/// the size of the text.
std::size_t first_not_utf8(std::string_view text);

/// The first code point of a text that is UTF-8; 0 for an empty text.
char32_t decode(std::string_view text);

/// Embeddings, overrides and isolates: they reorder what a reader sees.
bool changes_text_direction(char32_t code);

/// A character that is no token but looks like one.
struct LookAlike {
    std::string_view text;   ///< in UTF-8
    std::string_view ascii;  ///< what to write instead
};

/// The look-alike that the text starts with, or null.
const LookAlike* look_alike(std::string_view text);

}  // namespace lobe::syntax
