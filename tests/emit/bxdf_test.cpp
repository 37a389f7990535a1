// The BxDF that a file for Unreal holds, run as it stands under a point light: it must compute the
// model's outputs from the engine's geometry.
#include "analyze/agreement/agreement.h"
#include "analyze/agreement/judgement.h"
#include "emit/packings.h"
#include "emit/shipped.h"

#include <catch2/catch.hpp>

namespace lobe::tests {
namespace {

constexpr std::size_t count = 4096;

const emit::Target& unreal() { return *emit::find_target("ue4"); }

/// Agreement of a BxDF with its meaning on the software device; the text is as given.
analyze::Agreement run(const emit::BxdfCheck& check, const std::string& text)
{
    std::string why;
    auto device = device::Device::open("", why);
    INFO(why);
    REQUIRE(device.has_value());
    const analyze::Reference reference =
        analyze::reference(check.module, check.function, evaluate::Precision::float32, count);
    REQUIRE(static_cast<std::size_t>(check.harness.inputs) == reference.points.columns.size());
    const auto spirv = analyze::spirv_of(text, unreal(), check.harness.entry);
    REQUIRE_FALSE(spirv.empty());
    std::vector<float> results;
    const auto failure = analyze::execute(*device, reference, check.harness, spirv, results);
    INFO(failure.value_or(""));
    REQUIRE_FALSE(failure.has_value());
    return analyze::compare(reference, results);
}

std::string replaced(std::string text, const std::string& what, const std::string& with)
{
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), with);
}

}  // namespace

TEST_CASE("every output of every BxDF computes what the model says", "[emit][bxdf]")
{
    int checked = 0;
    for (const char* name : {"callisto", "ue4"}) {
        const Shipped input = shipped(name);
        for (const emit::BxdfCheck& check : emit::bxdf_checks(input.module, input.sources)) {
            CAPTURE(check.module[check.function].name);
            const analyze::Agreement agreement = run(check, check.harness.artifact.text);
            INFO((agreement.example ? agreement.example->inputs : ""));
            CHECK(agreement.outside == 0);
            CHECK(agreement.undefined < count / 4);
            ++checked;
        }
    }
    // Two outputs of four models, and of the one that is packed once more.
    CHECK(checked == 10);
}

TEST_CASE("the BxDF of a packed model sees what its packing unpacks", "[emit][bxdf][packing]")
{
    const Builder b = packed_skin();
    const auto checks = emit::bxdf_checks(b.module, b.sources);
    REQUIRE(checks.size() == 2);
    CHECK(checks[0].module[checks[0].function].name == "SkinBxDF_Diffuse");
    const emit::BxdfCheck& packed = checks[1];
    CHECK(packed.module[packed.function].name == "SkinBxDF_Diffuse_packed");
    // Three vectors, the albedo, six channels.
    CHECK(packed.harness.inputs == 3 * 3 + 3 + 6);
    const std::string& text = packed.harness.artifact.text;
    const analyze::Agreement agreement = run(packed, text);
    INFO((agreement.example ? agreement.example->inputs : ""));
    CHECK(agreement.outside == 0);
    CHECK(agreement.undefined < count / 4);

    // One channel for another, and a macro that the model's file does not see.
    CHECK(run(packed, replaced(text, "Skin_UnpackGain( GBuffer.CustomData.x )",
                               "Skin_UnpackGain( GBuffer.CustomData.y )"))
              .outside > 0);
    CHECK(
        run(packed, replaced(text, "#define SKIN_PARAMETERS(", "#define SKIN_PARAMETER(")).outside >
        0);
    CHECK(run(packed, replaced(text, "floor( DGCode * 0.0625 )", "floor( DGCode * 0.0624 )"))
              .outside > 0);
}

TEST_CASE("a BxDF that is wrong in one place is found", "[emit][bxdf]")
{
    const Shipped input = shipped("callisto");
    const auto checks = emit::bxdf_checks(input.module, input.sources);
    REQUIRE(checks.size() >= 2);
    const std::string& diffuse = checks[0].harness.artifact.text;
    CHECK(run(checks[0],
              replaced(diffuse, "saturate( abs( Context.NoV ) + 1e-5 )", "saturate( Context.NoV )"))
              .outside > 0);
    CHECK(run(checks[0], replaced(diffuse, "Context.VoH, VoL", "Context.NoH, VoL")).outside > 0);
    const std::string& specular = checks[1].harness.artifact.text;
    CHECK(run(checks[1], replaced(specular, "float SpecularRoughness = Roughness",
                                  "float SpecularRoughness = Roughness * 1.001"))
              .outside > 0);
    CHECK(run(checks[1], replaced(specular, "bIsSphere = AreaLight.SphereSinAlpha > 0.0",
                                  "bIsSphere = AreaLight.SphereSinAlpha >= 0.0"))
              .outside > 0);
}

}  // namespace lobe::tests
