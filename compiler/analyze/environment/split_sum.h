// The second half of the split sum: what a glossy surface with Schlick's Fresnel term reflects of
// an environment that is equally bright everywhere, as a factor of F0 and what is added to it.
//
//   scale = integral of (1 - Fc) D V n.l dl      Fc = (1 - v.h)^5, D = GGX, V = G / (4 n.l n.v)
//   bias  = integral of      Fc  D V n.l dl      over the hemisphere around n
//
// Exactly, by adaptive quadrature, and as engines sum it over importance samples. [Karis13] eq 8
#pragma once

#include "analyze/environment/visibility.h"

#include <cstdint>

namespace lobe::analyze {

struct ScaleAndBias {
    double scale = 0;
    double bias = 0;
};

/// The integrals, each within 1e-11 for a V that is smooth between its ends, as Smith's and
/// Schlick's are. `roughness` in [1/64, 1], `cos_o` in [0, 1].
ScaleAndBias split_sum(const Visibility& visibility, double roughness, double cos_o);

/// The mean of (1 - Fc) G v.h / (n.h n.v) and of Fc G v.h / (n.h n.v) over Hammersley points:
/// what [Karis13] prints, with 1024 samples.
ScaleAndBias sampled_split_sum(const Visibility& visibility, double roughness, double cos_o,
                               std::uint32_t samples);

}  // namespace lobe::analyze
