// What legalize promises: the list in legal.h holds, values stay, and guards go only where the
// ranges allow it.
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "random_term.h"
#include "values.h"

#include <functional>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::illegal;
using optimize::legalize;

namespace {

int count(const Module& module, Op op)
{
    int found = 0;
    const Graph& graph = module.functions[0].graph;
    for (const ExprId id : graph.ids()) found += graph[id].op == op ? 1 : 0;
    return found;
}

/// One operation over arguments with these ranges.
Module operation(Op op, std::initializer_list<Range> ranges)
{
    Term t{"term"};
    std::vector<ExprId> operands;
    for (const Range& range : ranges)
        operands.push_back(t.argument(std::string(1, static_cast<char>('x' + operands.size())),
                                      range.low, range.high));
    return only(t, t.function.graph.apply(op, operands));
}

Module power_of(double low, double high, std::string_view exponent, Op op = Op::guarded_power)
{
    Term t{"term"};
    const ExprId x = t.argument("x", low, high);
    return only(t, t.op(op, {x, t.number(exponent)}));
}

}  // namespace

TEST_CASE("whole exponents become products, bit for bit as evaluate computes them")
{
    for (const char* exponent : {"2", "3", "4", "5", "7", "10", "15", "64", "-1", "-2", "-5"}) {
        const bool negative = exponent[0] == '-';
        const Module before = power_of(negative ? 0.25 : -2, 2, exponent);
        const Module after = legalize(before);
        CAPTURE(exponent);
        REQUIRE_FALSE(verify(after));
        CHECK(count(after, Op::guarded_power) + count(after, Op::power) == 0);
        CHECK_FALSE(illegal(after));

        std::mt19937 random{3};
        const auto points = sample(before, before.functions[0], random, 200);
        const auto expected = values(before, before.functions[0], points);
        const auto actual = values(after, after.functions[0], points);
        for (std::size_t i = 0; i < expected.size(); ++i) CHECK(same_bits(expected[i], actual[i]));
    }
    CHECK(count(legalize(power_of(0, 1, "5")), Op::multiply) == 3);
}

TEST_CASE("half exponents become products and a square root where the base is not negative")
{
    for (const char* exponent : {"0.5", "1.5", "2.5", "-0.5", "-1.5"}) {
        const bool negative = exponent[0] == '-';
        const Module before = power_of(negative ? 0.25 : 0, 2, exponent, Op::power);
        const Module after = legalize(before);
        CAPTURE(exponent);
        REQUIRE_FALSE(verify(after));
        CHECK(count(after, Op::guarded_power) + count(after, Op::power) == 0);
        CHECK_FALSE(illegal(after));

        std::mt19937 random{5};
        const auto points = in_real(sample(before, before.functions[0], random, 100));
        const auto expected = values(before, before.functions[0], points);
        const auto actual = values(after, after.functions[0], points);
        for (std::size_t i = 0; i < expected.size(); ++i)
            CHECK(difference(expected[i], actual[i]) < real_slack);
    }
    CHECK(count(legalize(power_of(0.5, 2, "-0.5")), Op::inverse_square_root) == 1);
}

TEST_CASE("a half exponent makes of 0 what a guard makes of it, within a float")
{
    const Module before = power_of(0, 2, "2.5");
    const Module after = legalize(before);
    CHECK(count(after, Op::guarded_power) + count(after, Op::power) == 0);
    CHECK(values(before, before.functions[0], Points<float>{{"x", {0}}}) ==
          values(after, after.functions[0], Points<float>{{"x", {0}}}));
}

