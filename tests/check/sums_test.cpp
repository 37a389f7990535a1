// Sums mean the terms that they stand for: the same graph as if those had been written out.
#include "check/checking.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using lobe::tests::check_text;

namespace {

/// An expression, its operands in parentheses.
std::string text_of(const ir::Graph& graph, ir::ExprId id)
{
    if (graph[id].op == ir::Op::literal) return graph.literal_of(id).text;
    std::string result = fmt::format("({}:{}", ir::name(graph[id].op), graph[id].aux);
    for (const ir::ExprId operand : graph.operands(id)) result += " " + text_of(graph, operand);
    return result + ")";
}

/// What a body means.
std::string graph_of(const std::string& body)
{
    const auto checked =
        check_text("/// f\nterm f(x: unit, y: float in [0, 10], c: color, v: direction) = " + body);
    CAPTURE(body, checked.errors());
    const ir::Function& function = checked.function("f");
    return text_of(function.graph, function.result);
}

std::string errors(const std::string& body)
{
    return check_text("/// f\nterm f(x: unit, y: float in [0, 10], c: color) = " + body).errors();
}

std::string warnings(const std::string& body)
{
    return check_text("/// f\nterm f(x: unit, y: float in [0, 10], c: color) = " + body).warnings();
}

}  // namespace

TEST_CASE("a sum is its terms, added from the first to the last", "[check][sum]")
{
    CHECK(graph_of("sum i in 0 .. 3 { x * i }") == graph_of("x * 0 + x * 1 + x * 2 + x * 3"));
    CHECK(graph_of("sum i in 2 .. 2 { x * i }") == graph_of("x * 2"));
    CHECK(graph_of("sum i in -2 .. 1 { x^2 + i }") ==
          graph_of("(x^2 + -2) + (x^2 + -1) + (x^2 + 0) + (x^2 + 1)"));
    CHECK(graph_of("sum i in 2^2 - 3 .. 6/2 { i + y }") == graph_of("(1 + y) + (2 + y) + (3 + y)"));
    CHECK(graph_of("2 * sum i in 0 .. 1 { x + i } - y") == graph_of("2 * ((x + 0) + (x + 1)) - y"));
    CHECK(errors("sum i in 1 .. 2 { sum j in i .. 4 { x * i + j } }") == "E0508");
}

TEST_CASE("sums stand in sums", "[check][sum]")
{
    CHECK(graph_of("sum i in 1 .. 2 { y * sum j in 3 .. 4 { x * i + j } }") ==
          graph_of("y * ((x * 1 + 3) + (x * 1 + 4)) + y * ((x * 2 + 3) + (x * 2 + 4))"));
    CHECK(graph_of("(sum i in 0 .. 1 { x + i }) * (sum i in 1 .. 2 { y + i })") ==
          graph_of("((x + 0) + (x + 1)) * ((y + 1) + (y + 2))"));
}

TEST_CASE("an index is a whole number", "[check][sum]")
{
    // A whole literal exponent: no base is too small for it.
    CHECK(graph_of("sum i in 0 .. 2 { (x - 1)^i }") ==
          graph_of("(x - 1)^0 + (x - 1)^1 + (x - 1)^2"));
    CHECK(graph_of("sum i in 1 .. 2 { (x + 1)^-i }") == graph_of("(x + 1)^-1 + (x + 1)^-2"));
    const auto quantity = [](const std::string& body) {
        return check_text("/// f\nterm f() = " + body).function("f").quantity;
    };
    CHECK(quantity("sum i in 0 .. 3 { i * i }") == ir::Quantity::integer);
    CHECK(quantity("sum i in 0 .. 3 { i / 2 }") == ir::Quantity::number);
    CHECK(quantity("sum i in 0 .. 3 { 2^-i }") == ir::Quantity::number);
}

TEST_CASE("colors and vectors are summed, too", "[check][sum]")
{
    CHECK(graph_of("sum i in 1 .. 2 { c * i }") == graph_of("c * 1 + c * 2"));
    CHECK(graph_of("sum i in 1 .. 2 { v * i }") == graph_of("v * 1 + v * 2"));
    const auto quantity = [](const std::string& body) {
        return check_text("/// f\nterm f(v: direction) = " + body).function("f").quantity;
    };
    CHECK(quantity("sum i in 1 .. 2 { if i > 1 then v else -v }") == ir::Quantity::vector);
    CHECK(quantity("sum i in 1 .. 1 { if i > 1 then v else -v }") == ir::Quantity::vector);
    CHECK(errors("sum i in 0 .. 3 { x < i }") == "E0401");
}

