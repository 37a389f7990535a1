// The three invariants of the graph, literals as real numbers, and entry points.
#include "ir/module.h"

#include <catch2/catch.hpp>

using namespace lobe::ir;

TEST_CASE("structurally equal expressions are the same expression")
{
    Graph graph;
    const ExprId x = graph.input(0, Type::scalar);
    const ExprId once = graph.apply(Op::add, {x, graph.literal("0.50")});
    const ExprId again = graph.apply(Op::add, {x, graph.literal("5e-1")});
    CHECK(once == again);
    CHECK(graph.size() == 3);
    CHECK(graph.apply(Op::add, {graph.literal("0.5"), x}) != once);
}

TEST_CASE("operands come before their expression and types follow from them")
{
    Graph graph;
    const ExprId color = graph.input(0, Type::vec3);
    const ExprId weight = graph.input(1, Type::scalar);
    const ExprId scaled = graph.apply(Op::multiply, {weight, color});
    CHECK(graph[scaled].type == Type::vec3);
    CHECK(graph[graph.apply(Op::dot, {color, scaled})].type == Type::scalar);
    const ExprId above = graph.apply(Op::less, {graph.literal("0"), weight});
    CHECK(graph[above].type == Type::boolean);
    CHECK(graph[graph.apply(Op::select, {above, scaled, weight})].type == Type::vec3);
    for (const ExprId id : graph.ids())
        for (const ExprId operand : graph.operands(id)) CHECK(operand < id);
}

TEST_CASE("a literal is the real number that was written")
{
    CHECK(canonical_number("0.190") == "0.19");
    CHECK(canonical_number("00.5") == "0.5");
    CHECK(canonical_number("1e3") == "1000");
    CHECK(canonical_number("1.5E-9") == "1.5e-9");
    CHECK(canonical_number("0.0") == "0");
    CHECK(canonical_number("123456789012345678901234567890") ==
          "1.2345678901234567890123456789e29");

    Graph graph;
    CHECK(graph.literal_of(graph.literal("0.19")).value == 0.19);
    CHECK(graph.literal("0.1") != graph.literal(0.1));  // the double is another real number
    CHECK(graph.literal("0.5") == graph.literal(0.5));
    CHECK(graph.literal_of(graph.literal("1e-400")).value == 0.0);
}

TEST_CASE("a short literal knows on which side of the real number its double lies")
{
    const auto rounding = [](const char* text) {
        Graph graph;
        return rounding_of(graph.literal_of(graph.literal(text)));
    };
    for (const char* exact : {"0", "1", "-7", "0.5", "-0.375", "1024", "0.0009765625"})
        CHECK(rounding(exact) == 0);
    // The doubles: 0.1000000000000000055..., 0.2999999999999999888..., and so on.
    CHECK(rounding("0.1") == 1);
    CHECK(rounding("-0.1") == -1);
    CHECK(rounding("0.3") == -1);
    CHECK(rounding("1e-7") == -1);
    CHECK(rounding("1e-22") == 1);
    CHECK_FALSE(rounding("pi"));
    CHECK_FALSE(rounding("0.1234567890123456"));
    CHECK_FALSE(rounding("1e30"));
    CHECK_FALSE(rounding("1e-30"));
}

TEST_CASE("sharing survives growth")
{
    Graph graph;
    std::vector<ExprId> squares;
    constexpr std::uint32_t many = 5000;
    for (std::uint32_t i = 0; i < many; ++i) {
        const ExprId x = graph.input(i, Type::scalar);
        squares.push_back(graph.apply(Op::multiply, {x, x}));
        // A slice of the graph's own operands, which move while they are copied.
        CHECK(graph.apply(Op::add, graph.operands(squares.back())).valid());
    }
    const std::size_t size = graph.size();
    for (std::uint32_t i = 0; i < many; ++i) {
        const ExprId x = graph.input(i, Type::scalar);
        REQUIRE(graph.apply(Op::multiply, {x, x}) == squares[i]);
        const ExprId sum = graph.apply(Op::add, {x, x});
        REQUIRE(graph.operands(sum)[0] == x);
        REQUIRE(graph.operands(sum)[1] == x);
    }
    CHECK(graph.size() == size);
}

TEST_CASE("an entry point computes the geometry that its function asks for")
{
    Module module;
    Function function;
    function.name = "cosine";
    function.inputs.push_back({"cos_i",
                               Type::scalar,
                               Quantity::number,
                               {0, 1},
                               Origin::geometry,
                               static_cast<std::uint32_t>(GeometryField::cos_i),
                               {}});
    function.inputs.push_back(
        {"gain", Type::scalar, Quantity::number, {0, 2}, Origin::argument, 0, {}});
    function.result = function.graph.apply(Op::multiply, {function.graph.input(0, Type::scalar),
                                                          function.graph.input(1, Type::scalar)});
    module.functions.push_back(function);
    REQUIRE_FALSE(verify(module));

    const Function entry = entry_point(module, FunctionId{0});
    REQUIRE(entry.inputs.size() == 4);
    CHECK(entry.inputs[0].name == "l");
    CHECK(entry.inputs[3].name == "gain");
    CHECK(entry.graph[entry.result].op == Op::call);
}