TEST_CASE("other exponents stay powers, guarded where the base can be 0 and the exponent too")
{
    CHECK(count(legalize(power_of(0, 1, "2.2")), Op::power) == 1);
    CHECK(count(legalize(operation(Op::guarded_power, {{0.5, 1}, {-1, 1}})), Op::power) == 1);
    CHECK(count(legalize(operation(Op::guarded_power, {{0, 1}, {1.25, 2}})), Op::power) == 1);
    CHECK(count(legalize(operation(Op::power, {{0, 1}, {0.5, 1}})), Op::power) == 1);
    // 0^0.5 is what the guard makes it: 2^-63.
    CHECK(count(legalize(operation(Op::guarded_power, {{0, 1}, {0.5, 1}})), Op::guarded_power) ==
          1);
    // Callisto's falloff: exponent 0 is legal, and 0^0 is 1.
    CHECK(count(legalize(operation(Op::guarded_power, {{0, 1}, {0, 10}})), Op::guarded_power) == 1);
    // A bare power that was never safe gets its guard.
    CHECK(count(legalize(operation(Op::power, {{0, 1}, {0, 10}})), Op::guarded_power) == 1);
    CHECK(illegal(operation(Op::power, {{0, 1}, {0, 10}})));
    CHECK_FALSE(illegal(operation(Op::power, {{0, 1}, {0.5, 10}})));
}

TEST_CASE("a power of two is exp2")
{
    Term t{"term"};
    const ExprId x = t.argument("x", -3, 3);
    const Module module = legalize(only(t, t.op(Op::guarded_power, {t.number("2"), x})));
    CHECK(count(module, Op::exp2) == 1);
    CHECK(count(module, Op::guarded_power) == 0);
}

TEST_CASE("smoothstep is bare where its edges are proved apart")
{
    const auto smooth = [](Range edge0, Range edge1) {
        return legalize(operation(Op::guarded_smoothstep, {edge0, edge1, {0, 1}}));
    };
    CHECK(count(smooth({0, 0.25}, {0.5, 1}), Op::smoothstep) == 1);
    CHECK(count(smooth({0, 0.5}, {0.5, 1}), Op::guarded_smoothstep) == 1);
    CHECK(illegal(operation(Op::smoothstep, {{0, 0.5}, {0.5, 1}, {0, 1}})));
}

TEST_CASE("normalize is bare where its operand is proved not to be 0")
{
    const auto normalized = [](double low) {
        Term t{"term"};
        const ExprId v = t.argument("v", low, 1, Type::vec3);
        return only(t, t.op(Op::guarded_normalize, {v}));
    };
    CHECK(count(legalize(normalized(0.5)), Op::normalize) == 1);
    CHECK(count(legalize(normalized(0)), Op::guarded_normalize) == 1);

    const auto of_field = [](GeometryField field) {
        Term t{"term"};
        const ExprId v = t.field(field);
        t.function.inputs[0].quantity = Quantity::direction;
        return count(legalize(only(t, t.op(Op::guarded_normalize, {v}))), Op::normalize) == 1;
    };
    CHECK(of_field(GeometryField::n));
    CHECK_FALSE(of_field(GeometryField::h));  // 0 where l = -v
}

TEST_CASE("arguments that rounding could push out of a domain are held in it")
{
    CHECK(count(legalize(operation(Op::square_root, {{0, 1}})), Op::maximum) == 0);
    CHECK(count(legalize(operation(Op::square_root, {{-1e-7, 1}})), Op::maximum) == 1);
    CHECK(count(legalize(operation(Op::log2, {{0.5, 1}})), Op::maximum) == 0);
    CHECK(count(legalize(operation(Op::log2, {{0, 1}})), Op::maximum) == 1);
    CHECK(count(legalize(operation(Op::arc_cosine, {{-1, 1}})), Op::clamp) == 0);
    CHECK(count(legalize(operation(Op::arc_cosine, {{-1.5, 1}})), Op::clamp) == 1);
    for (const Op op : {Op::square_root, Op::inverse_square_root, Op::log, Op::log2, Op::arc_sine,
                        Op::arc_cosine}) {
        const Module module = operation(op, {{-2, 2}});
        CAPTURE(name(op));
        CHECK(illegal(module));
        CHECK_FALSE(illegal(legalize(module)));
    }
}

