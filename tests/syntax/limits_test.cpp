// Hostile input: refused with one message, within bounded time, memory and stack.
#include "syntax/format.h"
#include "syntax/meaning.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::parsed;

namespace {

std::string repeat(std::string_view text, std::size_t count)
{
    std::string result;
    result.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i) result += text;
    return result;
}

std::string codes_of_term(const std::string& value)
{
    return codes(parsed("module m\nterm t() = " + value + "\nterm u() = 1\n").diagnostics);
}

}  // namespace

TEST_CASE("expressions nest at most 256 deep")
{
    const auto nested = [](std::size_t depth) {
        return repeat("(", depth) + "1" + repeat(")", depth);
    };
    CHECK(codes_of_term(nested(255)) == "");
    CHECK(codes_of_term(nested(256)) == "E0203");
    CHECK(codes_of_term(nested(10'000)) == "E0203");
    CHECK(codes_of_term(repeat("(", 1'000'000)) == "E0203");
    CHECK(codes_of_term(repeat("-", 100'000) + "x") == "E0203");
    CHECK(codes_of_term(repeat("not ", 100'000) + "x") == "E0203");
    CHECK(codes_of_term(repeat("2^", 100'000) + "x") == "E0203");
    CHECK(codes_of_term(repeat("f(", 100'000)) == "E0203");
    CHECK(codes_of_term(repeat("if a then b else ", 100'000) + "x") == "E0203");
    CHECK(codes_of_term(repeat("if ", 100'000)) == "E0203");
    CHECK(codes_of_term(repeat("1 + if a then ", 100'000)) == "E0203");
    CHECK(codes_of_term(repeat("a / -", 100'000) + "x") == "E0203");
}

TEST_CASE("chains of operators are at most 1024 high")
{
    CHECK(codes_of_term("1" + repeat(" + 1", 1023)) == "");
    CHECK(codes_of_term("1" + repeat(" + 1", 1024)) == "E0203");
    CHECK(codes_of_term("1" + repeat(" + 1", 100'000)) == "E0203");
    CHECK(codes_of_term("1" + repeat(" / 1 else 1", 100'000)) == "E0203");
    CHECK(codes_of_term("a" + repeat(" and a", 100'000)) == "E0203");
    CHECK(codes_of_term("a" + repeat(".x", 100'000)) == "E0203");
    // Parentheses of a chain inside a chain: the height is of the tree, not of one level.
    CHECK(codes_of_term(repeat("(1" + repeat(" + 1", 40) + " + ", 100) + "1" + repeat(")", 100)) ==
          "");
    CHECK(codes_of_term(repeat("(", 100) + "1" + repeat(repeat(" + 1", 40) + ")", 100)) == "E0203");
}

TEST_CASE("the highest tree can be formatted")
{
    auto result = parsed("module m\nterm t() = 1" + repeat(" + a * 2", 1022) + "\n");
    REQUIRE(codes(result.diagnostics) == "");
    const std::string text = format(result.tree);
    result.sources.add("again.lobe", text);
    const Tree again = parse(result.sources, 1, result.diagnostics);
    CHECK(codes(result.diagnostics) == "");
    CHECK(format(again) == text);
}

TEST_CASE("expressions in blocks have the same bounds")
{
    const auto lines = [](const std::string& value) {
        return std::vector<std::string>{
            "gbuffer g { target t \"T\" { exists when " + value + " } }",
            "gbuffer g { target t \"T\" { exists when a else " + value + " } }",
            "gbuffer g { pin p \"P\" in [0, " + value + "] = 1 }",
            "gbuffer g { pin p \"P\" = " + value + " }",
            "code c(x: unit) { encode = " + value + " decode(u) = u }",
            "packing m on g { d.r = a : unorm 8 code power(" + value + ") }",
            "packing m on g { require exact a == " + value + " }",
            "engine g for m { color (0, 0, " + value + ") }"};
    };
    const auto codes_of = [](const std::string& item) {
        return codes(parsed("module m\n" + item + "\nterm u() = 1\n").diagnostics);
    };
    for (const std::string& item : lines(repeat("(", 255) + "1" + repeat(")", 255)))
        CHECK(codes_of(item) == "");
    for (const std::string& item : lines(repeat("(", 256) + "1" + repeat(")", 256)))
        CHECK(codes_of(item) == "E0203");
    for (const std::string& item : lines("1" + repeat(" + 1", 1023))) CHECK(codes_of(item) == "");
    for (const std::string& item : lines("1" + repeat(" + 1", 1024)))
        CHECK(codes_of(item) == "E0203");
    // Unclosed parentheses take the braces behind them along.
    for (const std::string& item : lines(repeat("f(", 100'000))) CHECK(codes_of(item) == "E0203");
}

TEST_CASE("the highest trees in blocks can be formatted")
{
    const std::string value = "1" + repeat(" + a * 2", 1022);
    auto result = parsed("module m\ngbuffer g {\n  target t \"T\" {\n    exists when " + value +
                         " == b else " + value + "\n  }\n  pin p \"P\" = " + value +
                         "\n}\npacking m on g {\n  d.r = a : unorm 8 in [0, " + value +
                         "]\n  require exact a == " + value + "\n}\n");
    REQUIRE(codes(result.diagnostics) == "E0203");  // a comparison on top is one level too many
    result = parsed("module m\ngbuffer g {\n  target t \"T\" {\n    exists when " + value +
                    " else " + value + "\n  }\n  pin p \"P\" = " + value +
                    "\n}\npacking m on g {\n  d.r = a : unorm 8 in [0, " + value +
                    "]\n  require exact a == " + value + "\n}\n");
    REQUIRE(codes(result.diagnostics) == "");
    const std::string text = format(result.tree);
    const auto again = parsed(text);
    CHECK(codes(again.diagnostics) == "");
    CHECK(format(again.tree) == text);
}

TEST_CASE("blocks may have as many lines as a file holds")
{
    constexpr std::size_t count = 50'000;
    for (const std::string& text :
         {"gbuffer g {\n" + repeat("setting s \"S\" : a, b = a\n", count) + "}",
          "gbuffer g {\ntarget t \"T\" {\n" + repeat("channel r \"R\" { field \"f\" }\n", count) +
              "}\n}",
          "gbuffer g {\n" + repeat("pin p \"P\" in [0, 1] = 1\n", count) + "}",
          "packing m on g {\n" + repeat("d.r[0..3] = a : unorm 4 code power(8)\n", count) + "}",
          "packing m on g {\nwithout a" + repeat(", a", count) + "\n}",
          "engine g for m {\n" + repeat("pin p = a \"A\"\n", count) + "}"}) {
        const auto result = parsed("module m\n" + text + "\n");
        REQUIRE(codes(result.diagnostics) == "");
        const std::string canonical = format(result.tree);
        CHECK(format(parsed(canonical).tree) == canonical);
    }
}

TEST_CASE("a file is at most 8 MiB")
{
    const std::size_t limit = std::size_t{8} << 20;
    const std::string head = "module m\nterm t() = 1\n";
    CHECK(codes(parsed(head + std::string(limit - head.size(), ' ')).diagnostics) == "");
    const auto result = parsed(head + std::string(limit - head.size() + 1, ' '));
    CHECK(codes(result.diagnostics) == "E0003");
    CHECK(result.diagnostics.all()[0].message ==
          "this file has 8388609 bytes; at most 8388608 are accepted");
    CHECK(result.tree.items.empty());
}

TEST_CASE("a file is UTF-8")
{
    const auto offset = [](const std::string& text) {
        const auto result = parsed(text);
        if (codes(result.diagnostics) != "E0002") return std::string{"accepted"};
        return result.diagnostics.all()[0].message;
    };
    CHECK(offset("module m\xFF") == "this file is not UTF-8: byte 0xFF at offset 8");
    CHECK(offset("// \xC3") == "this file is not UTF-8: byte 0xC3 at offset 3");
    CHECK(offset("// \xC0\xAF") == "this file is not UTF-8: byte 0xC0 at offset 3");
    CHECK(offset("// \xED\xA0\x80") == "this file is not UTF-8: byte 0xED at offset 3");
    CHECK(offset("// \xF4\x90\x80\x80") == "this file is not UTF-8: byte 0xF4 at offset 3");
    CHECK(offset("// \xE2\x82") == "this file is not UTF-8: byte 0xE2 at offset 3");
    CHECK(offset("// \xF0\x9F\x98\x80\nmodule m\nterm t() = 1") == "accepted");
    const auto utf16 = parsed("\xFF\xFEm");
    CHECK(utf16.diagnostics.all().at(0).helps.at(0) ==
          "the file starts like UTF-16; save it as UTF-8");
}

TEST_CASE("a file declares something")
{
    const auto message = [](const std::string& text) {
        const auto result = parsed(text);
        return codes(result.diagnostics) + " " + result.diagnostics.all().at(0).message;
    };
    CHECK(message("") == "E0004 this file is empty");
    CHECK(message(" \r\n\t\n") == "E0004 this file is empty");
    CHECK(message("\uFEFF") == "E0004 this file is empty");
    CHECK(message("// only this\n") == "E0004 this file has comments, but declares nothing");
    CHECK(message("module m\n") == "E0004 this module declares nothing");
}

TEST_CASE("blocks of broken lines end with few messages")
{
    for (const char* head : {"gbuffer g {\n", "gbuffer g {\ntarget t \"T\" {\n",
                             "gbuffer g {\ntarget t \"T\" {\nchannel c \"C\" {\n",
                             "packing m on g {\n", "engine g for m {\n", "code c(x: unit) {\n"})
        for (const char* line :
             {"(", "{", "chanel ", "chanel c\n", "channel c {\n", "target t \"T\" {\n", "d.r\n",
              "d.r = a\n", "require exact\n", "reqire\n", "node \"N\" { a\n", "color (\n",
              "encode =\n", "exists when\n", "/// doc\nformat unorm 8\n", "@\n", "a b c d\n"}) {
            CAPTURE(head, line);
            const auto result = parsed(std::string{"module m\n"} + head + repeat(line, 20'000));
            CHECK(result.diagnostics.error_count() >= 1);
            CHECK(result.diagnostics.error_count() <= 20);
        }
}

TEST_CASE("large files of every kind of token end with few messages")
{
    for (const char* piece : {"(",
                              ")",
                              "{",
                              "}",
                              "@ ",
                              ";",
                              "\"a\n",
                              "1.2.3 ",
                              "a ",
                              "a\n",
                              "/*",
                              "term ",
                              "\nterm t() = ",
                              "\nform f = 1",
                              "///\n",
                              "let ",
                              "else ",
                              "\ntem a()",
                              "\npacking a on b {",
                              "\ngbuffer a {",
                              "\ngbuffer a { target t \"T\" { channel c \"C\" {",
                              "\ncode c(x: unit) {",
                              "\nengine a for b { node \"n\" {",
                              "..",
                              "%",
                              "a = \n",
                              ",",
                              "import a {",
                              "^",
                              "\r"}) {
        CAPTURE(piece);
        const auto result = parsed("module m\n" + repeat(piece, 200'000));
        CHECK(result.diagnostics.error_count() >= 1);
        CHECK(result.diagnostics.error_count() <= 20);
    }
}
