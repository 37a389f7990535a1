// A certificate says that a residual shader is the general one on everything a scene can show, and
// it must be able to say that it is not.
#include "analyze/checked.h"
#include "analyze/residual/certificate.h"
#include "compile.h"
#include "lights.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::analyze;
using tests::Checked;
using tests::checked_model;

namespace {

const Checked& callisto()
{
    static const Checked checked = checked_model("../models/callisto.lobe");
    return checked;
}

/// All parameters at their defaults but for these; all effects off but for these.
optimize::Called called(const ir::Module& module, const optimize::Settings& settings,
                        const optimize::Limits& ranges, const std::set<std::string>& on)
{
    optimize::Called result;
    result.constants = settings;
    result.ranges = ranges;
    for (const ir::Parameter& parameter : module.parameters)
        if (!ranges.contains(parameter.name))
            result.constants.try_emplace(parameter.name, parameter.default_value);
    for (const ir::Effect& effect : module.effects)
        if (!on.contains(effect.name)) result.off.insert(effect.name);
    return result;
}

CertificateOptions few_points()
{
    CertificateOptions options;
    options.points = 4096;
    return options;
}

Certificate certified(const optimize::Called& what, const optimize::Residual& residual)
{
    return certify(callisto().module, callisto().sources, "callisto", {{&what, &residual}},
                   few_points(), {})
        .front();
}

}  // namespace

TEST_CASE("where nothing is called for, residual and general are one graph")
{
    const auto what = called(callisto().module, {}, {}, {});
    const Certificate certificate =
        certified(what, optimize::residual(callisto().module, what, "callisto"));
    CHECK(certificate.ok());
    REQUIRE(certificate.outputs.size() == 2);
    for (const Equality& output : certificate.outputs) {
        CAPTURE(output.output);
        CHECK(output.same_graph);
        CHECK(output.points == 1024);  // a quarter: they are proved
        CHECK(output.outside == 0);
        CHECK(output.device_outside == 0);
        CHECK_FALSE(output.device.empty());
        // Of exact values nothing is left but their own rounding to double, beside float's.
        CHECK(output.worst < 1);
    }
}

TEST_CASE("constants and ranges of a scene keep what the model means")
{
    const auto what = called(callisto().module,
                             {{"retroreflection_falloff", {0.7}},
                              {"retroreflection_tint", {1, 0.9, 0.7}},
                              {"specular_fresnel_falloff", {0.4}}},
                             {{"retroreflection", {1, 8}}, {"roughness", {0.3, 0.6}}},
                             {"Retroreflection", "Specular Fresnel"});
    const Certificate certificate =
        certified(what, optimize::residual(callisto().module, what, "callisto"));
    for (const Equality& output : certificate.outputs) {
        CAPTURE(output.output, output.worst);
        CHECK(output.ok());
        CHECK(output.worst < 1);
    }
}

TEST_CASE("a residual of other constants is found out")
{
    const auto what =
        called(callisto().module, {{"retroreflection", {4}}}, {}, {"Retroreflection"});
    auto other = what;
    other.constants["retroreflection"] = {4.001};
    const Certificate certificate =
        certified(what, optimize::residual(callisto().module, other, "callisto"));
    CHECK_FALSE(certificate.ok());
    CHECK_FALSE(certificate.outputs[0].same_graph);
    CHECK(certificate.outputs[0].outside > 0);
    CHECK(certificate.outputs[0].device_outside > 0);
    CHECK(certificate.outputs[0].worst > 1);
    // The specular lobes know nothing of it.
    CHECK(certificate.outputs[1].ok());
}

TEST_CASE("an effect that was left out although it is called for is found out")
{
    const auto what =
        called(callisto().module, {{"smooth_terminator", {0.5}}}, {}, {"Smooth Terminator"});
    const auto nothing = called(callisto().module, {}, {}, {});
    const Certificate certificate =
        certified(what, optimize::residual(callisto().module, nothing, "callisto"));
    CHECK_FALSE(certificate.ok());
    for (const Equality& output : certificate.outputs) CHECK(output.outside > 0);
}

namespace {

std::vector<Dropped> dropped(const optimize::Called& what, double epsilon)
{
    return droppable(callisto().module, "callisto", what, epsilon, few_points());
}

}  // namespace