TEST_CASE("a division is legal when its divisor is not 0, or a select takes the other arm there")
{
    const auto guarded = [](double low, bool of_size, bool swapped) {
        Term t{"term"};
        const ExprId x = t.argument("x", low, 1);
        const ExprId quotient = t.divide(t.number("1"), x);
        const ExprId size = of_size ? t.op(Op::absolute, {x}) : x;
        const ExprId least = t.function.graph.literal(least_divisor);
        const ExprId test = t.op(Op::less_equal, {least, size});
        const ExprId limit = t.number("7");
        return only(t, swapped ? t.op(Op::select, {test, limit, quotient})
                               : t.op(Op::select, {test, quotient, limit}));
    };
    CHECK_FALSE(illegal(guarded(0, false, false)));
    CHECK_FALSE(illegal(guarded(-1, false, false)));
    CHECK_FALSE(illegal(guarded(-1, true, false)));
    CHECK(illegal(guarded(0, false, true)));
    CHECK(illegal(guarded(-1, true, true)));
    CHECK(illegal(operation(Op::divide, {{0, 1}, {0, 1}})));
    CHECK_FALSE(illegal(operation(Op::divide, {{0, 1}, {0.5, 1}})));

    // The same quotient in the open as well: the guard elsewhere does not help it.
    Term t{"term"};
    const ExprId x = t.argument("x", 0, 1);
    const ExprId quotient = t.divide(t.number("1"), x);
    const ExprId least = t.function.graph.literal(least_divisor);
    const ExprId choice =
        t.op(Op::select, {t.op(Op::less_equal, {least, x}), quotient, t.number("7")});
    CHECK(illegal(only(t, t.add(choice, quotient))));
}

TEST_CASE("a divisor that only rounding brings to 0 is held on its side of it")
{
    // 1 - x^2 (1 - 2^-30) is 2^-30 at least, and in float may be 0.
    const auto divided = [](bool negative) {
        Term t{"term"};
        const ExprId x = t.argument("x", 0, 1);
        const ExprId one = t.number("1");
        const ExprId part = t.multiply(t.multiply(x, x), t.function.graph.literal(1 - 0x1p-30));
        return only(t, t.divide(one, negative ? t.subtract(part, one) : t.subtract(one, part)));
    };
    for (const bool negative : {false, true}) {
        CHECK(illegal(divided(negative)));
        const Module legal = legalize(divided(negative));
        CHECK_FALSE(illegal(legal));
        CHECK(count(legal, negative ? Op::minimum : Op::maximum) == 1);
        const auto at_one = values(legal, legal.functions[0], Points<float>{{"x", {1}}});
        CHECK(at_one[0] == (negative ? -0x1p126F : 0x1p126F));
    }
}

TEST_CASE("legalizing keeps values and settles at once", "[property]")
{
    for (std::uint32_t seed = 1; seed <= 150; ++seed) {
        std::mt19937 random{seed};
        const Module module = optimize::simplify(random_term(random, 40));
        const Module legal = legalize(module);
        CAPTURE(seed);
        REQUIRE_FALSE(verify(legal));
        REQUIRE_FALSE(illegal(legal));
        REQUIRE(optimize::same_graphs(legalize(legal), legal));

        const auto points = sample(module, module.functions[0], random, 32);
        const auto before = values(module, module.functions[0], points);
        const auto after = values(legal, legal.functions[0], points);
        for (std::size_t i = 0; i < before.size(); ++i) REQUIRE(same_bits(before[i], after[i]));
    }
}

TEST_CASE("the whole pipeline is idempotent, legal, and keeps values over the real numbers",
          "[property]")
{
    for (std::uint32_t seed = 1; seed <= 100; ++seed) {
        std::mt19937 random{seed};
        const Module module = random_term(random, 60);
        const Module optimized = optimize::optimize(module);
        CAPTURE(seed);
        REQUIRE_FALSE(verify(optimized));
        REQUIRE_FALSE(illegal(optimized));
        REQUIRE(optimize::same_graphs(optimize::optimize(optimized), optimized));

        const auto points = in_real(sample(module, module.functions[0], random, 8));
        const auto before = values(module, module.functions[0], points);
        const auto after = values(optimized, optimized.functions[0], points);
        for (std::size_t i = 0; i < before.size(); ++i)
            REQUIRE(difference(before[i], after[i]) < real_slack);
    }
}
