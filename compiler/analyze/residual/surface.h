// A glTF material as the fields of a surface.
//
//   base_color, metallic, roughness   as they are; roughness below the least of the language is it
//   alpha                             roughness^2
//   f0 of what is no metal            min(((ior - 1) / (ior + 1))^2 specular_color, 1) specular,
//                                     of KHR_materials_ior and KHR_materials_specular; else 0.04
//   specular                          that over 0.08, at most 1
//   f0, diffuse_color                 lerp(f0 of what is no metal, base_color, metallic),
//                                     base_color (1 - metallic)
//
// Materials that are blended by their parameters are so before the last four rows.
//
// Source: glTF 2.0 appendix B; KHR_materials_ior; KHR_materials_specular.
#pragma once

#include "analyze/residual/facts.h"
#include "ir/geometry.h"

namespace lobe::analyze {

/// What the fields follow from, each a range per component.
struct RawSurface {
    InputFact base_color;
    InputFact metallic;
    InputFact roughness;
    InputFact dielectric_f0;
    /// `specular` is one number, and this material's dielectric reflectance is colored, or more
    /// than 0.08: worth a note where the model reads `specular`.
    bool exceeds_specular = false;
};
RawSurface raw_surface(const scene::Scene& scene, const scene::Material& material);

/// Everything that a blend of two can be.
RawSurface hull(const RawSurface& a, const RawSurface& b);
InputFact hull(const InputFact& a, const InputFact& b);

InputFact surface_field(const RawSurface& raw, ir::SurfaceField field);

}  // namespace lobe::analyze
