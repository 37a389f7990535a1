// UTF-8 as the compiler needs it: is it, what is the next character, how wide does it print.
#pragma once

#include <cstddef>
#include <string_view>

namespace lobe {

/// The first character of a text. Total: a byte that starts no character is one of size 1 whose
/// code is U+FFFD, so that a loop over any bytes ends. Size 0 for an empty text.
struct Character {
    char32_t code = 0;
    std::size_t size = 0;
    bool valid = false;  ///< shortest form, no surrogate, at most U+10FFFF
};
Character first_character(std::string_view text);

/// The offset of the first byte that is not UTF-8, or the size of the text.
std::size_t first_not_utf8(std::string_view text);

/// Columns that a character takes on a terminal: 0 for marks that combine with the one before, 2
/// for the wide ones of East Asia and emoji, else 1.
int display_width(char32_t code);

/// Embeddings, overrides and isolates: they reorder what a reader sees.
bool changes_text_direction(char32_t code);

}  // namespace lobe
