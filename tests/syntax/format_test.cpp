// Canonical text: it means what was written, it stays as it is, and it loses no comment.
#include "syntax/format.h"
#include "syntax/meaning.h"
#include "syntax/random_tree.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::comments;
using lobe::tests::meaning;
using lobe::tests::parsed;

namespace {

std::string formatted(const std::string& text)
{
    const auto result = parsed(text);
    return result.diagnostics.has_errors() ? codes(result.diagnostics) : format(result.tree);
}

std::string formatted_value(std::string_view value)
{
    const std::string text = formatted(fmt::format("module m\nterm t() = {}\n", value));
    const std::string head = "module m\nterm t() = ";
    return text.starts_with(head) ? text.substr(head.size(), text.size() - head.size() - 1) : text;
}

}  // namespace

TEST_CASE("expressions keep the parentheses that they need")
{
    for (const char* canonical : {"a + b * c",
                                  "(a + b) * c",
                                  "a - (b - c)",
                                  "a / (b * c)",
                                  "-x^2",
                                  "(-x)^2",
                                  "(a^b)^c",
                                  "a^b^c",
                                  "2^-x",
                                  "2^(-x * y)",
                                  "-(-x)",
                                  "-(a + b)",
                                  "a - -b",
                                  "(a < b) == c",
                                  "not (a and b)",
                                  "not a < b",
                                  "(a or b) and c",
                                  "a or b and c",
                                  "(if a then b else c) + 1",
                                  "if a then b else if c then d else e",
                                  "if a then (if b then c else d) else e",
                                  "f(a / b else 0)",
                                  "(a / b else 0) + c",
                                  "if a then (b / c else d) else e",
                                  "a / b else (c / d else e)",
                                  "a / b else -1",
                                  "f(x).y",
                                  "(a + b).x",
                                  "(2).x",
                                  "1/4096",
                                  "pi/2",
                                  "2 * 1/3",
                                  "a / 2",
                                  "-(x^2)",
                                  "2 * sum i in 0 .. 3 { i^2 } / 4",
                                  "(sum i in 0 .. n + 1 { i })^2",
                                  "(sum i in 0 .. 3 { v }).x",
                                  "-sum i in -1 .. 3 { sum j in 0 .. 1 { i * j } }",
                                  "2^sum i in 0 .. 3 { i }",
                                  "sum i in (if a then b else c) .. (d < e) { if a then b else c }",
                                  "f(sum i in 0 .. 3 { -i }, a)"}) {
        CAPTURE(canonical);
        CHECK(formatted_value(canonical) ==
              (std::string_view{canonical} == "2 * 1/3" ? "2 * 1 / 3" : std::string{canonical}));
    }
    CHECK(formatted_value("((a))+(b*c)") == "a + b * c");
    CHECK(formatted_value("(a*b)/c") == "a * b / c");
    CHECK(formatted_value("(f)(x)") == "E0201");
    CHECK(formatted_value("a/b else c*d") == "(a / b else c) * d");
    CHECK(formatted_value("--x") == "-(-x)");
    CHECK(formatted_value("a ^ ( b ^ c )") == "a^b^c");
}

