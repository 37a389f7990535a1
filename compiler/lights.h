// Models under the lights that a scene has, without a file that says so.
//
// models/lights.lobe is part of the program. `with_lights` takes a checked module (one that
// optimize::specialize, narrow or residual made, too) and the names of lights, and gives the
// checked module whose models are shaded under exactly these: what
//
//   import lights { directional, sphere }
//
// does in a file. `middle` then makes `shade_callisto_sphere`, …, and `back` a file of its own with
// them, `callisto_lights`. Other lights are not in the code.
//
// What a host passes is in ir/geometry.h (emitter) and docs/lights.md. For a scene in meters and
// candela: lengths in centimeters, intensities times 10^4. Of scene::Light::Kind,
//
//   directional   directional
//   point         punctual
//   spot          spot
//   sphere        sphere
//   tube          capsule, or tube where the radius is 0
#pragma once

#include "base/source.h"
#include "ir/module.h"
#include "optimize/residual.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// Of models/lights.lobe, in its order: `directional`, `point`, `punctual`, `spot`, …
const std::vector<std::string>& light_names();

/// The module with the shadings of `model`, or of all its own models where that is empty, under
/// these lights; names that are no lights are ignored. The text that spans of lights point into is
/// added to `sources`.
ir::Module with_lights(const ir::Module& checked, const std::vector<std::string>& lights,
                       Sources& sources, std::string_view model = {});

/// The same for lights of which more is known, by their names: fields of the emitter that are
/// constants are no inputs, and ranges of others are narrower. A light that nothing is known of has
/// an empty entry.
ir::Module with_lights(const ir::Module& checked,
                       const std::map<std::string, optimize::Called>& lights, Sources& sources,
                       std::string_view model = {});

}  // namespace lobe
