// Test points keep the promises of their inputs' declarations, and visit what breaks shaders.
#include "analyze/grid.h"
#include "analyze/models.h"
#include "analyze/points.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

using namespace lobe;
using analyze::Directions;
using analyze::Points;
using analyze::Values;
using evaluate::Precision;

namespace {

Points points_of(const std::string& name, std::size_t count,
                 Precision precision = Precision::float32)
{
    const ir::Module module = tests::sample_module();
    const ir::Function entry = ir::entry_point(module, *module.find(name));
    return analyze::points(module, entry, count, precision);
}

const std::vector<float>& column(const Points& points, const std::string& name)
{
    const auto found = std::ranges::find(points.names, name);
    REQUIRE(found != points.names.end());
    return points.columns[static_cast<std::size_t>(found - points.names.begin())];
}

double dot(const Points& points, std::size_t i, char a, char b)
{
    double sum = 0;
    for (const char axis : {'x', 'y', 'z'})
        sum += double{column(points, std::string{a, '.', axis})[i]} *
               double{column(points, std::string{b, '.', axis})[i]};
    return sum;
}

}  // namespace

TEST_CASE("every value lies in its declared range", "[points]")
{
    const ir::Module module = tests::sample_module();
    for (const Precision precision : {Precision::float32, Precision::float16})
        for (std::size_t f = 0; f < module.functions.size(); ++f) {
            const ir::Function entry = ir::entry_point(module, ir::FunctionId{f});
            const Points points = analyze::points(module, entry, 4096, precision);
            std::size_t at = 0;
            for (const ir::Input& input : entry.inputs)
                for (int k = 0; k < ir::components(input.type); ++k, ++at)
                    for (const float value : points.columns[at]) {
                        REQUIRE(double{value} >= input.range.low);
                        REQUIRE(double{value} <= input.range.high);
                    }
            REQUIRE(at == points.columns.size());
        }
}

TEST_CASE("points are the same every time", "[points]")
{
    const Points once = points_of("D_GGX", 4096);
    const Points again = points_of("D_GGX", 4096);
    CHECK(once.columns == again.columns);
    // A prefix of more points is fewer points: nothing depends on the count.
    const Points fewer = points_of("D_GGX", 100);
    for (std::size_t c = 0; c < fewer.columns.size(); ++c)
        CHECK(
            std::equal(fewer.columns[c].begin(), fewer.columns[c].end(), once.columns[c].begin()));
}

TEST_CASE("a quarter of the points is hostile, and every pair of cases comes up", "[points]")
{
    const Points points = points_of("D_GGX", 65536);
    std::set<std::pair<Directions, Values>> pairs;
    std::size_t hostile = 0;
    for (const analyze::Case& which : points.cases) {
        hostile += which.hostile();
        if (which.hostile()) pairs.emplace(which.directions, which.values);
    }
    CHECK(hostile == points.size() / 4);
    CHECK(pairs.size() == 14 * 9 - 1);
}

TEST_CASE("directions are what their case says", "[points]")
{
    const Points points = points_of("D_GGX", 16384);
    std::map<Directions, std::size_t> seen;
    // A unit vector rounded per component: half an ulp of 1 each, so 3 * 2^-24 in the square.
    constexpr double unit_slack = 3 * 0x1p-24;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Directions which = points.cases[i].directions;
        ++seen[which];
        for (const char vector : {'l', 'v', 'n'})
            REQUIRE(std::abs(dot(points, i, vector, vector) - 1) <= unit_slack);
        const double cos_i = dot(points, i, 'n', 'l');
        const double cos_o = dot(points, i, 'n', 'v');
        const auto l = [&](char axis) { return column(points, std::string{"l."} + axis)[i]; };
        const auto v = [&](char axis) { return column(points, std::string{"v."} + axis)[i]; };
        if (which == Directions::equal) {
            for (const char axis : {'x', 'y', 'z'}) REQUIRE(l(axis) == v(axis));
        } else if (which == Directions::opposed) {
            for (const char axis : {'x', 'y', 'z'}) REQUIRE(l(axis) == -v(axis));
        } else if (which == Directions::half_is_normal) {
            REQUIRE(std::abs(cos_i - cos_o) <= unit_slack);
        } else if (which == Directions::light_grazing || which == Directions::both_grazing) {
            REQUIRE(cos_i <= 1e-4 + unit_slack);
        } else if (which == Directions::both_below) {
            REQUIRE(cos_i <= unit_slack);
            REQUIRE(cos_o <= unit_slack);
        }
    }
    for (int i = 0; i <= static_cast<int>(Directions::both_below); ++i)
        CHECK(seen[static_cast<Directions>(i)] > 0);
}

