// Scenes for tests, made by hand: materials, and no geometry, so that all weigh the same.
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace lobe::tests {

/// The same number for all.
scene::Value constant(const scene::Components& value, const std::string& pointer = "");
scene::Value between(const scene::Components& low, const scene::Components& high,
                     const std::string& pointer = "");

/// A dielectric of grey 0.5 and roughness 0.5, with nothing else given.
scene::Material plain(const std::string& name);
scene::Scene scene_of(std::vector<scene::Material> materials);

}  // namespace lobe::tests
