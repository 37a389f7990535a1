// Light from all around in nine numbers per channel: spherical harmonics of bands 0 to 2, enough
// for the irradiance of a diffuse surface within 1 % on average. [Ramamoorthi01]
#pragma once

#include "analyze/environment/cube_map.h"

#include <array>
#include <cstddef>

namespace lobe::analyze {

inline constexpr std::size_t harmonics = 9;

/// The real harmonics Y_lm of a unit vector, in the order (0, 0), (1, -1), (1, 0), (1, 1), (2, -2),
/// … (2, 2): 0.282095; 0.488603 y, z, x; 1.092548 xy, yz; 0.315392 (3 z^2 - 1); 1.092548 xz;
/// 0.546274 (x^2 - y^2). [Ramamoorthi01] eq 3
std::array<double, harmonics> harmonics_at(const Vector& direction);

/// One coefficient per harmonic.
using HarmonicSeries = std::array<Radiance, harmonics>;

/// L_lm = the integral of L Y_lm over the sphere, the radiance constant over each texel's solid
/// angle and the harmonic taken at its middle. [Ramamoorthi01] eq 10
HarmonicSeries radiance_series(const CubeLevel& environment);

/// E_lm = A_l L_lm with A = pi, 2 pi / 3, pi / 4: the irradiance of a surface, by its normal. What
/// EXT_lights_image_based keeps. [Ramamoorthi01] eq 8
HarmonicSeries irradiance_series(const HarmonicSeries& radiance);

/// The sum of coefficients times harmonics. Of `irradiance_series` it is [Ramamoorthi01] eq 13,
/// which the term IrradianceSH of models/environment.lobe computes from radiance coefficients.
Radiance value_of(const HarmonicSeries& series, const Vector& direction);

}  // namespace lobe::analyze
