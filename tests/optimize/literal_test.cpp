// Folding is exact or refused.
#include "optimize/literal.h"

#include <catch2/catch.hpp>

using namespace lobe::ir;
using namespace lobe::optimize;

TEST_CASE("a literal is exact when a double holds the number that was written")
{
    Graph graph;
    const auto exact = [&](const char* text) {
        return exact_value(graph.literal_of(graph.literal(text)));
    };
    CHECK(exact("0.5") == 0.5);
    CHECK(exact("0") == 0.0);
    CHECK(exact("-3") == -3.0);
    CHECK(exact("1e15") == 1e15);
    CHECK_FALSE(exact("0.1"));
    CHECK_FALSE(exact("pi"));
    CHECK_FALSE(exact("1e400"));
    CHECK_FALSE(exact("1e-400"));
    // 2^53 + 1 is the first whole number that a double misses.
    CHECK(exact("9007199254740992") == 9007199254740992.0);
    CHECK_FALSE(exact("9007199254740993"));
}

TEST_CASE("a literal written from a double is exact")
{
    Graph graph;
    for (const double value : {0.1, 1.0 / 3, 0x1p-300, 1e100, 123456.789})
        CHECK(exact_value(graph.literal_of(graph.literal(value))) == value);
}

TEST_CASE("operations fold when nothing rounds")
{
    const auto fold = [](Op op, std::initializer_list<double> operands) {
        return fold_exactly(op, std::span{operands.begin(), operands.size()});
    };
    CHECK(fold(Op::multiply, {5, 0.5}) == 2.5);
    CHECK(fold(Op::add, {0.5, -0.5}) == 0.0);
    CHECK(fold(Op::divide, {3, 4}) == 0.75);
    CHECK(fold(Op::power, {-3, 3}) == -27.0);
    CHECK(fold(Op::power, {2, -2}) == 0.25);
    CHECK(fold(Op::power, {0, 0}) == 1.0);
    CHECK(fold(Op::square_root, {2.25}) == 1.5);
    CHECK(fold(Op::exp2, {-3}) == 0.125);
    CHECK(fold(Op::log2, {8}) == 3.0);
    CHECK(fold(Op::lerp, {1, 3, 0.25}) == 1.5);
    CHECK(fold(Op::guarded_smoothstep, {0, 2, 1}) == 0.5);
    CHECK(fold(Op::guarded_smoothstep, {0, 0, 0}) == 0.0);
    CHECK(fold(Op::guarded_smoothstep, {0, -1, 0.5}) == 1.0);
}

TEST_CASE("operations that would round are refused")
{
    const auto refuses = [](Op op, std::initializer_list<double> operands) {
        return !fold_exactly(op, std::span{operands.begin(), operands.size()});
    };
    CHECK(refuses(Op::divide, {1, 3}));
    CHECK(refuses(Op::divide, {1, 0}));
    CHECK(refuses(Op::add, {1, 0x1p-60}));
    CHECK(refuses(Op::multiply, {1 + 0x1p-40, 1 + 0x1p-40}));
    CHECK(refuses(Op::multiply, {0x1p-300, 0x1p-300}));
    CHECK(refuses(Op::square_root, {2}));
    CHECK(refuses(Op::square_root, {-1}));
    CHECK(refuses(Op::power, {2, 0.5}));
    CHECK(refuses(Op::exp2, {0.5}));
    CHECK(refuses(Op::log2, {3}));
    CHECK(refuses(Op::sine, {1}));
}

TEST_CASE("a vector spread from one literal is as good as that literal")
{
    Graph graph;
    const ExprId one = graph.literal("1");
    const ExprId spread = graph.construct(Type::vec3, {&one, 1});
    const ExprId list[] = {one, one, one};
    const ExprId mixed[] = {one, one, graph.literal("2")};
    CHECK(exact_literal(graph, spread) == 1.0);
    CHECK(exact_literal(graph, graph.construct(Type::vec3, list)) == 1.0);
    CHECK_FALSE(exact_literal(graph, graph.construct(Type::vec3, mixed)));
}
