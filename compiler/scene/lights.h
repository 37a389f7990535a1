// Lights: KHR_lights_punctual, with the sphere and the tube that `extras.lobe` makes of a point,
// and EXT_lights_image_based.
#pragma once

#include "scene/textures.h"

#include <optional>
#include <vector>

namespace lobe::scene {

/// Lights of the file; none has a place in the world yet.
std::vector<Light> read_lights(const View& root);

/// Environments of the file.
std::vector<Environment> read_environments(const View& root, std::size_t image_count,
                                           Textures& textures);
/// Complains of faces whose sizes are not those that the environment gives.
void check_faces(const std::vector<Environment>& environments, const std::vector<Image>& images,
                 Complaints& complaints);

}  // namespace lobe::scene