TEST_CASE("a file has one way to be written")
{
    CHECK(formatted(R"(//header
module   m
import n {a,b}


param a:float in [0,1]=1/2 base "A"
/// doc
param longer : color=(1,0.5,0) advanced "B"   // note
param none:unit=1

term f( x :unit )->unit=x
    form q = x
model d(g:geometry){
let k=1

a=k
longer=k }
)") == R"(// header
module m
import n { a, b }

param a : float in [0, 1] = 1/2     base      "A"
/// doc
param longer : color = (1, 0.5, 0)  advanced  "B"  // note
param none : unit = 1

term f(x: unit) -> unit = x
  form q = x
model d(g: geometry) {
  let k = 1

  a      = k
  longer = k
}
)");
}

TEST_CASE("long lines break before operators and after commas")
{
    const std::string a(30, 'a');
    const std::string b(30, 'b');
    const std::string c(30, 'c');
    CHECK(formatted(fmt::format("module m\nterm t() = {} + {} * {}\n", a, b, c)) ==
          fmt::format("module m\nterm t() =\n  {} + {} * {}\n", a, b, c));
    CHECK(formatted(fmt::format("module m\nterm t() = {} + {} * {} - {}\n", a, b, c, a)) ==
          fmt::format("module m\nterm t() =\n  {}\n    + {} * {}\n    - {}\n", a, b, c, a));
    CHECK(formatted(fmt::format("module m\nterm t() = f({}, {}, {}, {})\n", a, b, c, a)) ==
          fmt::format("module m\nterm t() =\n  f(\n    {},\n    {},\n    {},\n    {}\n  )\n", a, b,
                      c, a));
    CHECK(formatted(fmt::format("module m\nterm t() = if {} then {} else {}*{}\n", a, b, c, a)) ==
          fmt::format("module m\nterm t() =\n  if {}\n  then {}\n  else {} * {}\n", a, b, c, a));
    CHECK(formatted(fmt::format("module m\nterm t({}: x, {}: y, {}: z) -> unit = 1\n", a, b, c)) ==
          fmt::format("module m\nterm t(\n  {}: x,\n  {}: y,\n  {}: z\n) -> unit = 1\n", a, b, c));
}

TEST_CASE("a sum with locals or comments is a block of lines")
{
    CHECK(formatted(R"(module m
term t() {
  let a = 2*sum i in 0..3 {let b=i let c=b
    c^2}
  let d = sum i in 0..3 { // inside
     // of b
     let b = i  // behind b


     let e = sum j in 0 .. 1 {   let f=j*b
        (-f)}
     // the value
     (-b*e)
  }
  sum i in 1..2 { let z = i
  ( z ) }
}
term u() = sum i in 0..3 { let b=i b}
term w() = sum i in 0 .. 3 { a_name_that_is_so_long + another_name_that_is_long * 2 + quite_a_long_name }
)") == R"(module m
term t() {
  let a = 2 * sum i in 0 .. 3 {
    let b = i
    let c = b
    c^2
  }
  let d = sum i in 0 .. 3 {
    // inside
    // of b
    let b = i  // behind b

    let e = sum j in 0 .. 1 {
      let f = j * b
      (-f)
    }
    // the value
    (-b * e)
  }
  sum i in 1 .. 2 {
    let z = i
    z
  }
}
term u() = sum i in 0 .. 3 {
  let b = i
  b
}
term w() = sum i in 0 .. 3 {
  a_name_that_is_so_long + another_name_that_is_long * 2 + quite_a_long_name
}
)");
}

TEST_CASE("a value that starts with a minus does not join the line before it")
{
    const std::string text = "module m\nterm t() {\n  let a = b\n  (-a)\n}\n";
    CHECK(formatted(text) == text);
    CHECK(formatted("module m\nterm t() {\n  (-a)\n}\n") == "module m\nterm t() {\n  -a\n}\n");
}

TEST_CASE("random trees survive format and parse")
{
    const auto seed = GENERATE(range(1U, 1501U));
    CAPTURE(seed);
    std::mt19937 random{seed};
    const Tree tree = tests::random_tree(random, 1 + static_cast<int>(seed % 6));
    const std::string text = format(tree);
    CAPTURE(text);

    const auto again = parsed(text);
    REQUIRE(codes(again.diagnostics) == "");
    CHECK(meaning(again.tree) == meaning(tree));
    CHECK(comments(again.tree) == comments(tree));
    CHECK(format(again.tree) == text);
    CHECK(text.find(" \n") == std::string::npos);
    CHECK(text.find("\n\n\n") == std::string::npos);
}

TEST_CASE("the models survive format and parse")
{
    for (const char* name : {"microfacet", "callisto", "ue4", "ue4_gbuffer", "environment"}) {
        CAPTURE(name);
        std::ifstream file(fmt::format("../models/{}.lobe", name));
        std::stringstream text;
        text << file.rdbuf();
        const auto first = parsed(text.str());
        REQUIRE(codes(first.diagnostics) == "");
        const std::string canonical = format(first.tree);
        const auto second = parsed(canonical);
        REQUIRE(codes(second.diagnostics) == "");
        CHECK(meaning(second.tree) == meaning(first.tree));
        CHECK(comments(second.tree) == comments(first.tree));
        CHECK(format(second.tree) == canonical);

        std::istringstream lines{canonical};
        for (std::string line; std::getline(lines, line);)
            if (line.find("//") == std::string::npos && line.find('"') == std::string::npos)
                CHECK(line.size() <= 100);
    }
}
