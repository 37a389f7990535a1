// Literals are decimals, and are folded as on paper.
#include "build.h"
#include "optimize/decimal.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;

namespace {

/// The text of what an operation on literals becomes; empty where it stays.
std::string folded(Op op, std::initializer_list<const char*> texts)
{
    Term term{"f"};
    std::vector<ExprId> operands;
    for (const char* text : texts) operands.push_back(term.number(text));
    const ExprId result = term.function.graph.apply(op, std::span{operands});
    const Module module = optimize::fold_decimals(only(term, result));
    const Function& function = module.functions[0];
    if (function.graph[function.result].op != Op::literal) return "";
    return function.graph.literal_of(function.result).text;
}

}  // namespace

TEST_CASE("sums, differences and products of decimals are exact")
{
    CHECK(folded(Op::add, {"0.1", "0.2"}) == "0.3");
    CHECK(folded(Op::add, {"1e-7", "1"}) == "1.0000001");
    CHECK(folded(Op::subtract, {"1", "0.7"}) == "0.3");
    CHECK(folded(Op::subtract, {"0.3", "0.3"}) == "0");
    CHECK(folded(Op::multiply, {"0.1", "10"}) == "1");
    CHECK(folded(Op::multiply, {"-0.3", "0.7"}) == "-0.21");
    CHECK(folded(Op::negate, {"0.1"}) == "-0.1");
    CHECK(folded(Op::lerp, {"0.1", "0.3", "0.5"}) == "0.2");
}

TEST_CASE("quotients fold where they end, powers where they are whole")
{
    CHECK(folded(Op::divide, {"0.3", "0.1"}) == "3");
    CHECK(folded(Op::divide, {"1", "8"}) == "0.125");
    CHECK(folded(Op::divide, {"1", "3"}).empty());
    CHECK(folded(Op::divide, {"1", "0"}).empty());
    CHECK(folded(Op::guarded_power, {"0.7", "2"}) == "0.49");
    CHECK(folded(Op::power, {"0.7", "0.5"}).empty());
    CHECK(folded(Op::power, {"0.7", "-1"}).empty());
}

TEST_CASE("what has too many digits stays, and so does what is no decimal")
{
    CHECK(folded(Op::multiply, {"0.1234567891", "0.1234567891"}).empty());
    CHECK(folded(Op::add, {"1e20", "1e-20"}).empty());
    CHECK(folded(Op::multiply, {"123456789012345678", "1"}).empty());
    CHECK(folded(Op::multiply, {"2", "pi"}).empty());
    CHECK(folded(Op::square_root, {"4"}).empty());
}

TEST_CASE("vectors fold by component, and through what was folded before")
{
    Term term{"f"};
    Graph& graph = term.function.graph;
    const std::vector<ExprId> tint{term.number("0.1"), term.number("0.2"), term.number("0.7")};
    const ExprId vector = graph.construct(Type::vec3, tint);
    const ExprId one_minus = term.subtract(term.number("1"), vector);
    const Module module =
        optimize::fold_decimals(only(term, term.multiply(one_minus, term.number("10"))));
    const Function& function = module.functions[0];
    REQUIRE(function.graph[function.result].op == Op::construct);
    std::vector<std::string> texts;
    for (const ExprId part : function.graph.operands(function.result))
        texts.push_back(function.graph.literal_of(part).text);
    CHECK(texts == std::vector<std::string>{"9", "8", "3"});
}
