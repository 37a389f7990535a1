// One mistake, one message; and what stands around it is read all the same.
#include "syntax/meaning.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::meaning;
using lobe::tests::parsed;

namespace {

/// The only message, with the text that it points at and the edit that it offers.
std::string only(const std::string& text)
{
    const auto result = parsed(text);
    if (result.diagnostics.all().size() != 1) return codes(result.diagnostics);
    const Diagnostic& diagnostic = result.diagnostics.all().front();
    return fmt::format("{} {} [{}]{}", id(diagnostic.code), diagnostic.message,
                       result.sources.text(diagnostic.primary.span),
                       diagnostic.fix ? " -> " + diagnostic.fix->replacement : "");
}

std::string in_term(const std::string& value)
{
    return only("module m\nterm t() = " + value + "\n");
}

std::string names(const Tree& tree)
{
    std::string result;
    for (const Item& item : tree.items)
        if (const auto* term = std::get_if<TermItem>(&item.node)) result += term->name.text + " ";
    return result;
}

}  // namespace

TEST_CASE("messages say what was seen and what was expected")
{
    CHECK(in_term("a +") == "E0201 expected an expression after `+` []");
    CHECK(in_term("a + )") == "E0201 expected an expression, found `)` [)]");
    CHECK(in_term("a b") == "E0201 expected the end of the declaration, found `b` [b]");
    CHECK(in_term("g.1") == "E0103 `.1` is not a number [.1] -> 0.1");
    CHECK(in_term("f(a,)") == "E0201 expected an argument, found `)` [)]");
    CHECK(in_term("f(a b)") == "E0201 expected `,` or `)`, found `b` [b]");
    CHECK(in_term("(a + b") == "E0202 this `(` is not closed [(]");
    CHECK(in_term("f(a]") == "E0202 this `(` is not closed [(]");
    CHECK(in_term("if a then b") == "E0201 expected `else` after `b` []");
    CHECK(in_term("if a = b then c else d") ==
          "E0201 `=` gives a name a value; it does not compare [=] -> ==");
    CHECK(in_term("1 + if a then b else c") ==
          "E0201 an `if` that is an operand stands in parentheses [if] -> (if a then b else c)");
    CHECK(in_term("a < b < c") == "E0207 comparisons do not chain [<] -> and b ");
    CHECK(in_term("a == (b != c)") == "");
    CHECK(in_term("a else b") ==
          "E0208 `else` names the limit of a division, and this is none [else]");
    CHECK(in_term("a / b else c else d") == "E0208 this division has a limit already [else]");
    CHECK(in_term("(a / b) else c") ==
          "E0208 `else` stands outside the division that it belongs to [else]");
    CHECK(in_term("\"text\"") == "E0201 expected an expression, found a text [\"text\"]");
}

TEST_CASE("a sum says what it is made of")
{
    CHECK(in_term("sum i in 0 { i }") == "E0201 expected `..` and the last number, found `{` [{]");
    CHECK(in_term("sum i = 0 .. 3 { i }") ==
          "E0201 expected `in` and two whole numbers, found `=` [=]");
    CHECK(in_term("sum i from 0 .. 3 { i }") ==
          "E0201 expected `in` and two whole numbers, found `from` [from]");
    CHECK(in_term("sum i 0 .. 3 { i }") ==
          "E0201 expected `in` and two whole numbers, found `0` [0]");
    CHECK(in_term("sum i in [0, 3] { i }") == "E0201 expected a whole number, found `[` [[]");
    CHECK(in_term("sum i in 0 .. 3 i") == "E0201 expected `{` and what is summed, found `i` [i]");
    CHECK(in_term("sum i in 0 .. 3 { }") == "E0201 this block has no value [}]");
    CHECK(in_term("sum i in 0 .. 3 { i") == "E0202 this `{` is not closed [{]");
    CHECK(in_term("sum i in 0 .. 3 { let a i }") ==
          "E0201 expected `=` and a value, found `i` [i]");
    CHECK(in_term("sum i in 0 .. 3 { a = i a }") ==
          "E0201 a name in a block is declared with `let` [a] -> let ");
    CHECK(in_term("0 .. 3") == "E0201 expected the end of the declaration, found `..` [..]");
    // A mistake in a line of it costs that line, and what stands around the sum is read.
    const auto two =
        parsed("module m\nterm t() = (sum i in 0 .. 3 {\n let a = *\n let b = )\n a + b\n"
               "}) * 2 +\nterm u() = 1\n");
    CHECK(codes(two.diagnostics) == "E0201 E0201 E0201");
    CHECK(names(two.tree) == "t u ");
}

