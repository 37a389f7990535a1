// Scenes for tests, made by hand: materials, and no geometry, so that all weigh the same.
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace lobe::tests {

/// The same number for all.
scene::Value constant(std::vector<double> value, const std::string& pointer = "");
scene::Value between(std::vector<double> low, std::vector<double> high,
                     const std::string& pointer = "");

/// A dielectric of grey 0.5 and roughness 0.5, with nothing else given.
scene::Material plain(const std::string& name);
scene::Scene scene_of(std::vector<scene::Material> materials);

}  // namespace lobe::tests
