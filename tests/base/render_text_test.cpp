// What people see, drawn by drawn.
#include "base/render.h"

#include <catch2/catch.hpp>

using namespace lobe;

namespace {

/// One source, and spans found in it by their text.
struct Stage {
    Sources sources;
    Diagnostics diagnostics;

    explicit Stage(std::string text) { sources.add("models/cloth.lobe", std::move(text)); }

    Span at(std::string_view text, std::size_t nth = 0) const
    {
        std::size_t begin = sources[0].text().find(text);
        for (; nth > 0; --nth) begin = sources[0].text().find(text, begin + 1);
        return {0, static_cast<std::uint32_t>(begin),
                static_cast<std::uint32_t>(begin + text.size())};
    }

    std::string draw(Diagnostic diagnostic, bool color = false)
    {
        diagnostics = {};
        diagnostics.report(std::move(diagnostic));
        return "\n" + render_text(sources, diagnostics, color);
    }
};

Diagnostic error(Label primary)
{
    return {.code = Code::divisor_reaches_zero, .message = "m", .primary = std::move(primary)};
}

}  // namespace

TEST_CASE("a diagnostic shows what was seen, the facts and the corrected line")
{
    Stage stage{"module cloth\n    param alpha : scalar[0 .. 1]\n\n\n"
                "        alpha^2 / (pi * (NoH^2 * (alpha^2 - 1) + 1)^2)\n"};
    Diagnostic diagnostic =
        error({stage.at("(pi * (NoH^2 * (alpha^2 - 1) + 1)^2)"), "is 0 at alpha = 0, NoH = 1"});
    diagnostic.message = "divisor of `D` reaches zero";
    diagnostic.secondary = {{stage.at("scalar[0 .. 1]"), "`alpha` may be 0"}};
    diagnostic.notes = {"over its parameters' ranges this divisor lies in [0, 3.14159]"};
    const Span low{0, stage.at("0 .. 1").begin, stage.at("0 .. 1").begin + 1};
    diagnostic.fix = Fix{low, "0.002", "start the range above zero"};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: divisor of `D` reaches zero
 --> models/cloth.lobe:5:19
  |
2 |     param alpha : scalar[0 .. 1]
  |                   -------------- `alpha` may be 0
...
5 |         alpha^2 / (pi * (NoH^2 * (alpha^2 - 1) + 1)^2)
  |                   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ is 0 at alpha = 0, NoH = 1
  = note: over its parameters' ranges this divisor lies in [0, 3.14159]
  = help: start the range above zero
2 |     param alpha : scalar[0.002 .. 1]
  |                          ~~~~~
)");
}

TEST_CASE("labels on one line hang below each other")
{
    Stage stage{"one two three\n"};
    Diagnostic diagnostic = error({stage.at("two"), "second"});
    diagnostic.secondary = {{stage.at("one"), "first"}, {stage.at("three"), "third"}};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:5
  |
1 | one two three
  | --- ^^^ ----- third
  | |   |
  | |   second
  | first
)");
    diagnostic.secondary = {{stage.at("one"), ""}};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:5
  |
1 | one two three
  | --- ^^^ second
)");
    diagnostic.secondary = {{stage.at("one two three"), "around"}};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:5
  |
1 | one two three
  | ----^^^------ around
  |     |
  |     second
)");
}