TEST_CASE("ends, their neighbors, zero and denormals are visited", "[points]")
{
    const Points points = points_of("V_Smith", 4096);
    std::set<float> seen(column(points, "cos_i").begin(), column(points, "cos_i").end());
    const float low = 0x1p-10F;
    CHECK(seen.count(low) == 1);
    CHECK(seen.count(std::nextafter(low, 1.0F)) == 1);
    CHECK(seen.count(1.0F) == 1);
    CHECK(seen.count(std::nextafter(1.0F, 0.0F)) == 1);

    const Points from_zero = points_of("F_Schlick", 4096);
    seen = {column(from_zero, "cos_d").begin(), column(from_zero, "cos_d").end()};
    CHECK(seen.count(0.0F) == 1);
    CHECK(seen.count(std::numeric_limits<float>::denorm_min()) == 1);
}

TEST_CASE("neutral points hold the parameters at their defaults", "[points]")
{
    const Points points = points_of("blend", 4096);
    std::size_t neutral = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points.cases[i].values == Values::neutral) {
            ++neutral;
            REQUIRE(column(points, "gain")[i] == 1.0F);
            REQUIRE(column(points, "falloff")[i] == 0.75F);
        }
        if (points.cases[i].values == Values::upper_ends) {
            REQUIRE(column(points, "gain")[i] == 256.0F);
            REQUIRE(column(points, "falloff")[i] == 1.0F);
        }
    }
    CHECK(neutral > 0);
}

TEST_CASE("an unbounded input takes every order of magnitude and both signs", "[points]")
{
    ir::Module module;
    tests::FunctionBuilder f{"square"};
    const double infinity = std::numeric_limits<double>::infinity();
    const auto x = f.argument("x", -infinity, infinity);
    module.functions.push_back(f.finish(f(ir::Op::multiply, {x, x})));
    const Points points = analyze::points(module, ir::entry_point(module, ir::FunctionId{0}), 4096);
    std::set<int> exponents;
    bool positive = false, negative = false;
    for (const float value : points.columns[0]) {
        REQUIRE(std::isfinite(value));
        positive |= value > 0;
        negative |= value < 0;
        if (value != 0) exponents.insert(std::ilogb(value));
    }
    CHECK(positive);
    CHECK(negative);
    for (int e = -24; e < 24; ++e) CHECK(exponents.count(e) == 1);
}

TEST_CASE("the half grid is binary16, rounded once", "[points]")
{
    CHECK(analyze::to_grid(65504, Precision::float16) == 65504.0F);
    CHECK(analyze::to_grid(1e6, Precision::float16) == 65504.0F);
    CHECK(analyze::to_grid(-std::numeric_limits<double>::infinity(), Precision::float16) ==
          -65504.0F);
    CHECK(analyze::to_grid(0x1p-24, Precision::float16) == 0x1p-24F);
    CHECK(analyze::to_grid(0x1.8p-25, Precision::float16) == 0x1p-24F);
    CHECK(analyze::to_grid(0x1p-25, Precision::float16) == 0.0F);      // a tie, to even
    CHECK(analyze::to_grid(1 + 0x1p-11, Precision::float16) == 1.0F);  // a tie, to even
    // Through float first this would become a tie and round down.
    CHECK(analyze::to_grid(1 + 0x1p-11 + 0x1p-40, Precision::float16) == 1.0F + 0x1p-10F);
    CHECK(analyze::to_grid(0.1, Precision::float32) == 0.1F);
    CHECK(analyze::to_grid(-0.1, Precision::float32) == -0.1F);
}
