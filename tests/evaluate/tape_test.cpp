// The tape: what becomes of calls, vectors, shared and dead expressions.
#include "evaluate/run.h"

#include <catch2/catch.hpp>

#include <array>
#include <vector>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::evaluate;

namespace {

Function function_of(std::string name, std::vector<Input> inputs)
{
    Function function;
    function.name = std::move(name);
    function.inputs = std::move(inputs);
    return function;
}

Input number(std::string name, double low = 0, double high = 1)
{
    return {std::move(name), Type::scalar, Quantity::number, {low, high}, Origin::argument, 0, {}};
}

Input color(std::string name)
{
    return {std::move(name), Type::vec3, Quantity::color, {0, 1}, Origin::argument, 0, {}};
}

}  // namespace

TEST_CASE("a call is inlined, and what it computes again is shared")
{
    Module module;
    Function square = function_of("square", {number("x")});
    const ExprId x = square.graph.input(0, Type::scalar);
    square.result = square.graph.apply(Op::multiply, {x, x});
    module.functions.push_back(square);

    Function outer = function_of("outer", {number("y")});
    Graph& graph = outer.graph;
    const ExprId y = graph.input(0, Type::scalar);
    const ExprId called = graph.call(FunctionId{0}, Type::scalar, std::array{y});
    const ExprId written = graph.apply(Op::power, {y, graph.literal("2")});
    graph.apply(Op::exp2, {y});  // dead
    outer.result = graph.apply(Op::add, {called, written});
    module.functions.push_back(outer);

    const Tape tape = compile(module, module.functions[1]);
    CHECK(dump(tape) == "s0 = input y\n"
                        "s1 = square s0\n"
                        "s1 = add s1 s1\n"
                        "outer = s1\n");
}

TEST_CASE("a vector is its components, and scalars spread over it")
{
    Module module;
    Function tint = function_of("tint", {color("f0"), number("t")});
    Graph& graph = tint.graph;
    const ExprId f0 = graph.input(0, Type::vec3);
    const ExprId t = graph.input(1, Type::scalar);
    tint.quantity = Quantity::color;
    tint.result = graph.apply(Op::lerp, {f0, graph.literal("1"), t});
    module.functions.push_back(tint);

    const Tape tape = compile(module, module.functions[0]);
    REQUIRE(tape.inputs.size() == 4);
    CHECK(tape.inputs[0].name == "f0.r");
    CHECK(tape.output_names == std::vector<std::string>{"tint.r", "tint.g", "tint.b"});

    const std::array<std::vector<float>, 4> in{{{0.25F}, {0.5F}, {1}, {0.5F}}};
    std::array<std::vector<float>, 3> out{{{0}, {0}, {0}}};
    const std::array<const float*, 4> columns{in[0].data(), in[1].data(), in[2].data(),
                                              in[3].data()};
    const std::array<float*, 3> results{out[0].data(), out[1].data(), out[2].data()};
    run(tape, columns, results, 1);
    CHECK(out[0][0] == 0.625F);
    CHECK(out[1][0] == 0.75F);
    CHECK(out[2][0] == 1);
}
