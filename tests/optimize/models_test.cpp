// The promises of the whole pipeline, on the models that ship.
#include "directions.h"
#include "models.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/stabilize.h"

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using evaluate::Real;

namespace {

/// Unit vectors above the horizon with a tangent frame, and every other input of the function
/// somewhere in its range.
Points<Real> points_for(const Module& module, const Function& entry)
{
    std::mt19937 random{17};
    Points<Real> points = directions(random, 40, 0.5, 0.3);
    const std::size_t count = points["l.x"].size();
    const auto constant = [&](const std::string& name, double value) {
        points[name] = std::vector<Real>(count, Real{value, real_bits});
    };
    for (const char* name : {"x.x", "y.y"}) constant(name, 1);
    for (const char* name : {"x.y", "x.z", "y.x", "y.z"}) constant(name, 0);
    for (const evaluate::TapeInput& input : evaluate::compile(module, entry).inputs) {
        if (points.contains(input.name)) continue;
        const Range range = entry.inputs[input.input].range;
        std::uniform_real_distribution<double> pick{range.low, range.high};
        auto& column = points[input.name];
        for (std::size_t i = 0; i < count; ++i) column.emplace_back(pick(random), real_bits);
    }
    return points;
}

}  // namespace

TEST_CASE("every shipped model is legal, settled and unchanged over the real numbers")
{
    for (const char* path : {"../models/microfacet.lobe", "../models/callisto.lobe",
                             "../models/ue4.lobe", "../models/environment.lobe"}) {
        CAPTURE(path);
        const Module module = read_model(path);
        const Module optimized = optimize::optimize(module);
        REQUIRE_FALSE(verify(optimized));
        REQUIRE_FALSE(optimize::illegal(optimized));
        CHECK(optimize::same_graphs(optimize::optimize(optimized), optimized));

        for (const FunctionId id : module.roots()) {
            CAPTURE(module[id].name);
            const Function before = entry_point(module, id);
            const Function after = entry_point(optimized, id);
            const auto points = points_for(module, before);
            const auto expected = values(module, before, points);
            const auto actual = values(optimized, after, points);
            REQUIRE(expected.size() == actual.size());
            // 1 - cos loses at most 30 bits of the 200 at these angles. Blinn's exponent is at most
            // 2^25, and the polynomial's logarithm at most log2(16/15), to 2^-31.
            const bool is_large_power = module[id].name == "D_BlinnPhong";
            const double slack = is_large_power ? 0x1p25 * 0.0932 * 0.7 * 0x1p-31 : 0x1p-140;
            for (std::size_t i = 0; i < expected.size(); ++i)
                CHECK(difference(expected[i], actual[i]) < slack);
        }
    }
}

TEST_CASE("the terms whose cancellations are known are the ones that are cured")
{
    const auto cured = [](const char* path) {
        std::vector<optimize::Application> log;
        const Module module = read_model(path);
        optimize::stabilize(optimize::simplify(module), log);
        std::vector<std::string> found;
        for (const optimize::Application& application : log)
            found.push_back(module[application.function].name + ": " +
                            std::string{application.rule->name});
        return found;
    };
    CHECK(cured("../models/microfacet.lobe") ==
          std::vector<std::string>{"D_Beckmann: sine_squared_h", "D_GGX: blend_h",
                                   "D_GGX_mobile: blend_h",
                                   "G1_SmithBeckmann: difference_of_squares"});
    const auto in_callisto = cured("../models/callisto.lobe");
    // 1 + x + x^2 in alpha_s needs no better x than 1 - cos, but both are computed anyway.
    for (const char* expected :
         {"D_GGX: blend_h", "F_Callisto: one_minus_argument", "blend_weight: one_minus_argument",
          "alpha_s: power_of_complement", "alpha_s: one_minus_cos_d", "alpha_s: one_minus_cos_h"}) {
        CAPTURE(expected);
        CHECK(std::find(in_callisto.begin(), in_callisto.end(), expected) != in_callisto.end());
    }
}