TEST_CASE("items say what they are made of")
{
    CHECK(only("module m\nterm t = 1\n") == "E0201 expected `(` and the parameters, found `=` [=]");
    CHECK(only("module m\nterm t(x) = 1\n") == "E0201 expected `:` and a type, found `)` [)]");
    CHECK(only("module m\nterm t() 1\n") ==
          "E0201 expected `=` or `{` and the value, found `1` [1]");
    CHECK(only("module m\nparam p = 1\n") == "E0201 expected `:` and a type, found `=` [=]");
    CHECK(only("module m\nparam p : unit base\n") ==
          "E0201 expected `=` and the default, found `base` [base]");
    CHECK(only("module m\nparam p : unit in [0, 1 = 0.5\n") == "E0201 expected `]`, found `=` [=]");
    CHECK(only("module m\nimport n\nparam p : unit = 1\n") ==
          "E0201 expected `{` and the names to import after `n` []");
    CHECK(only("module m\nsource s \"t\"\n") ==
          "E0201 expected `=` and the title in double quotes, found a text [\"t\"]");
    CHECK(only("module m\neffect \"e\" of when a == 1\n") ==
          "E0201 expected `off when` and a condition, found `of` [of]");
    CHECK(only("module m\neffect \"e\" off whem a == 1\n") ==
          "E0201 expected `when` and a condition, found `whem` [whem] -> when");
    CHECK(only("module m\nmodel d(g: geometry) {\n  x = 1\n") ==
          "E0202 this `{` is not closed [{]");
    CHECK(only("module m\nterm t() {\n a = 1\n a\n}\n") ==
          "E0201 a name in a block is declared with `let` [a] -> let ");
    CHECK(only("module m\nterm t() {\n let a = 1\n}\n") == "E0201 this block has no value [}]");
    CHECK(only("module m\nterm t() {\n let a = b\n -a\n}\n") ==
          "E0201 this block has no value [}]");
    CHECK(only("module m\nterm t() {\n 1\n let a = b\n}\n") ==
          "E0204 `let` stands before the value of a block [let]");
}

TEST_CASE("what can only mean one thing is mended and read")
{
    const auto read = [](const std::string& item) {
        const auto result = parsed("module m\n" + item + "\n");
        const bool one = result.diagnostics.error_count() == 1;
        return one ? only("module m\n" + item + "\n") + " " + meaning(result.tree).substr(9)
                   : codes(result.diagnostics);
    };
    CHECK(read("term a(x: unit): unit = x") ==
          "E0201 the type of a result stands behind `->` [:] ->  -> "
          "term a (x:unit ) -> unit = x\n");
    CHECK(read("term a() => unit = x") ==
          "E0201 the type of a result stands behind `->` [=>] -> -> term a () -> unit = x\n");
    CHECK(read("term a() -> unit = { x }") ==
          "E0201 a block stands without `=` [= ] ->  term a () -> unit = {x}\n");
    CHECK(read("term a() {\n  return x + 1\n}") ==
          "E0201 the last line of a block is its value [return ] ->  "
          "term a () -> ? = {(+ x 1)}\n");
    CHECK(read("param p : unit = 1 \"P\" base") ==
          "E0204 the tier stands before the label [base] param p unit = 1 tier base label \"P\"\n");
}

TEST_CASE("habits of other languages get a hint")
{
    const auto help = [](const std::string& item) {
        const auto result = parsed("module m\n" + item + "\n");
        REQUIRE(result.diagnostics.all().size() == 1);
        REQUIRE(result.diagnostics.all()[0].helps.size() == 1);
        return result.diagnostics.all()[0].helps[0];
    };
    CHECK(help("term a(unit x) = x") == "a parameter is written `name: type`");
    CHECK(help("term a(x: unit = 1) = x") == "terms have no defaults; a `param` has one");
    CHECK(help("term a() -> float in (0, 1) = x") ==
          "a range holds its ends and is written `[low, high]`");
    CHECK(
        help("term a() -> float in [0..1] = x") ==
        "a range is written `[low, high]`; `..` stands between the bits of a channel and the ends "
        "of a sum");
    CHECK(help("term a() = let x = 1 in x") == "`let` stands in a block: `{ let y = x  y * y }`");
    CHECK(help("let x = 1") ==
          "a value that terms share is a `param`, or a `term` without parameters");
    CHECK(help("model d() {\n  output x = 1\n}") == "an output is written `name = value`");
    CHECK(only("module m\ntier a b") == "E0201 expected `,` between tiers, found `b` [b]");
    CHECK(only("module m\neffect a off when b") ==
          "E0201 expected the name of the effect in double quotes, found `a` [a]");
}

