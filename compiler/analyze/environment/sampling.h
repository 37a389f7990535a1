// Points that cover a square evenly, and half vectors that follow GGX: what sums over an
// environment are taken at.
#pragma once

#include "analyze/directions.h"

#include <cstdint>

namespace lobe::analyze {

/// A place in [0, 1)^2.
struct SquarePoint {
    double x = 0;
    double y = 0;
};

/// The binary digits of `index` mirrored at the point: 1 -> 0.1, 2 -> 0.01, 3 -> 0.11. Exact.
/// [Dammertz12]
double radical_inverse(std::uint32_t index);

/// Point `index` of `count`: x = index / count, y its radical inverse. [Dammertz12]
SquarePoint hammersley(std::uint32_t index, std::uint32_t count);

/// The half vector for two uniform numbers: its density per steradian is D_GGX cos_h. The normal is
/// z; `alpha` in (0, 1]. The term ImportanceSampleGGX of models/environment.lobe is the same.
/// [Karis13] [Walter07] eq 35, 36
Vector importance_sample_ggx(SquarePoint at, double alpha);

/// [Walter07] eq 33, for a cosine to the normal. The half vector's density is D cos_h.
double density_ggx(double cos_h, double alpha);

/// v mirrored at h: 2 (v.h) h - v.
Vector mirrored(const Vector& v, const Vector& h);

double dot(const Vector& a, const Vector& b);
Vector normalized(const Vector& v);

}  // namespace lobe::analyze
