// Whether what a shader takes from an environment, its coarser levels and its coefficients, is what
// the sharpest level comes to: a file's may have been made for another convention, or from another
// picture.
#pragma once

#include "analyze/environment/cube_map.h"
#include "analyze/environment/harmonics.h"

#include <vector>

namespace lobe::analyze {

/// Root mean squares over all directions and channels, of the mean of what should be there.
struct EnvironmentErrors {
    double irradiance = 0;
    std::vector<double> levels;  ///< of radiance; one for each level behind the sharpest
};

/// Level i of n is taken to be for roughness i / (n - 1), as `prefiltered` has it, whose noise of a
/// few percent for small bright spots is in the result. The map has a level, and shines.
EnvironmentErrors environment_errors(const CubeMap& given, const HarmonicSeries& irradiance,
                                     unsigned jobs);

}  // namespace lobe::analyze
