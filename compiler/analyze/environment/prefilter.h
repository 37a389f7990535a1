// The first half of the split sum: an environment blurred by GGX, a level per roughness, so that a
// shader looks up once what a glossy surface sees.
//
//   level i = sum of L(l) n.l / sum of n.l      n = v = r, over l of GGX half vectors of a
//   roughness
//
// Taking view and normal to be the mirrored direction loses the stretch of highlights at grazing
// angles: that is the split sum's own error. [Karis13]
#pragma once

#include "analyze/environment/cube_map.h"

#include <cstdint>

namespace lobe::analyze {

struct PrefilterOptions {
    int size = 128;  ///< texels along an edge of the sharpest level; the next ones are halves
    int levels = 6;  ///< 1 at least, and no more than halvings of the size
    std::uint32_t samples = 1024;  ///< Hammersley points
    /// Each sample looks up the level of the source whose texels are as large as the solid angle
    /// it stands for, which removes nearly all noise ([Krivanek08]); else the sharpest.
    bool blurs_samples = true;
    unsigned jobs = 0;  ///< threads; 0: all. The result does not depend on it.
};

/// `source` with its levels (see `with_levels`) to one level per roughness: level i of n is for
/// roughness i / (n - 1), so the first is the source itself, mirrored sharply.
CubeMap prefiltered(const CubeMap& source, const PrefilterOptions& options);

/// Which level of such a map a roughness in [0, 1] looks up.
double level_of(double roughness, const CubeMap& prefiltered);

}  // namespace lobe::analyze