TEST_CASE("names of a sum end with it and hide nothing", "[check][sum]")
{
    const auto block = [](const std::string& body) {
        return check_text("/// f\nterm f(x: unit) -> float {\n" + body + "\n}").errors();
    };
    CHECK(block("let a = sum i in 0 .. 1 { let t = x + i\n t }\nlet t = a\nt * t") == "");
    CHECK(block("let a = sum i in 0 .. 1 { x + i }\na + i") == "E0301");
    CHECK(block("let a = sum i in 0 .. 1 { let t = i\n t + x }\na + t") == "E0301");
    CHECK(block("let i = x\nsum i in 0 .. 1 { i } + i") == "E0302");
    CHECK(block("sum i in 0 .. 1 { sum i in 0 .. 1 { x + i } }") == "E0302");
    CHECK(block("sum i in 0 .. 1 { let x = i\n x }") == "E0302");
    CHECK(block("sum pi in 0 .. 1 { pi * x }") == "E0310");
}

TEST_CASE("what is wrong with a term is said once", "[check][sum]")
{
    CHECK(errors("sum i in 0 .. 9 { nothing + i }") == "E0301");
    CHECK(errors("sum i in 0 .. 9 { sum j in 0 .. 9 { 1 / (x - i * j) } }") == "E0501");
    CHECK(errors("sum i in 0 .. 9 { 1 / (x + i) }") == "E0501");
    CHECK(errors("sum i in 1 .. 9 { 1 / (x + i) }") == "");
    CHECK(errors("sum i in 0 .. 1 { 1 / x + sqrt(x - i) }") == "E0501 E0502");
    CHECK(warnings("sum i in 0 .. 9 { let t = i\n x * 2 + i }") == "W0301");
    CHECK(warnings("sum i in 0 .. 9 { x }") == "W0301");
    // One term needs its limit.
    CHECK(warnings("sum i in 0 .. 9 { 1 / (x + i) else 0 }") == "");
    CHECK(warnings("sum i in 1 .. 9 { 1 / (x + i) else 0 }") == "W0501");
}

TEST_CASE("an arm's condition is known in its sums", "[check][sum]")
{
    CHECK(errors("if x > 0 then sum i in 1 .. 4 { i / x } else 0") == "");
    CHECK(errors("if x > 0 then sum i in 1 .. 4 { sum j in 0 .. 1 { (i + j) / x } } else 0") == "");
    CHECK(errors("sum i in 0 .. 4 { if y > i then 1 / y else 0 }") == "");
    CHECK(errors("sum i in -1 .. 4 { if y > i then 1 / y else 0 }") == "E0501");
}

TEST_CASE("terms called in a sum are checked first", "[check][sum]")
{
    const auto checked = check_text("/// f\nterm f(x: unit) = sum i in 0 .. 3 { let t = a(x)\n"
                                    "b(t) * i }\n/// a\nterm a(x: unit) -> unit = x^2\n"
                                    "/// b\nterm b(x: unit) -> unit = 1 - x\n");
    CHECK(checked.errors() == "");
    CHECK(check_text("/// f\nterm f(x: unit) = sum i in 0 .. 3 { f(x) * i }").errors() == "E0306");
}

TEST_CASE("a sum has whole ends and a bounded length", "[check][sum]")
{
    CHECK(errors("sum i in 0.5 .. 3 { x * i }") == "E0508");
    CHECK(errors("sum i in 0 .. x { x * i }") == "E0508");
    CHECK(errors("sum i in 3 .. 2 { x * i }") == "E0505");
    CHECK(errors("sum i in 0 .. 1e30 { x * i }") == "E0508");
    CHECK(errors("sum i in 0 .. 1e6 { x * i }") == "E0512");
    CHECK(errors("sum i in 0 .. 999 { sum j in 0 .. 999 { x * i * j } }") == "E0512");
    CHECK(errors("sum i in 0 .. 999 { x * i } + sum i in 0 .. 1e6 { x * i }") == "E0512");
    CHECK(errors("sum i in 0 .. 999 { x * i }") == "");
}
