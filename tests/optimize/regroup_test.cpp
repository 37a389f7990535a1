// Scalars first: what becomes of products of vectors, and that it is the same function.
#include "build.h"
#include "models.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "values.h"

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;

namespace {

/// `expression` over colors p, q in [0, 1], numbers a, b in [0, 2] and shares s, t in [0, 1].
Module color_of(const std::string& expression)
{
    return optimize::simplify(
        read_text("module test\n/// f\n"
                  "term f(p: color, q: color, a: float in [0, 2], b: float in [0, 2], s: unit, "
                  "t: unit) -> color = " +
                  expression + "\n"));
}

/// Operations on components, which is what a target executes.
int operations(const Module& module)
{
    const Function& function = module.functions.back();
    const auto uses = use_counts(function.graph, function.result);
    int count = 0;
    for (const ExprId id : function.graph.ids())
        if (uses[id] > 0 && shape(function.graph[id].op) == Shape::each)
            count += components(function.graph[id].type);
    return count;
}

/// How many fewer operations there are, with the values over the reals kept.
int saved(const std::string& expression)
{
    CAPTURE(expression);
    const Module before = color_of(expression);
    const Module after = optimize::regroup(before);
    REQUIRE_FALSE(verify(after));
    CHECK(optimize::same_graphs(optimize::regroup(after), after));
    std::mt19937 random{23};
    const auto points = in_real(sample(before, before.functions.back(), random, 60));
    const auto expected = values(before, before.functions.back(), points);
    const auto actual = values(after, after.functions.back(), points);
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(difference(expected[i], actual[i]) < real_slack);
    return operations(before) - operations(after);
}

/// With a column for every other input, which nothing reads.
Points<float> and_others(Points<float> points)
{
    const std::vector<float> zeros(points.begin()->second.size());
    for (const char* name : {"p.r", "p.g", "p.b", "q.r", "q.g", "q.b", "a", "b", "s", "t"})
        points.try_emplace(name, zeros);
    return points;
}

}  // namespace

TEST_CASE("scalar factors are multiplied before vectors are")
{
    CHECK(saved("p * a * b") == 2);
    CHECK(saved("a * p * b * q") == 2);
    CHECK(saved("p / pi * a") == 2);
    CHECK(saved("p / (1 + a) * q") == 0);
    CHECK(saved("p * q * a") == 0);
    // 1 / a may be infinite where p is 0.
    CHECK(saved("if a > 0 then p / a * b else p") == 0);
}

TEST_CASE("a gate closes the scalar factors of a product")
{
    CHECK(saved("if a > b then p * a else 0") == 2);
    CHECK(saved("if a > b then 0 else p * a") == 2);
    CHECK(saved("if a > b then p * q else 0") == 0);
    // The product is 0 where a is, and a - 1 may be below.
    CHECK(saved("if a > 0 and b > 1 then p * a else 0") == 2);
    CHECK(saved("if a > 0 then p * a * b else 0") == 2 + 3);
    CHECK(saved("if a - 1 > 0 then p * (a - 1) else 0") == 2);
}

TEST_CASE("what starts at 1 adds instead of subtracting and adding")
{
    // Counted before a target takes lerp apart, which is three operations and more for each
    // component.
    CHECK(saved("lerp(1, a * p, s)") <= 0);
    const Module module = optimize::regroup(color_of("lerp(1, a * p, s)"));
    const Points<float> ends = and_others({{"p.r", {1, 0.3F, 0.3F}},
                                           {"p.g", {1, 0.5F, 0.5F}},
                                           {"p.b", {1, 0, 0}},
                                           {"a", {1, 2, 2}},
                                           {"s", {0.1F, 0, 1}}});
    // At a p = 1 it is 1 for every s; at s = 0 it is 1, at s = 1 it is a p.
    CHECK(values(module, module.functions.back(), ends) ==
          std::vector<float>{1, 1, 0.6F, 1, 1, 1, 1, 1, 0});
}

TEST_CASE("a blend towards 1 keeps both ends")
{
    CHECK(saved("p + s * (1 - p) * t") == 3 + 3 + 3 + 3 - (1 + 1 + 3 + 3));
    const Module module = optimize::regroup(color_of("p + (1 - p) * s"));
    const Points<float> ends = and_others(
        {{"p.r", {0.3F, 0.3F, 1}}, {"p.g", {0, 0, 1}}, {"p.b", {1, 1, 1}}, {"s", {0, 1, 0.1F}}});
    CHECK(values(module, module.functions.back(), ends) ==
          std::vector<float>{0.3F, 1, 1, 0, 1, 1, 1, 1, 1});
}

TEST_CASE("what may overflow on the way stays as it was written")
{
    const auto grouped = [](const char* range) {
        const Module module = optimize::simplify(
            read_text(std::string{"module test\n/// f\nterm f(p: color, a: float in "} + range +
                      ", b: float in " + range + ") -> color = saturate(p * a * b)\n"));
        return !optimize::same_graphs(optimize::regroup(module), module);
    };
    CHECK(grouped("[0, 1e18]"));
    CHECK_FALSE(grouped("[0, 1e19]"));
}
