// The patched shaders compile: every one that the patch touches, with our stand-ins for the rest.
#include "analyze/agreement/engine_shaders.h"
#include "emit/template.h"
#include "engine/models.h"
#include "engine/stand_ins.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

namespace lobe::engine {
namespace {

Files patched(const Files& tree, const Request& request)
{
    const Plan plan = plan_patch(tree_of(tree), shipped_list(), request);
    INFO(shown(plan.obstacles));
    REQUIRE(plan.obstacles.empty());
    return applied(tree, plan);
}

/// What a material gives besides its pins.
struct Material {
    std::vector<std::string> defines;
    std::string outputs;  ///< functions of a custom output node
};

/// What glslang says about a text of the tree; empty if it is accepted.
std::string judged(const Files& tree, const Material& material, std::string_view entry,
                   const std::string& text)
{
    const auto includes = [&](std::string_view name) -> std::optional<std::string> {
        if (const auto own = tree.find(shaders + std::string{name}); own != tree.end())
            return own->second;
        if (name == "Material.ush")
            return data_files("shaders").at("Material.ush") + material.outputs;
        const std::string stand_in = name == "Common.ush" ? "prelude.ush" : std::string{name};
        const auto other = emit::embedded_template("ue4/standins/" + stand_in);
        return other ? std::optional<std::string>{std::string{*other}} : std::nullopt;
    };
    std::string whole;
    for (const std::string& define : material.defines) whole += "#define " + define + "\n";
    const verify::Verdict verdict = verify::compile(whole + text, verify::Dialect::hlsl,
                                                    verify::Stage::fragment, entry, includes);
    if (verdict.accepted)
        return verify::validate(verdict.spirv).accepted ? "" : "spirv-val refuses it";
    std::string why;
    for (const verify::Message& message : verdict.messages) why += message.text + "\n";
    return why + " ";
}

/// Reads a pixel back and lights it.
const std::string decode = R"(
#include "Common.ush"
#include "DeferredShadingCommon.ush"
#include "ShadingModels.ush"

float4 Main(float4 X : TEXCOORD0) : SV_Target0
{
	FGBufferData GBuffer = DecodeGBufferData(X, X.yzwx, X.zwxy, X.wxyz, X, X.yxwz);
	FDirectLighting Lighting = EvaluateBxDF(GBuffer, X.xyz, X.yzx, X.zxy, X.w, (FShadowTerms)0);
	return float4(Lighting.Diffuse + Lighting.Specular, GetShadingModelColor(GBuffer.ShadingModelID).x);
}
)";

const std::vector<std::string> model_defines{"MATERIAL_SHADINGMODEL_CALLISTO 1"};

/// The complaints about all shaders of a tree.
std::string complaints(const Files& tree, const Material& material)
{
    std::string result = judged(tree, material, "Main", decode);
    for (const auto& [file, entry] : std::vector<std::pair<std::string, std::string>>{
             {"BasePassPixelShader.usf", "MainPS"},
             {"AnisotropyPassShader.usf", "MainPixelShader"},
             {"ClusteredDeferredShadingPixelShader.usf", "ClusteredShadingPixelShader"},
             {"TiledDeferredLightShaders.usf", "TiledDeferredLightingMain"}}) {
        const auto shader = tree.find(shaders + file);
        if (shader == tree.end()) continue;
        const std::string why = judged(tree, material, entry, shader->second);
        if (!why.empty()) result += file + ": " + why;
    }
    return result;
}

/// Materials with the model: without its node, with it, and translucent.
std::vector<Material> materials_of(const Wish& wish, const std::vector<std::string>& types)
{
    Material bare{model_defines, ""};
    Material full = bare;
    full.defines.push_back("NUM_MATERIAL_OUTPUTS_CALLISTOADVANCEDPARAMS 2");
    for (std::size_t i = 0; i < types.size(); ++i)
        full.outputs += fmt::format("{} {}{}(FMaterialPixelParameters Parameters) {{ return "
                                    "Parameters.X{}; }}\n",
                                    types[i], wish.node, i, types[i] == "float3" ? ".xyz" : ".x");
    Material translucent = full;
    translucent.defines.push_back("MATERIALBLENDING_TRANSLUCENT 1");
    return {bare, full, translucent};
}

}  // namespace

TEST_CASE("the stand-in shaders compile as they are")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    CAPTURE(version);
    CHECK(complaints(engine_tree(version), {}) == "");
    CHECK(complaints(fork_tree(version), {{"MATERIAL_SHADINGMODEL_EYE 1"}, ""}) == "");
}

TEST_CASE("the patched shaders compile")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    CAPTURE(version);
    const auto check = [&](const Files& tree, const Wish& wish,
                           const std::vector<std::string>& types) {
        const Files done = patched(tree, wished(wish).request);
        CHECK(complaints(done, {}) == "");
        for (const Material& material : materials_of(wish, types))
            CHECK(complaints(done, material) == "");
    };
    check(engine_tree(version), plain_wish(), {"float", "float"});
    check(engine_tree(version), color_wish(), {"float", "float3"});
    check(fork_tree(version), plain_wish(), {"float", "float"});
    if (version != "4.25") check(engine_tree(version), carrier_wish(), {"float", "float"});

    Wish pins = plain_wish();  // every pin there is
    pins.pins = {{"opacity", "diffuse_fresnel_falloff"},
                 {"anisotropy", "smooth_terminator"},
                 {"ambient_occlusion", "retroreflection_falloff"},
                 {"metallic", "diffuse_fresnel"},
                 {"specular", "retroreflection"},
                 {"custom_data0", "specular_fresnel_falloff"}};
    pins.node.clear();
    check(engine_tree(version), pins, {});
}

TEST_CASE("the shipped model's shaders compile")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    const Files done = patched(engine_tree(version), shipped().request);
    CHECK(complaints(done, {model_defines, ""}) == "");
}

TEST_CASE("a shader that lacks what it calls is refused")
{
    Files done = patched(engine_tree("4.27"), wished(plain_wish()).request);
    done.erase(shaders + "CallistoPacking.ush");
    for (const Material& material : materials_of(plain_wish(), {"float", "float"}))
        CHECK(complaints(done, material) != "");
}

TEST_CASE("the check of a user's tree accepts the stand-in trees")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    const Files tree = engine_tree(version);
    const Files done = patched(tree, wished(plain_wish()).request);
    const auto reader = [](const Files& files) {
        return [&files](const std::string& path) -> std::optional<std::string> {
            const auto found = files.find(path);
            if (found == files.end()) return std::nullopt;
            return found->second;
        };
    };
    analyze::EngineShaders shaders_of{
        reader(tree), reader(done), "Engine/Shaders/Private", "CALLISTO", "CallistoAdvancedParams",
        {1, 1}};
    const auto verdicts = analyze::check_engine_shaders(shaders_of);
    CHECK(verdicts.size() >= 2);
    for (const auto& verdict : verdicts) {
        CAPTURE(verdict.shader, verdict.message);
        CHECK(verdict.result == analyze::EngineShaderVerdict::Result::compiles);
    }
}

}  // namespace lobe::engine
