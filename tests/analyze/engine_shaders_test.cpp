// A patched tree's shaders compile, or it is said which do not; a tree that never did is told
// apart.
#include "analyze/agreement/engine_shaders.h"

#include <catch2/catch.hpp>

#include <map>

using namespace lobe::analyze;
using Result = EngineShaderVerdict::Result;

namespace {

using Files = std::map<std::string, std::string>;

EngineShaders::Read reader(const Files& files)
{
    return [&files](const std::string& path) -> std::optional<std::string> {
        const auto found = files.find(path);
        if (found == files.end()) return std::nullopt;
        return found->second;
    };
}

const std::string folder = "Engine/Shaders/Private/";

const std::string lighting_types = R"(
struct FAreaLight { float SphereSinAlpha; float LineCosSubtended; float3 FalloffColor; };
struct FShadowTerms { float SurfaceShadow; float TransmissionShadow; };
struct FDirectLighting { float3 Diffuse; float3 Specular; float3 Transmission; };
)";

std::string dispatcher(const std::string& cases)
{
    return lighting_types + cases +
           "FDirectLighting IntegrateBxDF( FGBufferData GBuffer, half3 N, half3 V, half3 L, float "
           "Falloff, float NoL, FAreaLight AreaLight, FShadowTerms Shadow )\n"
           "{\n\tFDirectLighting Lighting = (FDirectLighting)0;\n"
           "\tLighting.Diffuse = Shade( GBuffer ) * NoL;\n\treturn Lighting;\n}\n";
}

std::string base_pass(const std::string& block)
{
    return "void SetGBufferForShadingModel( in out FGBufferData GBuffer, in const "
           "FMaterialPixelParameters MaterialParameters, const float Opacity, const half3 "
           "BaseColor, const half Metallic, const half Specular, const float Roughness, const "
           "float Anisotropy, const float3 SubsurfaceColor, const float SubsurfaceProfile, const "
           "float Dither, const uint ShadingModel )\n{\n\tGBuffer.ShadingModelID = "
           "ShadingModel;\n" +
           block + "}\n";
}

Files stock()
{
    return {{folder + "ShadingCommon.ush", "#define SHADINGMODELID_DEFAULT_LIT 1\n"
                                           "void NeedsTheEngine( Unknown x );\n"},
            {folder + "BRDF.ush", "#pragma once\nfloat Own( float x ) { return Pow2( x ); }\n"},
            {folder + "ShadingModels.ush",
             "#include \"DeferredShadingCommon.ush\"\n#include \"BRDF.ush\"\n#include "
             "\"SomethingUnknown.ush\"\n" +
                 dispatcher("float3 Shade( FGBufferData GBuffer ) { return Own( GBuffer.Metallic "
                            "); }\n")},
            {folder + "ShadingModelsMaterial.ush", base_pass("")}};
}

/// A model of its own file, called by both shaders.
Files with_model()
{
    Files files = stock();
    files[folder + "ShadingCommon.ush"] += "#define SHADINGMODELID_CLOTH 5\n";
    files[folder + "Cloth.ush"] = "#pragma once\nfloat3 Cloth( float x ) { return x; }\n";
    files[folder + "ShadingModels.ush"] =
        "#include \"DeferredShadingCommon.ush\"\n#include \"/Engine/Private/Cloth.ush\"\n" +
        dispatcher("float3 Shade( FGBufferData GBuffer ) { return SHADINGMODELID_CLOTH * Cloth( "
                   "GBuffer.CustomData.x ); }\n");
    files[folder + "ShadingModelsMaterial.ush"] =
        base_pass("#if MATERIAL_SHADINGMODEL_CLOTH\n"
                  "#if NUM_MATERIAL_OUTPUTS_CLOTHINPUT > 0\n"
                  "\tGBuffer.CustomData.rgb = ClothInput1( MaterialParameters );\n"
                  "#else\n\tGBuffer.CustomData.r = 0.5;\n#endif\n#endif\n");
    return files;
}

std::vector<EngineShaderVerdict> check(const Files& original, const Files& patched)
{
    return check_engine_shaders({.original = reader(original),
                                 .patched = reader(patched),
                                 .folder = "Engine/Shaders/Private",
                                 .shading_model = "CLOTH",
                                 .node_function = "ClothInput",
                                 .node_inputs = {1, 3}});
}

}  // namespace

TEST_CASE("a sound patch compiles, with and without its node")
{
    const auto verdicts = check(stock(), with_model());
    REQUIRE(verdicts.size() == 3);
    for (const EngineShaderVerdict& verdict : verdicts) {
        CAPTURE(verdict.shader, verdict.message);
        CHECK(verdict.result == Result::compiles);
    }
}

TEST_CASE("what the patch breaks is told, with the compiler's words")
{
    Files patched = with_model();
    patched[folder + "Cloth.ush"] = "#pragma once\nfloat3 Cloth( float x ) { return y; }\n";
    auto verdicts = check(stock(), patched);
    CHECK(verdicts[0].result == Result::broken);
    CHECK_THAT(verdicts[0].message, Catch::Contains("y"));
    CHECK(verdicts[1].result == Result::compiles);

    patched = with_model();
    patched[folder + "ShadingModelsMaterial.ush"] =
        base_pass("#if MATERIAL_SHADINGMODEL_CLOTH\n"
                  "\tGBuffer.CustomData.rgb = ClothInput1( MaterialParameters );\n#endif\n");
    verdicts = check(stock(), patched);
    CHECK(verdicts[1].result == Result::compiles);
    // An unguarded custom output: materials without the node do not compile.
    CHECK(verdicts[2].result == Result::broken);
}

TEST_CASE("a tree that the stand-ins do not fit is told apart from a broken patch")
{
    Files original = stock();
    original[folder + "ShadingModels.ush"] += "float NotKnown( FUnknownToUs x );\n";
    Files patched = with_model();
    patched[folder + "ShadingModels.ush"] += "float NotKnown( FUnknownToUs x );\n";
    const auto verdicts = check(original, patched);
    CHECK(verdicts[0].result == Result::unknown);
    CHECK_FALSE(verdicts[0].message.empty());
    CHECK(verdicts[1].result == Result::compiles);
}
