#include "base/utf8.h"

#include <algorithm>
#include <array>

namespace lobe {
namespace {

struct Block {
    char32_t first;
    char32_t last;
};

// The blocks of [UAX11] and of the combining marks that a `.lobe` file may hold in comments.
constexpr std::array zero_width{Block{0x0300, 0x036F}, Block{0x200B, 0x200F}, Block{0x20D0, 0x20F0},
                                Block{0xFE00, 0xFE0F}};
constexpr std::array double_width{
    Block{0x1100, 0x115F},   Block{0x2E80, 0x303E},   Block{0x3041, 0xA4CF},  Block{0xAC00, 0xD7A3},
    Block{0xF900, 0xFAFF},   Block{0xFE30, 0xFE6F},   Block{0xFF00, 0xFF60},  Block{0xFFE0, 0xFFE6},
    Block{0x1F300, 0x1F64F}, Block{0x1F900, 0x1F9FF}, Block{0x20000, 0x3FFFD}};

template <std::size_t size>
bool holds(const std::array<Block, size>& blocks, char32_t code)
{
    return std::any_of(blocks.begin(), blocks.end(), [&](const Block& block) {
        return block.first <= code && code <= block.last;
    });
}

}  // namespace

Character first_character(std::string_view text)
{
    constexpr Character bad{0xFFFD, 1, false};
    constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
    if (text.empty()) return {};
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x80) return {lead, 1, true};
    const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    if (size == 1 || lead > 0xF4 || size > text.size()) return bad;

    char32_t code = lead & (0x7FU >> size);
    for (std::size_t i = 1; i < size; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xC0) != 0x80) return bad;
        code = (code << 6) | (byte & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < smallest[size] || code > 0x10FFFF || surrogate) return bad;
    return {code, size, true};
}

std::size_t first_not_utf8(std::string_view text)
{
    std::size_t at = 0;
    while (at < text.size()) {
        const Character character = first_character(text.substr(at));
        if (!character.valid) return at;
        at += character.size;
    }
    return at;
}

int display_width(char32_t code)
{
    if (code < 0x300) return 1;
    if (holds(zero_width, code)) return 0;
    return holds(double_width, code) ? 2 : 1;
}

bool changes_text_direction(char32_t code)
{
    return (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace lobe
