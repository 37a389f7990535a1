// Nodes: the tree of what stands where. Meshes, lights and cameras of the file's scene get their
// place in the world.
#pragma once

#include "scene/meshes.h"

#include <vector>

namespace lobe::scene {

/// What nodes carry, by index.
struct Carried {
    const Meshes& meshes;
    const std::vector<Light>& lights;
    const std::vector<Environment>& environments;
};

/// `cameras`, `nodes` and `scenes` of the file: fills in instances, lights, cameras and
/// environment.
void place_nodes(const View& root, const Carried& carried, const Limits& limits, Scene& scene);

}  // namespace lobe::scene
