// What a text means: precedence, every item, and where comments belong.
#include "syntax/meaning.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::expression;
using lobe::tests::meaning;
using lobe::tests::parsed;

TEST_CASE("operators bind as mathematics has it")
{
    CHECK(expression("a + b * c") == "(+ a (* b c))");
    CHECK(expression("a - b - c") == "(- (- a b) c)");
    CHECK(expression("a / b / c") == "(/ (/ a b) c)");
    CHECK(expression("a / b * c") == "(* (/ a b) c)");
    CHECK(expression("-x^2") == "(neg (^ x 2))");
    CHECK(expression("(-x)^2") == "(^ (neg x) 2)");
    CHECK(expression("a^b^c") == "(^ a (^ b c))");
    CHECK(expression("2^-x") == "(^ 2 (neg x))");
    CHECK(expression("2^-x^y") == "(^ 2 (neg (^ x y)))");
    CHECK(expression("2^-x * y") == "(* (^ 2 (neg x)) y)");
    CHECK(expression("a * -b") == "(* a (neg b))");
    CHECK(expression("a - -b") == "(- a (neg b))");
    CHECK(expression("--a") == "(neg (neg a))");
    CHECK(expression("g.cos_h^2") == "(^ (. g cos_h) 2)");
    CHECK(expression("f(a, b + c).x") == "(. (call f a (+ b c)) x)");
    CHECK(expression("f()") == "(call f)");
}

TEST_CASE("words bind more loosely than comparisons, and comparisons than sums")
{
    CHECK(expression("a + 1 < b and c or not d == e") ==
          "(or (and (< (+ a 1) b) c) (not (== d e)))");
    CHECK(expression("a or b and c") == "(or a (and b c))");
    CHECK(expression("not not a") == "(not (not a))");
    CHECK(expression("if a < b then c else d + 1") == "(if (< a b) c (+ d 1))");
    CHECK(expression("if a then b else if c then d else e") == "(if a b (if c d e))");
    CHECK(expression("1 + (if a then b else c)") == "(+ 1 (if a b c))");
}

TEST_CASE("an else after a divisor is the division's limit")
{
    CHECK(expression("a / b else 0") == "(/ a b else 0)");
    CHECK(expression("a / b else c * d") == "(* (/ a b else c) d)");
    CHECK(expression("a / b else -1 + d") == "(+ (/ a b else (neg 1)) d)");
    CHECK(expression("a / b else c / d else e") == "(/ (/ a b else c) d else e)");
    CHECK(expression("a / b^2 else c^2") == "(/ a (^ b 2) else (^ c 2))");
    CHECK(expression("a * b / c else d") == "(/ (* a b) c else d)");
    CHECK(expression("f(a / b else c, d)") == "(call f (/ a b else c) d)");
}

TEST_CASE("inside then, an else belongs to the if")
{
    CHECK(expression("if c then a / b else d") == "(if c (/ a b) d)");
    CHECK(expression("if c then (a / b else 0) else d") == "(if c (/ a b else 0) d)");
    CHECK(expression("if c then f(a / b else 0) else d") == "(if c (call f (/ a b else 0)) d)");
    CHECK(expression("if a / b else 0 > 1 then c else d / e else 0") ==
          "(if (> (/ a b else 0) 1) c (/ d e else 0))");
    CHECK(expression("if a then if b then c else d / e else f") == "(if a (if b c (/ d e)) f)");
}

TEST_CASE("a sum has an index, two ends and a block")
{
    CHECK(expression("sum i in 0 .. 3 { i^2 }") == "(sum i 0 3 {(^ i 2)})");
    CHECK(expression("sum i in -1..2*3 { let a = i let b = a a - b }") ==
          "(sum i (neg 1) (* 2 3) {let a i; let b a; (- a b)})");
    CHECK(expression("2 * sum i in 0 .. 3 { i } / 4") == "(/ (* 2 (sum i 0 3 {i})) 4)");
    CHECK(expression("(sum i in 0 .. 3 { i })^2 + sum j in 1 .. 2 { sum k in 3 .. 4 { j * k } }") ==
          "(+ (^ (sum i 0 3 {i}) 2) (sum j 1 2 {(sum k 3 4 {(* j k)})}))");
    CHECK(expression("if a then sum i in 1 .. 2 { b / i else 0 } else c") ==
          "(if a (sum i 1 2 {(/ b i else 0)}) c)");
    CHECK(expression("f(sum i in 0 .. 1 { i }, sum)") == "(call f (sum i 0 1 {i}) sum)");
    // Anywhere else `sum` is a name like any other.
    CHECK(expression("sum + sum(sum) * sum.sum") == "(+ sum (* (call sum sum) (. sum sum)))");
    const auto names = parsed("module m\ntier in\nparam p : unit = sum in \"L\"\n"
                              "term sum(sum: unit) {\n let in = sum\n in\n}\n");
    CHECK(codes(names.diagnostics) == "");
}

TEST_CASE("line breaks do not matter, except before an opening parenthesis")
{
    CHECK(expression("a\n  + b\n  * c") == "(+ a (* b c))");
    CHECK(expression("f(\n  a,\n  b\n)") == "(call f a b)");
    CHECK(expression("g\n  .cos_i") == "(. g cos_i)");
    const auto block = parsed("module m\nterm t() -> float {\n let a = b\n (c)\n}\n");
    CHECK(meaning(block.tree) == "module m\nterm t () -> float = {let a b; c}\n");
}

