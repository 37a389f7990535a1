// The example of the language reference, whole: it checks, and means what it says.
#include "check/checking.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace lobe;
using lobe::tests::check_text;
using lobe::tests::value_at;

namespace {

const std::string microfacet = R"(module microfacet
/// Trowbridge-Reitz.
term D_GGX(alpha: float in [1/4096, 1], g: geometry) -> float =
  alpha^2 / (pi * (g.cos_h^2 * (alpha^2 - 1) + 1)^2)
/// Smith.
term V_SmithGGX(alpha: float in [1/4096, 1], g: geometry) -> float {
  let i = g.cos_i + sqrt(alpha^2 + (1 - alpha^2) * g.cos_i^2)
  let o = g.cos_o + sqrt(alpha^2 + (1 - alpha^2) * g.cos_o^2)
  1 / (i * o)
}
)";

const std::string callisto = R"(
import microfacet { D_GGX, V_SmithGGX }

source slides = "Jimenez et al. 2023, The Character Rendering Art of The Callisto Protocol"

// ---- parameters
tier base, advanced, full

/// Gain of the diffuse lobe where light and view both graze the surface.
param diffuse_fresnel : float in [0, 256] = 1   base  "Diffuse Fresnel"
param diffuse_fresnel_falloff : unit = 0.75     base  "Diffuse Fresnel Falloff"
param diffuse_fresnel_tint : color = (1, 1, 1)  advanced
param diffuse_fresnel_tangent_falloff : unit = 0.75 full
param smooth_terminator : float in [-1, 1] = 0  base  "Smooth Terminator"
param smooth_terminator_length : unit = 0.5     full  "Smooth Terminator Length"
param specular_fresnel_falloff : unit = 0.5     advanced "Specular Fresnel Falloff"

/// Exponent scale r(x): 2 at 0 (tightest lobe), 0 at 1 (the lobe covers everything).
/// slides 85
term falloff_scale(x: unit) -> float in [0, 2] = 2 * (1 - x)

/// Blend weight h(θ, n, φ, m).
/// slides 85
term blend_weight(cos_theta: unit, n: float in [0, 2], cos_phi: unit, m: float in [0, 2]) -> unit =
  (1 - cos_theta)^(5 * n) * cos_phi^(5 * m)

/// Diffuse Fresnel, c1.
/// slides 85
term c1(g: geometry) -> color {
  let alpha_f = blend_weight(g.cos_d, falloff_scale(diffuse_fresnel_falloff), g.cos_h, falloff_scale(diffuse_fresnel_tangent_falloff))
  lerp(1, diffuse_fresnel * diffuse_fresnel_tint, alpha_f)
}

/// Smooth terminator, c2.  o > 0 softens, o < 0 hardens.
/// slides 90
term c2(g: geometry) -> float in [0, 2] {
  let mask = (1 - (1 - g.cos_d)^3) * (1 - (1 - g.cos_h)^3)
  lerp(1, smoothstep(0, mask * smooth_terminator_length, g.cos_i), mask * smooth_terminator)
}

/// Schlick with a scaled exponent.
/// slides 95
term F_Callisto(f0: color, cos_d: unit) -> color {
  let r = falloff_scale(specular_fresnel_falloff)
  f0 + saturate(2 - r) * (1 - f0) * (1 - cos_d)^(5 * r)
}

// ---- forms
/// Schlick.
term F_Schlick(f0: color, cos_d: unit) -> color = f0 + (1 - f0) * (1 - cos_d)^5
  /// Karis 2013, eq 5
  form spherical_gaussian = f0 + (1 - f0) * 2^((-5.55473 * cos_d - 6.98316) * cos_d)

effect "Diffuse Fresnel"   off when diffuse_fresnel * diffuse_fresnel_tint == 1
effect "Smooth Terminator" off when smooth_terminator == 0

// ---- the shading model
model callisto(g: geometry, s: surface) {
  diffuse  = c1(g) * s.diffuse_color / pi * g.cos_i * c2(g)
  specular = D_GGX(s.alpha, g) * V_SmithGGX(s.alpha, g) * F_Callisto(s.f0, g.cos_d) * g.cos_i * c2(g)
}
)";

}  // namespace

TEST_CASE("the example of the language reference checks", "[check][example]")
{
    const auto checked = check_text(callisto, {{"microfacet", microfacet}});
    CHECK(checked.errors() == "");
    CHECK(checked.warnings() == "");
    REQUIRE(checked.module);
    CHECK(checked.function("c2").range == ir::Range{0, 2});
    CHECK(checked.function("blend_weight").range == ir::Range{0, 1});
    CHECK(checked.function("c1").range == ir::Range{0, 256});
    CHECK(checked.function("F_Callisto").range == ir::Range{0, 1});
    CHECK(checked.function("falloff_scale").citations[0].locator == "85");
    CHECK(checked.module->models[0].outputs.size() == 2);
    CHECK(checked.module->effects.size() == 2);
    // At the default falloff of 0.5 the exponent is 5: Schlick, exactly.
    const double cos = 0.25;
    const double schlick =
        value_at(*checked.module, checked.function("F_Schlick"), {0.04, 0.04, 0.04, cos});
    const double ours =
        value_at(*checked.module, checked.function("F_Callisto"), {0.04, 0.04, 0.04, cos, 0.5});
    // Four operations and a power, each right to half a unit or, for the power, two: four units.
    CHECK(ours == Approx(schlick).epsilon(4 * std::numeric_limits<double>::epsilon()));
}
