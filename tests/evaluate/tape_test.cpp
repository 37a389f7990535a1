// The tape: what becomes of calls, vectors, shared and dead expressions.
#include "evaluate/fixture.h"
#include "evaluate/parallel.h"
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

Input number(std::string name) { return tests::number_input(std::move(name), 0, 1); }

Tape tape_of(Function function)
{
    Module module;
    module.functions.push_back(std::move(function));
    return compile(module, module.functions[0]);
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
    Function tint = function_of("tint", {tests::color_input("f0"), number("t")});
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

TEST_CASE("a whole exponent becomes products from the highest square down")
{
    const auto dump_of = [](const char* exponent) {
        Function f = function_of("f", {number("x")});
        f.result =
            f.graph.apply(Op::power, {f.graph.input(0, Type::scalar), f.graph.literal(exponent)});
        return dump(tape_of(f));
    };
    CHECK(dump_of("0") == "s0 = input x\ns1 = 1\nf = s1\n");
    CHECK(dump_of("1") == "s0 = input x\nf = s0\n");
    CHECK(dump_of("5") == "s0 = input x\n"
                          "s1 = square s0\n"
                          "s1 = square s1\n"
                          "s1 = multiply s0 s1\n"
                          "f = s1\n");
    CHECK(dump_of("7") == "s0 = input x\n"
                          "s1 = square s0\n"
                          "s2 = square s1\n"
                          "s2 = multiply s1 s2\n"
                          "s2 = multiply s0 s2\n"
                          "f = s2\n");
    CHECK(dump_of("-2") == "s0 = input x\n"
                           "s1 = 1\n"
                           "s2 = square s0\n"
                           "s2 = divide s1 s2\n"
                           "f = s2\n");
    CHECK(dump_of("2.5") == "s0 = input x\n"
                            "s1 = 2.5\n"
                            "s2 = power s0 s1\n"
                            "f = s2\n");
}

TEST_CASE("a vector's length and direction come from one sum of squares")
{
    Function f =
        function_of("f", {{"v", Type::vec3, Quantity::vector, {-1, 1}, Origin::argument, 0, {}}});
    const ExprId v = f.graph.input(0, Type::vec3);
    f.result = f.graph.apply(
        Op::multiply, {f.graph.apply(Op::guarded_normalize, {v}), f.graph.apply(Op::length, {v})});
    // The guard: a sum below the least normal float counts as that.
    const std::string least =
        "1.175494350822287507968736537222245677818665556772087521508751706278417259454727172851562"
        "5e-38";
    CHECK(dump(tape_of(f)) == "s0 = input v.x\n"
                              "s1 = input v.y\n"
                              "s2 = input v.z\n"
                              "s3 = " +
                                  least +
                                  "\n"
                                  "s4 = square s0\n"
                                  "s5 = square s1\n"
                                  "s6 = square s2\n"
                                  "s6 = sum3 s4 s5 s6\n"
                                  "s5 = maximum s6 s3\n"
                                  "s4 = normalized s0 s5\n"
                                  "s7 = normalized s1 s5\n"
                                  "s5 = normalized s2 s5\n"
                                  "s6 = square_root s6\n"
                                  "s4 = multiply s4 s6\n"
                                  "s7 = multiply s7 s6\n"
                                  "s6 = multiply s5 s6\n"
                                  "f.x = s4\n"
                                  "f.y = s7\n"
                                  "f.z = s6\n");
}

TEST_CASE("a large whole exponent is a product only where its base is negative")
{
    const auto power = [](double x) {
        Function f = function_of("f", {number("x")});
        f.result =
            f.graph.apply(Op::power, {f.graph.input(0, Type::scalar), f.graph.literal("101")});
        return tests::evaluate_double(tape_of(f), {{x}})[0][0];
    };
    CHECK(power(-1) == -1);
    CHECK(power(-0.5) == -0x1p-101);
    CHECK(power(0.5) == 0x1p-101);
    CHECK(power(0) == 0);
}

TEST_CASE("a long chain of calls needs no stack")
{
    Module module;
    for (std::size_t i = 0; i < 20'000; ++i) {
        Function f = function_of("f" + std::to_string(i), {number("x")});
        const ExprId x = f.graph.input(0, Type::scalar);
        f.result = i == 0 ? x : f.graph.call(FunctionId{i - 1}, Type::scalar, std::array{x});
        module.functions.push_back(std::move(f));
    }
    CHECK(dump(compile(module, module.functions.back())) == "s0 = input x\nf19999 = s0\n");
}

TEST_CASE("threads change nothing")
{
    const Module module = tests::module_of(Op::guarded_power, 2);
    const Tape tape = compile(module, module.functions[0]);
    std::vector<float> x;
    std::vector<float> y;
    for (int i = 0; i < 100'003; ++i) {
        x.push_back(static_cast<float>(i % 1009) / 1009);
        y.push_back(static_cast<float>(i % 997) / 100);
    }
    const std::array<const float*, 2> in{x.data(), y.data()};
    std::vector<float> alone(x.size());
    std::vector<float> together(x.size());
    const std::array<float*, 1> out_alone{alone.data()};
    const std::array<float*, 1> out_together{together.data()};
    run(tape, in, out_alone, x.size());
    for (const unsigned threads : {1U, 3U, 8U}) {
        std::fill(together.begin(), together.end(), -1.0F);
        run_parallel<float>(tape, in, out_together, x.size(), threads);
        CHECK(alone == together);
    }
    run_parallel<float>(tape, in, out_together, 0, 4);  // nothing to do
}
