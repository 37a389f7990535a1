// Layered materials: what it costs in accuracy to blend their parameters and shade once, against
// shading every layer and blending the results.
//
// Shading is not linear in its parameters, so the two differ; where they are close, a scene calls
// for one shading, whatever the number of layers. The blend of the results is the yardstick.
// Source: Karis 2013, Real Shading in Unreal Engine 4, section on material layering.
#pragma once

#include "analyze/packing/radiance.h"
#include "ir/module.h"
#include "scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::analyze {

struct LayeredMaterial {
    std::size_t material = 0;  ///< index into Scene::materials
    std::string name;
    std::size_t layers = 0;  ///< over the base
    /// Of the blended parameters, by the measure of packings: relative to the blend of the results,
    /// or to an 18 % gray card where darker. The witness has directions and weights.
    RadianceError error;
    /// Nothing that was found is off by half a step of an 8-bit sRGB display at white, where its
    /// steps are least beside the light: blend the parameters, and shade once.
    bool one_shading_is_enough() const;
};

struct LayeredMaterials {
    std::vector<LayeredMaterial> measured;  ///< in the file's order
    std::size_t not_measured = 0;           ///< beyond `LayerOptions::most`
};

struct LayerOptions {
    std::size_t points = std::size_t{1} << 14;  ///< per material, before the climb
    std::size_t most = 64;                      ///< materials
    unsigned jobs = 0;
};

/// The shown and lit materials that have layers, with the layers of these. The module has been
/// through optimize; a material's values are within the model's ranges (find_facts saw to it).
/// Equal inputs give equal results, whatever the number of threads.
LayeredMaterials layered_materials(const scene::Scene& scene, const ir::Module& module,
                                   const std::string& model, const LayerOptions& options = {});

}  // namespace lobe::analyze
