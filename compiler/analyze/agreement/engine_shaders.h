// Whether a patched engine tree's shaders still compile, without the engine.
//
// The tree's own ShadingModels.ush, ShadingModelsMaterial.ush, BRDF.ush and FastMath.ush, and every
// file that the patch adds, go through glslang and spirv-val; what they include beyond these are
// stand-ins of ours (templates/ue4/standins). Two shaders are made: a light shading a pixel of the
// model, and the base pass writing one.
//
// The stand-ins may not fit a tree, so the tree is compiled without the patch first. Where that
// fails, nothing is known and this is said; where only the patched one fails, the patch is wrong.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

struct EngineShaders {
    /// A file of the tree by its path from the root; nothing if there is none.
    using Read = std::function<std::optional<std::string>(const std::string& path)>;
    Read original;
    Read patched;
    std::string folder;            ///< of the shaders: `Engine/Shaders/Private`
    std::string shading_model;     ///< as in SHADINGMODELID_…: `CALLISTO`
    std::string node_function;     ///< of the custom output; empty if the model has no node
    std::vector<int> node_inputs;  ///< components of each of its inputs
};

struct EngineShaderVerdict {
    enum class Result {
        compiles,
        broken,  ///< the patched tree does not compile and the original does
        unknown  ///< neither does: the stand-ins do not fit
    };
    std::string shader;  ///< `lighting`, `base pass`, `base pass without the node`
    Result result{};
    std::string message;  ///< the first complaint, verbatim
};

std::vector<EngineShaderVerdict> check_engine_shaders(const EngineShaders& shaders);

}  // namespace lobe::analyze
