// The table of the Vulkan specification, line by line: what is accepted, and what is not.
#include "evaluate/fixture.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace lobe;
using namespace lobe::tests;
using evaluate::Acceptance;
using evaluate::Precision;
using ir::Op;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unit = 0x1p-23;  // of numbers in [1, 2)

bool accepts(const Acceptance& accepted, double value)
{
    return accepted.low <= value && value <= accepted.high;
}

}  // namespace

TEST_CASE("addition and multiplication accept both neighbors of an inexact result")
{
    CHECK(apply_acceptance(Op::add, {1, 0.5F}) == Acceptance{1.5, 1.5, false});
    CHECK(apply_acceptance(Op::add, {1, 0x1p-30F}) == Acceptance{1, 1 + unit, false});
    CHECK(apply_acceptance(Op::multiply, {1 + 0x1p-23F, 1 + 0x1p-23F}) ==
          Acceptance{1 + 2 * unit, 1 + 3 * unit, false});
}

TEST_CASE("a denormal may be flushed, as an operand and as a result")
{
    CHECK(apply_acceptance(Op::multiply, {0x1p-100F, 0x1p-40F}) == Acceptance{0, 0x1p-140, false});
    CHECK(apply_acceptance(Op::multiply, {0x1p-140F, 0x1p+100F}) == Acceptance{0, 0x1p-40, false});
}

TEST_CASE("a quotient is right to 2.5 units where the divisor is ordinary")
{
    const Acceptance third = apply_acceptance(Op::divide, {1, 3});
    CHECK_FALSE(third.undefined);
    // The nearest float is a third of a unit above.
    const double nearest = static_cast<double>(1.0F / 3);
    CHECK(third == Acceptance{nearest - 2 * 0x1p-25, nearest + 2 * 0x1p-25, false});
    CHECK(apply_acceptance(Op::divide, {1, 0}).undefined);
    CHECK(apply_acceptance(Op::divide, {1, 0x1p+127F}).undefined);
    CHECK(apply_acceptance(Op::divide, {1, 0x1p-127F}).undefined);
}

TEST_CASE("exp2 and log2 have the table's errors")
{
    const Acceptance power = apply_acceptance(Op::exp2, {0.5F});
    // 3 + 2 |x| is 4 units, and the nearest float is less than half of one away.
    const double root2 = static_cast<double>(std::sqrt(2.0F));
    CHECK(accepts(power, root2 + 3 * unit));
    CHECK_FALSE(accepts(power, root2 + 5 * unit));
    CHECK(accepts(power, root2 - 3 * unit));
    CHECK_FALSE(accepts(power, root2 - 5 * unit));

    const Acceptance inside = apply_acceptance(Op::log2, {1});
    CHECK(inside == Acceptance{-0x1p-21, 0x1p-21, false});
    const Acceptance outside = apply_acceptance(Op::log2, {8});
    CHECK(outside == Acceptance{3 - 6 * unit, 3 + 6 * unit, false});
    CHECK(apply_acceptance(Op::log2, {0}).undefined);
    CHECK(apply_acceptance(Op::log2, {-1}).undefined);
}

TEST_CASE("a square root of zero is zero; of a negative number undefined")
{
    CHECK(apply_acceptance(Op::square_root, {0}) == Acceptance{0, 0, false});
    CHECK(apply_acceptance(Op::square_root, {-1}).undefined);
    CHECK(apply_acceptance(Op::inverse_square_root, {0}).undefined);
    const Acceptance two = apply_acceptance(Op::square_root, {4});
    CHECK(accepts(two, 2 + 2 * unit));
    CHECK_FALSE(accepts(two, 2 + 12 * unit));
}

TEST_CASE("a bare power at zero is undefined where its guarded twin is one")
{
    CHECK(apply_acceptance(Op::power, {0, 0}).undefined);
    CHECK(apply_acceptance(Op::power, {-0.25F, 2}).undefined);
    CHECK(apply_acceptance(Op::power, {0, 2}) == Acceptance{0, 0, false});
    CHECK(accepts(apply_acceptance(Op::guarded_power, {0, 0}), 1));
    CHECK_FALSE(apply_acceptance(Op::guarded_power, {0, 0}).undefined);
    CHECK(accepts(apply_acceptance(Op::guarded_power, {-0.25F, 2}), 0));
    CHECK_FALSE(apply_acceptance(Op::guarded_power, {-0.25F, 2}).undefined);
    // 2^-20 to the fourth: log2 off by 3 units of 16, times 4, and exp2 by 163 units.
    const Acceptance small = apply_acceptance(Op::power, {0x1p-20F, 4});
    CHECK(accepts(small, 0x1p-80));
    CHECK(small.high < 0x1p-80 * (1 + 1e-4));
    CHECK(small.low > 0x1p-80 * (1 - 1e-4));
}

