// What the lights of a scene give to the light functions of a shader.
//
// Fields are those of an emitter (ir/geometry.h). Lengths are in centimeters, as lights.h has them;
// a host computes them in float, and so ends that are no floats lie a little further out.
#pragma once

#include "optimize/residual.h"
#include "scene/scene.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::analyze {

/// What models/lights.lobe calls a light that shines as this one does.
std::string light_name(const scene::Light& light);

/// By these names: the range of each field over the lights of that name, and its value where that
/// is 0 or 1 for all of them.
std::map<std::string, optimize::Called> emitter_facts(const std::vector<scene::Light>& lights);

}  // namespace lobe::analyze