TEST_CASE("a span over several lines is marked where it starts and where it ends")
{
    Stage stage{"a f(b,\n  c,\n  d) e\n"};
    CHECK(stage.draw(error({stage.at("f(b,\n  c,\n  d)"), "long"})) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:3
  |
1 | a f(b,
  |   ^^^^
...
3 |   d) e
  |   ^^ long
)");
    CHECK(stage.draw(error({stage.at("f(b,\n"), "to the end"})) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:3
  |
1 | a f(b,
  |   ^^^^ to the end
)");
}

TEST_CASE("tabs, wide characters and bytes that are no text keep the marks in place")
{
    Stage stage{"\ta\tbad\n\u4E2D\u00E4\u0301 bad\n\x01\xFF\u202E bad\n"};
    CHECK(stage.draw(error({stage.at("bad"), ""})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:1:4\n  |\n1 |     a   bad\n  |         ^^^\n");
    CHECK(stage.draw(error({stage.at("bad", 1), ""})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:2:5\n  |\n"
          "2 | \u4E2D\u00E4\u0301 bad\n  |     ^^^\n");
    CHECK(stage.draw(error({stage.at("bad", 2), ""})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:3:5\n  |\n"
          "3 | \uFFFD\uFFFD\uFFFD bad\n  |     ^^^\n");
}

TEST_CASE("lines that are too wide are cut around what is marked")
{
    Stage stage{std::string(500, 'a') + " bad " + std::string(500, 'b') + "\n"};
    CHECK(stage.draw(error({stage.at("bad"), "here"})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:1:502\n  |\n1 | ..." + std::string(29, 'a') +
              " bad " + std::string(106, 'b') + "...\n  | " + std::string(33, ' ') + "^^^ here\n");
    // A mark that is wider than the window is cut with it.
    const std::string all = stage.draw(error({{0, 0, 1005}, ""}));
    CHECK(all == "\nerror[E0501]: m\n --> models/cloth.lobe:1:1\n  |\n1 | " +
                     std::string(140, 'a') + "...\n  | " + std::string(140, '^') + "\n");
}

TEST_CASE("lines of any length are drawn alike")
{
    const std::string before = " 3456789\u00E4";  // 10 bytes, 9 characters
    std::string line;
    for (int i = 0; i < 5000; ++i) line += before;
    Stage stage{line + "bad" + line};
    Diagnostic diagnostic = error({stage.at("bad"), "here"});
    diagnostic.secondary = {{{0, 0, 1}, "far away"}};
    diagnostic.fix = Fix{stage.at("bad"), "good", "mend"};
    const std::string left = "...89\u00E4" + before + before + before;
    const std::string drawn = stage.draw(diagnostic);
    CAPTURE(drawn);
    CHECK(drawn.find(left + "bad" + before) != std::string::npos);
    CHECK(drawn.find(left + "good" + before) != std::string::npos);
    CHECK(drawn.find("^^^ here\n  | |\n  | far away\n") != std::string::npos);
    CHECK(drawn.find("~~~~\n") != std::string::npos);
    std::size_t at = 0;
    for (std::size_t end = 0; (end = drawn.find('\n', at)) != std::string::npos; at = end + 1)
        CHECK(end - at < 200);
}

TEST_CASE("a place at the end of the file can be marked")
{
    Stage ended{"one\n"};
    CHECK(ended.draw(error({{0, 4, 4}, "here"})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:2:1\n  |\n2 |\n  | ^ here\n");
    Stage open{"one"};
    CHECK(open.draw(error({{0, 3, 3}, "here"})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:1:4\n  |\n1 | one\n  |    ^ here\n");
    CHECK(open.draw(error({{0, 999, 2000}, "here"})) ==
          "\nerror[E0501]: m\n --> models/cloth.lobe:1:4\n  |\n1 | one\n  |    ^ here\n");
}

TEST_CASE("what is about a whole file shows no line, and what is about none no place")
{
    Stage stage{"one\n"};
    CHECK(stage.draw(error({{0, 0, 0}, ""})) == "\nerror[E0501]: m\n --> models/cloth.lobe\n");
    CHECK(stage.draw(error({{7, 0, 0}, ""})) == "\nerror[E0501]: m\n");
}

TEST_CASE("labels in another file follow under its own place")
{
    Stage stage{"one two\n"};
    stage.sources.add("models/other.lobe", "\nthere\n");
    Diagnostic diagnostic = error({stage.at("two"), "here"});
    diagnostic.secondary = {{{1, 1, 6}, "and there"}};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: m
 --> models/cloth.lobe:1:5
  |
1 | one two
  |     ^^^ here
 ::: models/other.lobe:2:1
  |
2 | there
  | ----- and there
)");
}

TEST_CASE("the gutter is as wide as the largest number, and notes of several lines are indented")
{
    Stage stage{"1\n2\n3\n4\n5\n6\n7\n8\n9\nten\n"};
    Diagnostic diagnostic = error({stage.at("ten"), ""});
    diagnostic.secondary = {{stage.at("9"), ""}};
    diagnostic.notes = {"first\nsecond"};
    diagnostic.helps = {"do this"};
    diagnostic.fix = Fix{stage.at("9\nten"), "nine", "join them"};
    CHECK(stage.draw(diagnostic) == R"(
error[E0501]: m
  --> models/cloth.lobe:10:1
   |
 9 | 9
   | -
10 | ten
   | ^^^
   = note: first
           second
   = help: do this
   = help: join them
 9 | nine
   | ~~~~
)");
}

TEST_CASE("fixes insert, remove and write several lines")
{
    Stage stage{"a b\n"};
    Diagnostic diagnostic = error({stage.at("b"), ""});
    const std::string head =
        "\nerror[E0501]: m\n --> models/cloth.lobe:1:3\n  |\n1 | a b\n  |   ^\n";
    diagnostic.fix = Fix{{0, 2, 2}, "let ", "declare it"};
    CHECK(stage.draw(diagnostic) == head + "  = help: declare it\n1 | a let b\n  |   ~~~~\n");
    diagnostic.fix = Fix{{0, 1, 3}, "", "remove it"};
    CHECK(stage.draw(diagnostic) == head + "  = help: remove it\n1 | a\n");
    diagnostic.fix = Fix{{0, 2, 3}, "x\n  y", "split it"};
    CHECK(stage.draw(diagnostic) ==
          head + "  = help: split it\n1 | a x\n  |   ~\n2 |   y\n  | ~~~\n");
}

TEST_CASE("color changes nothing but the color")
{
    Stage stage{"one two\n"};
    Diagnostic diagnostic = error({stage.at("two"), "here"});
    diagnostic.secondary = {{stage.at("one"), "there"}};
    diagnostic.fix = Fix{stage.at("one"), "1", "count"};
    const std::string plain = stage.draw(diagnostic);
    const std::string colored = stage.draw(diagnostic, true);
    CHECK(colored.find("\x1b[1;31merror[E0501]\x1b[0m") != std::string::npos);
    std::string stripped;
    for (std::size_t i = 0; i < colored.size(); ++i) {
        if (colored[i] == '\x1b')
            i = colored.find('m', i);
        else
            stripped += colored[i];
    }
    CHECK(stripped == plain);
}

TEST_CASE("several diagnostics stand apart and are counted")
{
    Stage stage{"one two\n"};
    stage.diagnostics.report(error({stage.at("two"), ""}));
    stage.diagnostics.report(
        {.code = Code::unused_name, .message = "w", .primary = {stage.at("one"), ""}});
    CHECK(render_text(stage.sources, stage.diagnostics) ==
          "warning[W0301]: w\n --> models/cloth.lobe:1:1\n  |\n1 | one two\n  | ^^^\n\n"
          "error[E0501]: m\n --> models/cloth.lobe:1:5\n  |\n1 | one two\n  |     ^^^\n");
    CHECK(render_short(stage.sources, stage.diagnostics) ==
          "models/cloth.lobe:1:1: warning[W0301]: w\nmodels/cloth.lobe:1:5: error[E0501]: m\n");
    CHECK(render_count(stage.diagnostics) == "1 error, 1 warning");
    stage.diagnostics.report(error({stage.at("two"), ""}));
    CHECK(render_count(stage.diagnostics) == "2 errors, 1 warning");
    CHECK(render_count({}) == "");
    CHECK(render_text(stage.sources, {}) == "");
}
