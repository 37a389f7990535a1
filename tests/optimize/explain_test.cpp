// Every named action: it is told where it is taken, keeps the value over the real numbers, and
// costs float nothing.
#include "directions.h"
#include "models.h"
#include "optimize/explain.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/spelling.h"
#include "values.h"

#include <set>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::Action;

namespace {

struct Example {
    const char* action;
    const char* body;
    /// A point that the guard is there for; empty where the action is none.
    Points<float> hazard = {};
    /// What it may change over the real numbers.
    double slack = real_slack;
};

/// Over x, y in [0, 1], s in [1, 2], p in [0, 4], colors c and d, and a direction-free vector w.
const std::vector<Example> examples{
    {"quotient_times_divisor", "(x / s) * s"},
    {"premultiplied_sum", "(0.19 / s + 0.55 * x) * s"},
    {"premultiplied_sum", "s * -(x + y / s)"},
    {"premultiplied_sum", "(0.19 / (x + 1e-4) + 0.55 * y) * (x + 1e-4)"},
    {"limit_times_divisor", "(x / y else 2) * y", {{"x", {0.5F}}, {"y", {0}}}},
    {"square_of_root", "sqrt(x) * sqrt(x)"},
    {"quotient_by_root", "s / sqrt(s)"},
    {"cosine_of_angle", "cos(acos(x))"},
    {"cosine_of_angle", "sin(asin(x))"},
    {"sine_of_angle", "sin(acos(x))"},
    {"sine_of_angle", "cos(asin(x))"},
    // |y log2(1 - x)| is at most 4000 log2(16/15) where the polynomial counts, or 373.
    {"power_near_one", "(1 - x)^(1000 * p)", {}, 373 * 0.7 * 0x1p-31},
    {"scalars_first", "luminance(c * x * y)"},
    {"gated_scalar", "luminance(if x > y then c * s else 0)"},
    {"blend_from_one", "luminance(lerp(1, c * x, y))"},
    {"blend_to_scalar", "luminance(lerp(1, x, c * y))"},
    {"blend_to_one", "luminance(c + (1 - c) * x)"},
    {"whole_power", "x^5"},
    {"half_power", "x^2.5"},
    {"power_of_two", "2^x"},
    {"joined_powers", "s^p * (1 + x)^y"},
    {"joined_powers", "x^(5 * p) * y^(5 * x)", {{"x", {0}}, {"y", {0}}, {"p", {0}}}},
    {"guarded_power", "x^p", {{"x", {0}}, {"p", {0}}}},
    {"power_without_guard", "s^p"},
    {"power_without_guard", "x^(p + 1.25)"},
    {"held_base", "(1.0000001 - 0.3 * x - 0.7 * x)^1.7"},
    {"guarded_smoothstep", "smoothstep(0, x, y)", {{"x", {0}}, {"y", {0}}}},
    {"smoothstep_without_guard", "smoothstep(x, 1 + s, y)"},
    {"guarded_normalize",
     "dot(normalize(float3(x, y, 0)), float3(1, 0, 0))",
     {{"x", {0}}, {"y", {0}}}},
    {"normalize_without_guard", "dot(normalize(float3(s, s, s)), float3(1, 0, 0))"},
    {"guarded_quotient", "x / y else 1", {{"x", {0}}, {"y", {0}}}},
    {"held_divisor", "1 / (1.0000001 - 0.3 * x - 0.7 * x)"},
    {"held_root", "sqrt(1.0000001 - 0.3 * x - 0.7 * x)"},
    {"held_logarithm", "log2(1.0000001 - 0.3 * x - 0.7 * x)"},
    {"held_inverse_root", "inversesqrt(1.0000001 - 0.3 * x - 0.7 * x)"},
    {"held_angle", "acos(x * 1.0000000001 - 0.0000000001)"},
};

Module module_of(const std::string& body)
{
    return read_text("module test\n/// f\nterm f(x: unit, y: unit, s: float in [1, 2], "
                     "p: float in [0, 4], c: color) = " +
                     body + "\n");
}

double worst(const Module& module, const Points<float>& points)
{
    const auto computed = values(module, module.functions[0], points);
    const auto exact = values(module, module.functions[0], widened(points));
    double result = 0;
    for (std::size_t i = 0; i < computed.size(); ++i) {
        const double truth = exact[i].to_double();
        const double off = std::fabs(static_cast<double>(computed[i]) - truth);
        // What falls below 2^-20 is dark.
        result = std::fmax(result, off / std::fmax(std::fabs(truth), 0x1p-20));
    }
    return result;
}

}  // namespace

