// A scene and what shades it, to a picture: the evaluator at work, to be looked at.
//
// One bounce: light from the scene's lights, with shadows, and from its environment, with what
// stands in its way; what the models themselves say, over vectors, in float. No light from surface
// to surface. Equal inputs give equal pictures, whatever the number of threads.
#pragma once

#include "ir/module.h"
#include "render/picture.h"
#include "scene/scene.h"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lobe::render {

/// What shades some materials: functions over vectors of one module, which outlives this.
struct Shader {
    const ir::Module* module = nullptr;
    ir::Function radiance;  ///< of light from l: the model's outputs together, f cos_i
    /// The same under one of the scene's lights, of intensity 1, by the light's name in
    /// models/lights.lobe (see analyze::light_name). Lengths are in centimeters.
    std::map<std::string, ir::Function> lit;
};

struct Look {
    std::vector<Shader> shaders;
    std::vector<std::size_t> shader_of;  ///< per material of the scene: index into `shaders`
};

struct RenderOptions {
    int width = 512;
    int height = 512;
    int rays = 2;         ///< squared: places per pixel
    int directions = 64;  ///< of the environment, per place
    unsigned jobs = 0;
    /// Rows of tiles done, of how many; from any thread, one call at a time.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Every light that the scene has must be in every shader's `lit`. A scene without lights
/// and environment is lit by a light at the camera.
Picture render(const scene::Scene& scene, const Look& look, const RenderOptions& options);

}  // namespace lobe::render