TEST_CASE("items stand in their order")
{
    CHECK(only("term t() = 1\n") == "E0204 a file starts with `module` and its name [term]");
    CHECK(only("modul m\nterm t() = 1\n") ==
          "E0204 a file starts with `module` and its name [modul] -> module");
    CHECK(only("module m\nmodule n\nterm t() = 1\n") ==
          "E0204 a file has one `module` line [module]");
    CHECK(only("module m\nterm t() = 1\nimport n { a }\n") ==
          "E0204 imports stand before other declarations [import]");
    CHECK(only("module m\nform f = 1\n") == "E0204 this form belongs to no term [form]");
    CHECK(only("module m\nmodel d() {\n x = 1\n let a = 2\n}\n") ==
          "E0204 `let` stands before the outputs [let]");
}

TEST_CASE("a misspelt item is taken for what was meant")
{
    const auto result = parsed("module m\ntem a() = 1\nparm p : unit = 1\nterm b() = a()\n");
    CHECK(codes(result.diagnostics) == "E0201 E0201");
    CHECK(result.diagnostics.all()[0].message == "unknown item `tem`; did you mean `term`?");
    CHECK(names(result.tree) == "a b ");
    CHECK(result.tree.items.size() == 3);
    CHECK(only("module m\nshader x() = 1\n") ==
          "E0201 expected a declaration, found `shader` [shader]");
}

TEST_CASE("doc comments document something")
{
    CHECK(only("module m\nterm t() = 1\n/// end\n") ==
          "E0205 this doc comment documents nothing [/// end]");
    CHECK(only("module m\nterm t() = 1 /// behind\n") ==
          "E0205 this doc comment documents nothing [/// behind]");
    CHECK(only("module m\nterm t() = 1 +\n /// inside\n 2\n") ==
          "E0205 this doc comment documents nothing [/// inside]");
    CHECK(only("module m\nmodel d() {\n x = 1\n /// last\n}\n") ==
          "E0205 this doc comment documents nothing [/// last]");
}

TEST_CASE("a mistake costs its declaration only")
{
    const auto result = parsed("module m\nterm a() = 1 +\nterm b() = (2\nterm c(x unit) = 3\n"
                               "  form f = 4\nterm d() = 5\n");
    CHECK(codes(result.diagnostics) == "E0201 E0202 E0201");
    CHECK(names(result.tree) == "a b c d ");
    CHECK(std::get<TermItem>(result.tree.items[2].node).forms.size() == 1);
}

TEST_CASE("a mistake in a model costs its output only")
{
    const auto result = parsed("module m\nmodel d(g: geometry) {\n  let a = *\n  x = (a\n"
                               "  y = 2 3\n  z = 4\n}\nterm t() = 1\n");
    CHECK(codes(result.diagnostics) == "E0201 E0202 E0201");
    const auto& model = std::get<ModelItem>(result.tree.items.at(0).node);
    CHECK(model.outputs.size() == 3);
    CHECK(model.outputs.back().name.text == "z");
    CHECK(names(result.tree) == "t ");
}

TEST_CASE("what forms no token is not reported twice")
{
    CHECK(in_term("a @ b") == "E0101 `@` is not part of the language [@]");
    CHECK(in_term("1.5f + .5") == "E0103 E0103");
    CHECK(in_term("\"abc") == "E0102 this text has no closing quote [\"abc] -> \"abc\"");
    CHECK(in_term("a && b") == "E0101 `&&` is not an operator [&&] -> and");
}

TEST_CASE("a file is given up after 20 errors")
{
    std::string text = "module m\n";
    for (int i = 0; i < 100; ++i) text += fmt::format("term t{}() = *\n", i);
    const auto result = parsed(text);
    CHECK(result.diagnostics.error_count() == 20);
    CHECK(result.diagnostics.all()[18].notes.empty());
    CHECK(result.diagnostics.all()[19].notes ==
          std::vector<std::string>{
              "this is error 20 of this file; what comes after it was not checked"});

    const auto tokens = parsed("module m\n" + [] {
        std::string lines;
        for (int i = 0; i < 100; ++i) lines += "term t() = a ? b\n";
        return lines;
    }());
    CHECK(tokens.diagnostics.error_count() == 20);
}