TEST_CASE("every action is told, keeps the value over the reals, and costs float nothing")
{
    for (const Example& example : examples) {
        CAPTURE(example.action, example.body);
        const Module before = module_of(example.body);
        std::vector<optimize::Note> notes;
        const Module after = optimize::optimize(before, notes);
        REQUIRE_FALSE(verify(after));
        CHECK(optimize::same_graphs(after, optimize::optimize(before)));
        const auto told = std::find_if(notes.begin(), notes.end(), [&](const auto& note) {
            return note.action.name == example.action;
        });
        REQUIRE(told != notes.end());
        CHECK(told->function.index == 0);
        CHECK(told->span.end > told->span.begin);

        std::mt19937 random{31};
        // Inside of the ranges: at 0 a guard's least number shows over the reals, and at 1 the
        // rounding of pi / 2.
        auto inside = sample(before, before.functions[0], random, 200);
        for (auto& [name, column] : inside)
            for (double& value : column)
                if (value == 0 || value == 1) value = value == 0 ? 0.125 : 0.875;
        const auto expected = values(before, before.functions[0], in_real(inside));
        const auto actual = values(after, after.functions[0], in_real(inside));
        for (std::size_t i = 0; i < expected.size(); ++i)
            CHECK(difference(expected[i], actual[i]) < example.slack);

        const Module written = optimize::spell(before, optimize::Spelling::as_written);
        Points<float> points;
        for (const auto& [name, column] : inside)
            for (const double value : column) points[name].push_back(static_cast<float>(value));
        // Three roundings of a half unit: what a sum in another order may differ by.
        CHECK(worst(after, points) <= worst(written, points) + 3 * 0x1p-24);
    }
}

TEST_CASE("a guard has a value where the bare operation has none")
{
    for (const Example& example : examples) {
        if (example.hazard.empty()) continue;
        CAPTURE(example.action, example.body);
        const Module before = module_of(example.body);
        const Module after = optimize::optimize(before);
        Points<float> point = example.hazard;
        for (const char* name : {"x", "y", "s", "p", "c.r", "c.g", "c.b"})
            point.try_emplace(name, std::vector<float>{1});
        CHECK(std::isfinite(values(after, after.functions[0], point)[0]));
        CHECK(values(after, after.functions[0], point)[0] ==
              values(before, before.functions[0], point)[0]);
        // The target's own precision table promises nothing for the naive spelling there.
        const Module naive = optimize::spell(before, optimize::Spelling::naive);
        const auto undefined = [&](const Module& module) {
            const evaluate::Tape tape = evaluate::compile(module, module.functions[0]);
            std::vector<evaluate::Acceptance> inputs;
            for (const evaluate::TapeInput& input : tape.inputs) {
                const double value = static_cast<double>(point.at(input.name)[0]);
                inputs.push_back({value, value, false});
            }
            std::vector<const evaluate::Acceptance*> in;
            for (const auto& input : inputs) in.push_back(&input);
            evaluate::Acceptance result;
            std::array<evaluate::Acceptance*, 1> out{&result};
            evaluate::run_acceptance(tape, evaluate::Precision::float32, in, out, 1);
            return result.undefined;
        };
        CHECK(undefined(naive));
        CHECK_FALSE(undefined(after));
    }
}

TEST_CASE("every action has an example")
{
    std::set<std::string_view> shown;
    for (const Example& example : examples) shown.insert(example.action);
    for (const Action& action : optimize::actions()) {
        CAPTURE(action.name);
        CHECK(shown.contains(action.name));
        CHECK_FALSE(action.reason.empty());
    }
    CHECK(shown.size() == optimize::actions().size());
}

TEST_CASE("the rules of stabilize are told like the others")
{
    const Module module = read_text("module test\n/// f\nterm f(g: geometry) = 1 - g.cos_h\n");
    std::vector<optimize::Note> notes;
    optimize::optimize(module, notes);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].action.name == "one_minus_cos_h");
    CHECK(notes[0].action.kind == Action::Kind::rewrite);
    CHECK(notes[0].action.replacement == "k one_minus_cos_h");
}
