// Long, deep and hostile programs: no overflow, no endless run, and a word about what was left out.
#include "check/checking.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using lobe::tests::check_text;

TEST_CASE("a chain of a thousand operators is lowered", "[check][limits]")
{
    std::string sum = "x";
    for (int i = 0; i < 1000; ++i) sum += " + x";
    const auto checked = check_text("/// f\nterm f(x: unit) = " + sum);
    CHECK(checked.errors() == "");
    CHECK(checked.function("f").range == ir::Range{0, 1001});
}

TEST_CASE("a chain of thousands of terms is ordered and proved", "[check][limits]")
{
    std::string text = "/// t0\nterm t0(x: unit) -> unit = x\n";
    const int count = 1000;
    // Declared callers first, so that every term is entered from the one before it.
    std::string reversed;
    for (int i = 1; i < count; ++i)
        reversed = fmt::format("/// t{}\nterm t{}(x: unit) -> unit = t{}(x) * x\n", i, i, i - 1) +
                   reversed;
    const auto checked = check_text(reversed + text);
    CHECK(checked.errors() == "");
    REQUIRE(checked.module);
    CHECK(checked.module->functions.size() == count);
    CHECK(checked.module->functions[0].name == "t0");
}

TEST_CASE("a cycle of thousands of terms is one message", "[check][limits]")
{
    std::string text;
    const int count = 3000;
    for (int i = 0; i < count; ++i)
        text += fmt::format("/// t\nterm t{}(x: unit) -> unit = t{}(x)\n", i, (i + 1) % count);
    CHECK(check_text(text).errors() == "E0306");
}

TEST_CASE("calls that multiply are refused before they are taken in", "[check][limits]")
{
    std::string text = "/// t0\nterm t0(x: unit) -> unit = x\n";
    for (int i = 1; i < 60; ++i)
        text += fmt::format("/// t\nterm t{}(x: unit) -> unit = t{}(x) * t{}(1 - x)\n", i, i - 1,
                            i - 1);
    CHECK(check_text(text).errors() == "E0511");
}

TEST_CASE("deeply nested conditions and locals are lowered", "[check][limits]")
{
    std::string nested = "x";
    for (int i = 0; i < 60; ++i) nested = fmt::format("if x > {} / 64 then {} else 0", i, nested);
    CHECK(check_text("/// f\nterm f(x: unit) -> unit = " + nested).errors() == "");

    std::string block = "/// f\nterm f(x: unit) -> float {\n  let a0 = x\n";
    for (int i = 1; i < 60; ++i)
        block += fmt::format("  let a{} = a{} * a{} + x\n", i, i - 1, i - 1);
    // Shared, this is 120 operations; the range grows without bound, and that is no error.
    CHECK(check_text(block + "  a59\n}").errors() == "");
}

TEST_CASE("twenty errors are shown, and the rest is counted", "[check][limits]")
{
    std::string text;
    for (int i = 0; i < 30; ++i)
        text += fmt::format("/// t\nterm t{}(x: unit) -> float = missing{}\n", i, i);
    const auto checked = check_text(text);
    CHECK(checked.diagnostics.error_count() == 20);
    const Diagnostic last = checked.diagnostics.sorted().back();
    REQUIRE(!last.notes.empty());
    CHECK(last.notes.back() == "this is error 20; 10 more are not shown");
}

TEST_CASE("half a program is checked without a crash", "[check][limits]")
{
    // Whatever prefix is read, it ends in messages, not in a crash.
    const std::string whole = "import lib { a }\nsource s = \"S\"\ntier base\n"
                              "param p : color in [0, 2] = (1, 1, 1) base \"P\"\n"
                              "/// f\n/// s 12\nterm f(g: geometry, x: unit) -> color in [0, 9] {\n"
                              "  let y = if x > 0 then p / x else a(x)\n  y * g.cos_i\n}\n"
                              "  form other = x * f(g, x)^2\n"
                              "effect \"E\" off when p == 1\n"
                              "model m(g: geometry, s: surface) {\n  let z = f(g, s.alpha)\n"
                              "  diffuse = z\n  specular = z * s.f0\n}\n";
    for (std::size_t length = 0; length <= whole.size(); ++length) {
        Sources sources;
        Diagnostics diagnostics;
        const auto root = sources.add("m.lobe", "module m\n" + whole.substr(0, length));
        const auto module = check::check(sources, root, {}, diagnostics);
        CHECK(module.has_value() == !diagnostics.has_errors());
    }
}
