// The slope over a box contains the slope of every chord in it: that is what lets a proof look at
// the faces of a box alone.
#include "check/analysis.h"
#include "check/checking.h"
#include "check/derivative.h"

#include <catch2/catch.hpp>

#include <random>

using namespace lobe;
using namespace lobe::check;
using lobe::tests::check_text;

namespace {

/// Bodies that together use every operation, over x and y in [-2, 2], u and w in [0.1, 1].
const std::vector<std::string> bodies{
    "x + y * u - w",
    "x * y * u",
    "u / w",
    "x / (u + w)",
    "-x",
    "abs(x - y)",
    "sign(x) + y",
    "floor(3 * x)",
    "sqrt(u * w)",
    "inversesqrt(u + w)",
    "exp(x * u)",
    "exp2(x - y)",
    "log(u * w)",
    "log2(u / w)",
    "sin(x * y)",
    "cos(x + y)",
    "tan(u * w)",
    "asin(u * w)",
    "acos(u - w)",
    "atan(x * y)",
    "saturate(x + y)",
    "min(x, y) * u",
    "max(x * u, y)",
    "step(x, y) + u",
    "clamp(x, y, y + w)",
    "lerp(x, y, u)",
    "lerp(u, w, x)",
    "smoothstep(x, y, u)",
    "smoothstep(u, w, x)",
    "x^3 - y^2",
    "u^y",
    "u^-2 * w^0.5",
    "(u + w)^(x * y)",
    "if x > y then u else w",
    "if x > 0 then x else 0",
    "if u > 0.5 then x else y",
    "if x > 0 and y > 0 then x * y else 0",
    "dot(float3(x, y, u), float3(w, x, y))",
    "length(float2(u, w + x^2))",
    "cross(float3(x, y, u), float3(u, x, w)).y",
    "normalize(float3(x, y, u)).z",
    "float3(x, y, u).y * w",
    "x / u else 0",
    "u / x else 1",
};

}  // namespace

TEST_CASE("slopes over boxes contain the slopes of chords", "[check][derivative]")
{
    std::mt19937 random{7};
    const auto uniform = [&random](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
    };
    for (const std::string& body : bodies) {
        CAPTURE(body);
        const auto checked = check_text(
            "/// f\nterm f(x: float in [-2, 2], y: float in [-2, 2], u: float in [0.1, 1], "
            "w: float in [0.1, 1]) = " +
            body);
        CAPTURE(checked.errors());
        const ir::Function& function = checked.function("f");
        const Flat flat = flatten({}, function, {&function.result, 1}, {}, Calls::taken_in);
        Analysis values{flat};
        std::vector<ScalarInput> inputs;
        for (std::uint32_t i = 0; i < 4; ++i) inputs.push_back({i, 0});
        Analysis slopes{differentiate(flat, flat.roots[0], inputs)};

        const Box declared = values.declared();
        for (int trial = 0; trial < 200; ++trial) {
            Box box = declared;
            for (Interval& range : box) {
                const double a = uniform(range.low, range.high);
                const double b = uniform(range.low, range.high);
                range = {std::min(a, b), std::max(a, b)};
            }
            Box extended = box;
            extended.push_back({0, HUGE_VAL});
            extended.push_back({-HUGE_VAL, HUGE_VAL});
            const auto bounds = slopes.ranges(extended);

            std::vector<double> from;
            for (const Interval& range : box) from.push_back(uniform(range.low, range.high));
            const std::size_t axis = static_cast<std::size_t>(trial) % 4;
            std::vector<double> to = from;
            to[axis] = uniform(box[axis].low, box[axis].high);
            const double length = to[axis] - from[axis];
            // Below this, double rounding of both values is no longer small against their
            // difference: values here are below 1e3, so their error is below 1e-12.
            if (std::abs(length) < 1e-3) continue;
            const double chord = (values.values(to)[0][0] - values.values(from)[0][0]) / length;
            const double rounding = 1e-12 / std::abs(length);
            CAPTURE(axis, box[axis].low, box[axis].high, bounds[axis][0].low, bounds[axis][0].high);
            CHECK(chord >= bounds[axis][0].low - rounding);
            CHECK(chord <= bounds[axis][0].high + rounding);
        }
    }
}

TEST_CASE("a slope that has one sign is seen to have it", "[check][derivative]")
{
    const auto slope = [](const std::string& body, std::uint32_t input) {
        const auto checked = check_text("/// f\nterm f(x: unit, y: unit) = " + body);
        const ir::Function& function = checked.function("f");
        const Flat flat = flatten({}, function, {&function.result, 1}, {}, Calls::taken_in);
        Analysis slopes{differentiate(flat, flat.roots[0], {{input, 0}})};
        return slopes.ranges(slopes.declared())[0][0];
    };
    CHECK(slope("x + (1 - x) * (1 - y)^5", 0).low >= 0);
    CHECK(slope("x + (1 - x) * (1 - y)^5", 1).high <= 0);
    CHECK(slope("smoothstep(0, x, y)", 0).high <= 0);
    CHECK(slope("smoothstep(0, x, y)", 1).low >= 0);
    CHECK(slope("min(x, y)", 0).low >= 0);
    CHECK(slope("x^y", 0).low >= 0);
    CHECK(slope("x^y", 1).high <= 0);
    CHECK(slope("if y > 0.5 then x else 2 * x", 0) == Interval{1, 2});
}
