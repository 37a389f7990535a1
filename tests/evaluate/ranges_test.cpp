// Ranges of expressions, as the checker and the guards' removal read them.
#include "evaluate/fixture.h"

#include <catch2/catch.hpp>

#include <array>
#include <limits>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::evaluate;
using tests::color_input;
using tests::number_input;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool inside(Interval inner, double low, double high)
{
    return low <= inner.low && inner.high <= high;
}

/// (1 - x)^y * gain, where gain is a color in [0, 256]: a call of `lobe` and a product.
struct Weighted {
    Module module;
    ExprId power;
    ExprId called;
    ExprId blended;

    Weighted()
    {
        Function lobe;
        lobe.name = "lobe";
        lobe.inputs = {number_input("x", 0, 1), number_input("y", 0, 10)};
        const ExprId x = lobe.graph.input(0, Type::scalar);
        const ExprId y = lobe.graph.input(1, Type::scalar);
        power = lobe.graph.apply(Op::guarded_power,
                                 {lobe.graph.apply(Op::subtract, {lobe.graph.literal("1"), x}), y});
        lobe.result = power;
        module.functions.push_back(lobe);

        Function blend;
        blend.name = "blend";
        blend.inputs = {number_input("x", 0, 1), color_input("tint"), number_input("gain", 0, 256)};
        Graph& graph = blend.graph;
        const std::array operands{graph.input(0, Type::scalar), graph.literal("2.5")};
        called = graph.call(FunctionId{0}, Type::scalar, operands);
        const ExprId gained =
            graph.apply(Op::multiply, {graph.input(1, Type::vec3), graph.input(2, Type::scalar)});
        blended = graph.apply(Op::lerp, {graph.literal("1"), gained, called});
        blend.result = blended;
        module.functions.push_back(blend);
    }
};

}  // namespace

TEST_CASE("ranges go through calls and are the hull over components")
{
    const Weighted weighted;
    const Function& blend = weighted.module.functions[1];
    const auto reals = ranges(weighted.module, blend, declared_ranges(blend), Arithmetic::reals);
    // 0^2.5 counts as (2^-126)^2.5.
    CHECK(reals[weighted.called].low < 0x1p-314);
    CHECK(reals[weighted.called].low > 0x1p-316);
    CHECK(reals[weighted.called].high == 1);
    CHECK(reals[weighted.blended] == Interval{0, 256});

    std::vector<Interval> narrowed = declared_ranges(blend);
    narrowed[2] = {0.5, 2};
    CHECK(ranges(weighted.module, blend, narrowed, Arithmetic::reals)[weighted.blended] ==
          Interval{0, 2});
}

TEST_CASE("float ranges hold for every conforming target")
{
    const Weighted weighted;
    const Function& lobe = weighted.module.functions[0];
    const auto floats = ranges(weighted.module, lobe, declared_ranges(lobe));
    // exp2 of an exponent near 0 may be 3 units above 1, so a power is not quite in [0, 1].
    CHECK(floats[weighted.power].low == 0);
    CHECK(floats[weighted.power].high > 1);
    CHECK(floats[weighted.power].high < 1 + 1e-5);
    CHECK(ranges(weighted.module, lobe, declared_ranges(lobe), Arithmetic::reals)[weighted.power] ==
          Interval{0, 1});
}

TEST_CASE("a quotient of guarded parts stays on its side of zero")
{
    // alpha^2 / (pi (sin2 (1 - alpha^2) + alpha^2)^2)
    Module module;
    Function d;
    d.name = "D";
    d.inputs = {number_input("alpha", 0x1p-12, 1), number_input("sin2_h", 0, 1)};
    Graph& graph = d.graph;
    const ExprId alpha = graph.input(0, Type::scalar);
    const ExprId a2 = graph.apply(Op::multiply, {alpha, alpha});
    const ExprId rest = graph.apply(Op::subtract, {graph.literal("1"), a2});
    const ExprId base =
        graph.apply(Op::add, {graph.apply(Op::multiply, {graph.input(1, Type::scalar), rest}), a2});
    const ExprId divisor =
        graph.apply(Op::multiply, {graph.literal("pi"), graph.apply(Op::multiply, {base, base})});
    d.result = graph.apply(Op::divide, {a2, divisor});
    module.functions.push_back(d);

    for (const auto arithmetic : {Arithmetic::reals, Arithmetic::float32}) {
        const auto found = ranges(module, d, declared_ranges(d), arithmetic);
        CHECK(found[divisor].low > 0);
        CHECK(found[d.result].low > 0);
        CHECK(found[d.result].high < infinity);
    }
}

TEST_CASE("a division is left out where its select does not take it")
{
    Module module;
    Function f;
    f.name = "f";
    f.inputs = {number_input("x", 0, 1)};
    Graph& graph = f.graph;
    const ExprId x = graph.input(0, Type::scalar);
    const ExprId quotient = graph.apply(Op::divide, {graph.literal("1"), x});
    f.result = graph.apply(Op::select, {graph.apply(Op::equal, {x, graph.literal("0")}),
                                        graph.literal("0.25"), quotient});
    module.functions.push_back(f);
    const auto whole = ranges(module, f, declared_ranges(f), Arithmetic::reals);
    CHECK(whole[f.result] == Interval{0.25, infinity});
    const std::array at_limit{Interval{0, 0}};
    CHECK(ranges(module, f, at_limit, Arithmetic::reals)[f.result] == Interval{0.25, 0.25});
    const std::array away{Interval{0.5, 1}};
    CHECK(inside(ranges(module, f, away)[f.result], 1 - 1e-6, 2 + 1e-6));
}

TEST_CASE("the half vector of an entry point has components in [-1, 1]")
{
    Module module;
    Function f;
    f.name = "half";
    f.inputs = {{"h",
                 Type::vec3,
                 Quantity::direction,
                 {-1, 1},
                 Origin::geometry,
                 static_cast<std::uint32_t>(GeometryField::h),
                 {}}};
    f.result = f.graph.input(0, Type::vec3);
    f.quantity = Quantity::direction;
    module.functions.push_back(f);
    const Function entry = entry_point(module, FunctionId{0});
    const auto reals = ranges(module, entry, declared_ranges(entry), Arithmetic::reals);
    CHECK(reals[entry.result] == Interval{-1, 1});
    CHECK(inside(ranges(module, entry, declared_ranges(entry))[entry.result], -1 - 1e-5, 1 + 1e-5));
}

TEST_CASE("unbounded inputs have unbounded ranges, and zero times one of them is zero")
{
    const Module module = tests::module_of(Op::multiply, 2);
    const Function& product = module.functions[0];
    const auto whole = ranges(module, product, declared_ranges(product));
    CHECK(whole[product.result] == Interval{-infinity, infinity});
    const std::array inputs{Interval{0, 0}, Interval{-infinity, infinity}};
    CHECK(ranges(module, product, inputs)[product.result] == Interval{0, 0});
}
