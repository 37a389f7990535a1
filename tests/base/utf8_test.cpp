#include "base/utf8.h"

#include <catch2/catch.hpp>

#include <string>

using namespace lobe;

namespace {

std::string encode(char32_t code)
{
    const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
    if (code < 0x80) return {static_cast<char>(code)};
    if (code < 0x800) return {static_cast<char>(0xC0 | (code >> 6)), tail(0)};
    if (code < 0x10000) return {static_cast<char>(0xE0 | (code >> 12)), tail(6), tail(0)};
    return {static_cast<char>(0xF0 | (code >> 18)), tail(12), tail(6), tail(0)};
}

}  // namespace

TEST_CASE("every code point but the surrogates is read back")
{
    for (char32_t code = 0; code <= 0x10FFFF; ++code) {
        const std::string text = encode(code) + "x";
        const Character character = first_character(text);
        const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
        if (character.valid == surrogate || (!surrogate && character.code != code) ||
            (!surrogate && character.size != text.size() - 1))
            FAIL("code point " << static_cast<unsigned long>(code));
    }
}

TEST_CASE("what is not UTF-8 is found at its first byte")
{
    CHECK(first_not_utf8("abc") == 3);
    CHECK(first_not_utf8("") == 0);
    CHECK(first_not_utf8("a\x80") == 1);
    CHECK(first_not_utf8("a\xC0\x80") == 1);
    CHECK(first_not_utf8("a\xE0\x80\x80") == 1);
    CHECK(first_not_utf8("a\xF0\x80\x80\x80") == 1);
    CHECK(first_not_utf8("a\xF5\x80\x80\x80") == 1);
    CHECK(first_not_utf8("\xE2\x82") == 0);
    CHECK(first_not_utf8("\u00E4\xFF") == 2);
}

TEST_CASE("any bytes are walked to their end")
{
    for (int a = 0; a < 256; ++a)
        for (int b = 0; b < 256; ++b) {
            const std::string text{static_cast<char>(a), static_cast<char>(b)};
            const std::size_t first = first_character(text).size;
            if (first < 1 || first > 2) FAIL("bytes " << a << " " << b);
        }
    CHECK(first_character("").size == 0);
}

TEST_CASE("wide and combining characters have their widths")
{
    CHECK(display_width('a') == 1);
    CHECK(display_width(0xE9) == 1);
    CHECK(display_width(0x301) == 0);
    CHECK(display_width(0x4E2D) == 2);
    CHECK(display_width(0x1F600) == 2);
    CHECK(changes_text_direction(0x202E));
    CHECK_FALSE(changes_text_direction(0x2030));
}