TEST_CASE("every item is read")
{
    const auto result = parsed(R"(// The header.
module callisto
import microfacet { D_GGX, V_SmithGGX }
source slides = "A \"title\", 2023"
tier base, advanced
/// Gain.
/// slides 85
param gain : float in [-1, 2^3] = 1/2  base  "Gain"
param tint : color = (1, 0.5, 0) advanced
param bare : unit = 0.5
param grouped : float = (1 + 2) * 3 "Grouped"
term f(x: unit, g: geometry) -> color in [0, 1] = x
  /// Karis
  form fast = x * 2
  form faster {
    let y = x
    y
  }
term no_result() = 1
effect "Gain" off when gain == 1
model m(g: geometry, s: surface) {
  let k = 2
  diffuse = k
  specular = f(k, g)
}
)");
    CHECK(codes(result.diagnostics) == "");
    CHECK(meaning(result.tree) == R"(module callisto
import microfacet D_GGX,V_SmithGGX,
source slides "A \"title\", 2023"
tier base,advanced,
Gain.
slides 85param gain float[(neg 1) (^ 2 3)] = (/ 1 2) tier base label "Gain"
param tint color = 1 0.5 0 tier advanced
param bare unit = 0.5
param grouped float = (* (+ 1 2) 3) label "Grouped"
term f (x:unit g:geometry ) -> color[0 1] = x form Karis fast = (* x 2) form  faster = {let y x; y}
term no_result () -> ? = 1
effect "Gain" (== gain 1)
model m (g:geometry s:surface ) let k 2; diffuse = k; specular = (call f k g); 
)");
}

TEST_CASE("words of the grammar are names wherever they can be")
{
    CHECK(expression("term + form * in - off") == "(- (+ term (* form in)) off)");
    CHECK(expression("source(model, tier).param") == "(. (call source model tier) param)");
    const auto lines = parsed("module m\nterm f(source: unit) =\n  source\nterm g() = 1\n");
    CHECK(codes(lines.diagnostics) == "");
    CHECK(lines.tree.items.size() == 2);
    const auto result = parsed("module module\nparam param : in = term term \"x\"\n"
                               "term when() -> form {\n let off = when\n tier\n}\n");
    CHECK(codes(result.diagnostics) == "");
    CHECK(meaning(result.tree) == "module module\nparam param in = term tier term label \"x\"\n"
                                  "term when () -> form = {let off when; tier}\n");
}

TEST_CASE("spans cover what was written")
{
    const auto result = parsed("module m\nterm t() -> float = (a + b) * f(c) / d else 0\n");
    const auto& term = std::get<TermItem>(result.tree.items.at(0).node);
    const auto text = [&](ExpressionId id) { return result.sources.text(result.tree[id].span); };
    CHECK(text(term.body.value) == "(a + b) * f(c) / d else 0");
    const auto& division = std::get<Binary>(result.tree[term.body.value].node);
    CHECK(text(division.left) == "(a + b) * f(c)");
    CHECK(result.sources.text(division.op_span) == "/");
    const auto& product = std::get<Binary>(result.tree[division.left].node);
    CHECK(text(product.left) == "a + b");
    CHECK(result.tree[product.left].parenthesized);
    CHECK(result.sources.text(result.tree.items[0].span) ==
          "term t() -> float = (a + b) * f(c) / d else 0");
}

TEST_CASE("spans name the source that was parsed")
{
    Sources sources;
    sources.add("first.lobe", "module first\n");
    const std::uint32_t index = sources.add("second.lobe", "module m\nterm t() = a @ b // c\n");
    Diagnostics diagnostics;
    const Tree tree = parse(sources, index, diagnostics);
    CHECK(tree.source == index);
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].primary.span.source == index);
    CHECK(tree.module->span.source == index);
    for (const Expression& expression : tree.expressions) CHECK(expression.span.source == index);
    CHECK(tree.items.at(0).span.source == index);
}

TEST_CASE("comments belong to what they stand before or behind")
{
    const auto result = parsed(R"(// header

/// about the module
module m

// loose

/// about t
term t() -> float {  // opening
  // before a
  let a = 1  // behind a

  // before the value
  a + // inside
    2
  // at the end
}  // behind t
  // before the form
  form q = 3 // behind q
// footer
)");
    CHECK(codes(result.diagnostics) == "");
    REQUIRE(result.tree.items.size() == 1);
    const Item& item = result.tree.items[0];
    const auto& term = std::get<TermItem>(item.node);
    const auto texts = [](const std::vector<Comment>& comments) {
        std::vector<std::string> all;
        for (const Comment& comment : comments) all.push_back(comment.text);
        return all;
    };
    using Texts = std::vector<std::string>;
    CHECK(texts(result.tree.header) == Texts{"header", "about the module"});
    CHECK(doc_text(item.comments) == "about t");
    CHECK(texts(item.comments) == Texts{"loose", "about t"});
    CHECK(texts(term.body.lets.at(0).comments) == Texts{"opening", "before a"});
    CHECK(texts(term.body.lets.at(0).trailing) == Texts{"behind a"});
    CHECK(texts(term.body.value_comments) == Texts{"before the value", "inside", "at the end"});
    CHECK(texts(term.body.trailing) == Texts{"behind t"});
    CHECK(texts(term.forms.at(0).comments) == Texts{"before the form"});
    CHECK(texts(term.forms.at(0).body.trailing) == Texts{"behind q"});
    CHECK(texts(result.tree.footer) == Texts{"footer"});
}