TEST_CASE("both formulas of a mix are accepted, and both ends")
{
    const Acceptance mixed = apply_acceptance(Op::lerp, {1e8F, 1, 1});
    CHECK(accepts(mixed, 1));
    CHECK(accepts(mixed, 0));  // x + (y - x) * t, where y - x is rounded
    CHECK_FALSE(accepts(mixed, 9));
    CHECK(apply_acceptance(Op::lerp, {0.5F, 0.25F, 0}) == Acceptance{0.5, 0.5, false});
}

TEST_CASE("a sum of three is accepted in any order")
{
    ir::Module module = module_of(Op::add, 2);
    ir::Function function;
    function.name = "sum";
    for (const char* letter : {"a", "b"})
        function.inputs.push_back({letter,
                                   ir::Type::vec3,
                                   ir::Quantity::vector,
                                   {-1e9, 1e9},
                                   ir::Origin::argument,
                                   0,
                                   {}});
    function.result = function.graph.apply(Op::dot, {function.graph.input(0, ir::Type::vec3),
                                                     function.graph.input(1, ir::Type::vec3)});
    module.functions.push_back(function);
    const evaluate::Tape tape = evaluate::compile(module, module.functions[1]);
    const auto accepted =
        evaluate_acceptance(tape, Precision::float32, {{1e8F, 1, -1e8F, 1, 1, 1}})[0][0];
    CHECK(accepts(accepted, 0));
    CHECK(accepts(accepted, 1));
    CHECK_FALSE(accepts(accepted, 10));
}

TEST_CASE("overflow reaches infinity, and what follows is undefined")
{
    const Acceptance square = apply_acceptance(Op::multiply, {0x1p+100F, 0x1p+100F});
    CHECK(square.high == infinity);
    CHECK_FALSE(square.undefined);

    ir::Module module = module_of(Op::multiply, 2);
    ir::Function& function = module.functions[0];
    ir::Graph& graph = function.graph;
    const ir::ExprId x = graph.input(0, ir::Type::scalar);
    const ir::ExprId product = graph.apply(Op::multiply, {x, x});
    function.result = graph.apply(
        Op::subtract, {product, graph.apply(Op::multiply, {product, graph.literal("0.5")})});
    const evaluate::Tape tape = evaluate::compile(module, function);
    CHECK(evaluate_acceptance(tape, Precision::float32, {{0x1p+100F, 0}})[0][0].undefined);
}

TEST_CASE("an undefined arm counts only where it may be taken")
{
    ir::Module module = module_of(Op::add, 2);
    ir::Function& function = module.functions[0];
    ir::Graph& graph = function.graph;
    const ir::ExprId a = graph.input(0, ir::Type::scalar);
    const ir::ExprId b = graph.input(1, ir::Type::scalar);
    const ir::ExprId quotient = graph.apply(Op::divide, {a, b});
    const ir::ExprId at_limit = graph.apply(Op::equal, {b, graph.literal("0")});
    function.result = graph.apply(Op::select, {at_limit, graph.literal("0.5"), quotient});
    const evaluate::Tape tape = evaluate::compile(module, function);
    const auto accepted =
        evaluate_acceptance(tape, Precision::float32, {{1, 0}, {1, 0x1p-140F}, {1, 2}});
    CHECK(accepted[0][0] == Acceptance{0.5, 0.5, false});
    CHECK(accepted[1][0].undefined);
    CHECK_FALSE(accepted[2][0].undefined);
}

TEST_CASE("the half table is coarser, and has its own ends")
{
    const Acceptance sum = apply_acceptance(Op::add, {2048, 1}, Precision::float16);
    CHECK(sum == Acceptance{2048, 2050, false});
    CHECK(apply_acceptance(Op::multiply, {256, 256}, Precision::float16).high == infinity);
    CHECK(apply_acceptance(Op::multiply, {0x1p-8F, 0x1p-8F}, Precision::float16) ==
          Acceptance{0, 0x1p-16, false});
    CHECK(apply_acceptance(Op::log2, {1}, Precision::float16) ==
          Acceptance{-0x1p-7, 0x1p-7, false});
}