TEST_CASE("a terminator of 0.004 may go for one percent, and not for less than it does")
{
    const auto what =
        called(callisto().module, {{"smooth_terminator", {0.004}}}, {}, {"Smooth Terminator"});
    const auto some = dropped(what, 0.01);
    REQUIRE(some.size() == 1);
    CHECK(some[0].effect == "Smooth Terminator");
    // c2 is 1 - 0.004 mask (1 - smoothstep), and what is beside 0.004 lies in [0, 1]: radiance is
    // darker by at most 0.004, relative to what is left by 0.004 / 0.996.
    CHECK(some[0].observed <= some[0].bound);
    CHECK(some[0].bound <= 0.004 / 0.996 * (1 + 1e-9));
    CHECK(dropped(what, some[0].observed / 2).empty());
}

TEST_CASE("a gain of 1.02 changes radiance by no more than its own share")
{
    const auto what =
        called(callisto().module, {{"retroreflection", {1.02}}}, {}, {"Retroreflection"});
    const auto some = dropped(what, 0.05);
    REQUIRE(some.size() == 1);
    // Diffuse light is 1 to 1.02 times what it was, and specular light the same.
    CHECK(some[0].bound <= 0.02 / 1.02 * (1 + 1e-9));
    CHECK(some[0].observed <= some[0].bound);
    CHECK(dropped(what, 0.01).empty());
}

TEST_CASE("effects go together as long as their bounds allow it")
{
    const auto what =
        called(callisto().module, {{"retroreflection", {1.02}}, {"smooth_terminator", {0.004}}}, {},
               {"Retroreflection", "Smooth Terminator"});
    const auto one = dropped(what, 0.02);
    REQUIRE(one.size() == 1);
    CHECK(one[0].effect == "Smooth Terminator");
    const auto both = dropped(what, 0.025);
    REQUIRE(both.size() == 2);
    CHECK((1 + both[0].bound) * (1 + both[1].bound) - 1 < 0.025);

    // What is left equals the general model where they are off.
    auto without = what;
    for (const Dropped& each : both) without.off.insert(each.effect);
    const auto residual = optimize::residual(callisto().module, without, "callisto");
    CHECK(residual.off.size() == callisto().module.effects.size());
    const Certificate certificate = certify(callisto().module, callisto().sources, "callisto",
                                            {{&without, &residual, both}}, few_points(), {})
                                        .front();
    CHECK(certificate.ok());
    CHECK(certificate.dropped.size() == 2);
}

TEST_CASE("what no proof holds together stays")
{
    // A second lobe of twice the roughness outshines the first far from its peak, by what the two
    // alphas say together: the ratio of unlike expressions, which no bound here knows.
    const auto what =
        called(callisto().module, {{"dual_specular_opacity", {0.001}}}, {}, {"Dual Specular"});
    CHECK(dropped(what, 0.05).empty());

    CertificateOptions options = few_points();
    options.epsilon = 0.05;
    options.execute = false;
    const auto residual = optimize::residual(callisto().module, what, "callisto");
    const Certificate certificate = certify(callisto().module, callisto().sources, "callisto",
                                            {{&what, &residual}}, options, {})
                                        .front();
    CHECK(certificate.ok());
    REQUIRE(certificate.kept.size() == 1);
    CHECK(certificate.kept[0].effect == "Dual Specular");
    CHECK(certificate.kept[0].observed < options.epsilon);
    CHECK(certificate.kept[0].bound >= options.epsilon);
}

TEST_CASE("ranges count with their worst end")
{
    const auto what = called(callisto().module, {}, {{"smooth_terminator", {-0.01, 0.02}}},
                             {"Smooth Terminator"});
    const auto some = dropped(what, 0.05);
    REQUIRE(some.size() == 1);
    CHECK(some[0].bound <= 0.02 / 0.98 * (1 + 1e-9));
    CHECK(some[0].observed <= some[0].bound);
    CHECK(some[0].observed > 0.01);
}

