// Characters to tokens, and the wording of what forms none.
#include "syntax/lex.h"
#include "syntax/meaning.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using namespace lobe::syntax;

namespace {

std::vector<std::string> texts(std::string_view text)
{
    std::vector<std::string> result;
    for (const Token& token : lex(text, 0).all)
        result.emplace_back(text.substr(token.begin, token.end - token.begin));
    result.pop_back();
    return result;
}

/// The message and the fix for the only problem of a text.
std::string only_problem(std::string_view text)
{
    const Tokens tokens = lex(text, 0);
    if (tokens.problems.size() != 1) return fmt::format("{} problems", tokens.problems.size());
    const Diagnostic diagnostic = describe(tokens.problems[0], text, 0);
    return fmt::format("{} {}{}", id(diagnostic.code), diagnostic.message,
                       diagnostic.fix ? " -> " + diagnostic.fix->replacement : "");
}

}  // namespace

TEST_CASE("tokens are as long as they can be")
{
    CHECK(texts("a<=b->c==d") == std::vector<std::string>{"a", "<=", "b", "->", "c", "==", "d"});
    CHECK(texts("x1_y.z") == std::vector<std::string>{"x1_y", ".", "z"});
    CHECK(texts("2e3e") == std::vector<std::string>{"2e3e"});
    CHECK(texts("d.b[4..7]") == std::vector<std::string>{"d", ".", "b", "[", "4", "..", "7", "]"});
    CHECK(texts("0.5..1.5") == std::vector<std::string>{"0.5", "..", "1.5"});
    CHECK(texts("2%") == std::vector<std::string>{"2", "%"});
    CHECK(texts("1-2") == std::vector<std::string>{"1", "-", "2"});
    CHECK(texts("").empty());
}

TEST_CASE("numbers are decimal and complete")
{
    for (const char* good :
         {"0", "12", "0.75", "1e5", "1.5e-3", "1E+9", "007", "1e308", "5e-324"}) {
        CAPTURE(good);
        CHECK(lex(good, 0).problems.empty());
        CHECK(lex(good, 0).all.front().kind == TokenKind::number);
    }
    CHECK(only_problem(".5") == "E0103 `.5` is not a number -> 0.5");
    CHECK(only_problem("1.") == "E0103 `1.` is not a number -> 1.0");
    CHECK(only_problem("1.x") == "E0103 `1.x` is not a number");
    CHECK(only_problem("1e") == "E0103 `1e` is not a number");
    CHECK(only_problem("1.5f") == "E0103 `1.5f` is not a number -> 1.5");
    CHECK(only_problem("2x") == "E0103 `2x` is not a number -> 2 * x");
    CHECK(only_problem("1.2.3") == "E0103 `1.2.3` is not a number");
    CHECK(only_problem("0x1F") == "E0103 `0x1F` is not a number");
    CHECK(only_problem("1e309") == "E0103 the number `1e309` is beyond what the compiler can hold");
    CHECK(only_problem("1e-400") ==
          "E0103 the number `1e-400` is beyond what the compiler can hold");
}

TEST_CASE("spellings of other languages are named and understood")
{
    CHECK(only_problem("a && b") == "E0101 `&&` is not an operator -> and");
    CHECK(only_problem("a || b") == "E0101 `||` is not an operator -> or");
    CHECK(only_problem("!a") == "E0101 `!` is not an operator -> not ");
    CHECK(only_problem("a ** b") == "E0101 `**` is not an operator -> ^");
    CHECK(only_problem("a;") == "E0101 `;` is not part of the language -> ");
    CHECK(only_problem("a \u2212 b") == "E0101 `\u2212` is not part of the language -> -");
    CHECK(only_problem("\u03C0") == "E0101 `\u03C0` is not part of the language -> pi");
    CHECK(only_problem("/* a */ b") == "E0101 `/*` does not start a comment");
    CHECK(lex("a \u2264 b", 0).all[1].kind == TokenKind::less_equal);
    CHECK(lex("a ** b", 0).all[1].kind == TokenKind::caret);
    CHECK(lex("a != b", 0).problems.empty());
}

TEST_CASE("a run of strange characters is one problem")
{
    CHECK(only_problem("a @@@@ b") == "E0101 `@@@@` is not part of the language");
    CHECK(only_problem("\u00E4\u00F6\u00FC") ==
          "E0101 `\u00E4\u00F6\u00FC` is not part of the language");
    const std::string many(100'000, '@');
    CHECK(only_problem(many) ==
          fmt::format("E0101 `{}...` is not part of the language", std::string(40, '@')));
}

TEST_CASE("characters that hide what a text says are refused everywhere")
{
    using namespace std::string_literals;
    CHECK(only_problem("// a\x01z") == "E0101 a control character stands in the text");
    CHECK(only_problem("\"a\x7Fz\"") == "E0101 a control character stands in the text");
    CHECK(only_problem("a \0\0 b"s) == "E0101 a control character stands in the text");
    CHECK(only_problem("// \u202E") == "E0101 a character that reorders text stands here");
    CHECK(only_problem("// a\rb") == "E0101 a carriage return without a line feed");
    CHECK(only_problem("a \uFEFF b") == "E0101 a byte order mark stands inside the text");
    CHECK(lex("\uFEFFmodule m", 0).problems.empty());
    CHECK(lex("a\r\nb\r\n", 0).problems.empty());
    CHECK(lex("// caf\u00E9 \u2264 \"\u4E2D\"\n\"\u00E4\"", 0).problems.empty());
}

TEST_CASE("strings end on their line and escape two characters")
{
    CHECK(unquote(R"("a \" b \\ c")") == R"(a " b \ c)");
    CHECK(quote(R"(a " b \ c)") == R"("a \" b \\ c")");
    CHECK(unquote(quote("\\\"")) == "\\\"");
    CHECK(only_problem(R"("a\n")") == R"(E0104 `\n` is not an escape)");
    CHECK(only_problem("\"abc  \nx") == "E0102 this text has no closing quote -> \"abc\"");
    CHECK(only_problem("\"abc // note\nx") == "E0102 this text has no closing quote");
    CHECK(only_problem("\"") == "E0102 this text has no closing quote -> \"\"");
    CHECK(only_problem("\"a\\") == "E0102 this text has no closing quote -> \"a\\\"");
}

TEST_CASE("comments are kept with their places")
{
    const Tokens tokens = lex("// one\n\n/// two  \nx // three\r\n//four\n//// five", 0);
    REQUIRE(tokens.comments.size() == 5);
    std::vector<std::string> seen;
    for (const PlacedComment& placed : tokens.comments)
        seen.push_back(fmt::format("{}{}{}{}", placed.own_line ? "" : "behind ",
                                   placed.comment.blank_before ? "apart " : "",
                                   placed.comment.doc ? "doc " : "", placed.comment.text));
    CHECK(seen ==
          std::vector<std::string>{"one", "apart doc two", "behind three", "four", "// five"});
    CHECK(tokens.all.front().first_on_line);
}