namespace {

/// Callisto's base under these lights, against the general model under them.
Certificate lit(const std::map<std::string, optimize::Called>& told,
                const std::map<std::string, optimize::Called>& scene,
                const optimize::Settings& surface = {}, std::size_t points = 1024)
{
    Sources sources = callisto().sources;
    std::vector<std::string> names;
    for (const auto& [name, emitter] : told) names.push_back(name);
    const ir::Module general = with_lights(callisto().module, names, sources, "callisto");
    const auto what = called(callisto().module, surface, {}, {});
    optimize::Residual residual = optimize::residual(callisto().module, what, "callisto");
    residual.module = with_lights(residual.module, told, sources, "callisto");
    CertificateOptions options = few_points();
    options.points = points;
    return certify(general, sources, "callisto", {{&what, &residual, {}, &scene}}, options, {})
        .front();
}

optimize::Called emitter(const std::string& field, ir::Range range)
{
    optimize::Called out;
    out.ranges[field] = range;
    if (range.low == range.high) out.constants[field] = {range.low};
    return out;
}

}  // namespace

TEST_CASE("lights of a scene are certified with what it says of them")
{
    const std::map<std::string, optimize::Called> scene{
        {"directional", {}},
        {"punctual", emitter("inverse_range", {0, 0})},
        {"sphere", emitter("radius", {20, 40})}};
    const Certificate certificate = lit(scene, scene);
    REQUIRE(certificate.outputs.size() == 5);
    CHECK(certificate.outputs[2].output == "under directional");
    CHECK(certificate.outputs[2].same_graph);
    CHECK(certificate.outputs[3].output == "under punctual");
    CHECK(certificate.outputs[4].output == "under sphere");
    for (const Equality& output : certificate.outputs) {
        CAPTURE(output.output, output.worst);
        CHECK(output.ok());
        CHECK_FALSE(output.device.empty());
    }
}

TEST_CASE("a material of known numbers is certified under a light, wherever that is")
{
    // Hostile points have lights at distances whose squares are no floats: with what stands for a
    // direction there, |n x h|^2 and 1 - n.h^2 are different numbers. And with numbers in the place
    // of roughness and F0 there is nothing left of the general shader's cancellations.
    const std::map<std::string, optimize::Called> scene{{"directional", {}}};
    const Certificate certificate =
        lit(scene, scene,
            {{"roughness", {0.5}}, {"diffuse_color", {0.5, 0.5, 0.5}}, {"f0", {0.04, 0.04, 0.04}}},
            65536);
    REQUIRE(certificate.outputs.size() == 3);
    CHECK(certificate.outputs[2].points == 16384);
    for (const Equality& output : certificate.outputs) {
        CAPTURE(output.output, output.worst, output.outside, output.device_outside);
        CHECK(output.ok());
    }
}

TEST_CASE("a light without the window that the scene's lights need is found out")
{
    const Certificate certificate = lit({{"punctual", emitter("inverse_range", {0, 0})}},
                                        {{"punctual", emitter("inverse_range", {0.001, 0.1})}});
    REQUIRE(certificate.outputs.size() == 3);
    CHECK(certificate.outputs[0].ok());
    CHECK(certificate.outputs[1].ok());
    CHECK(certificate.outputs[2].outside > 0);
    CHECK(certificate.outputs[2].device_outside > 0);
    CHECK_FALSE(certificate.ok());
}

TEST_CASE("only what a scene's lights need is in their functions")
{
    Sources sources = callisto().sources;
    const auto inputs_of = [&](const std::map<std::string, optimize::Called>& lights,
                               const std::string& function) {
        const ir::Module module =
            middle(with_lights(callisto().module, lights, sources, "callisto"));
        std::string names;
        for (const ir::Input& input : module[*module.find(function)].inputs)
            if (input.origin == ir::Origin::emitter) names += input.name + " ";
        return names;
    };
    const std::string point = "shade_callisto_punctual";
    CHECK(inputs_of({{"punctual", {}}}, point) == "to_light inverse_range ");
    CHECK(inputs_of({{"punctual", emitter("inverse_range", {0, 0})}}, point) == "to_light ");
    // What one light's function knows, another's does not.
    const std::map<std::string, optimize::Called> both{
        {"punctual", emitter("inverse_range", {0, 0})},
        {"spot", emitter("inverse_range", {0.001, 0.1})}};
    CHECK(inputs_of(both, point) == "to_light ");
    CHECK(inputs_of(both, "shade_callisto_spot") ==
          "to_light axis inverse_range cos_inner cos_outer ");
}
