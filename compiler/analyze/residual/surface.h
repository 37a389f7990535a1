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

/// Of what is no metal, in one channel. glTF's default is an index of 1.5, and 1 for the others; an
/// index of 0 is a reflectance of 1.
double dielectric_f0(double ior, double specular_color, double specular);

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

/// What the colors of vertices multiply the base color by where a material is shown. Over a
/// triangle they are between those of its corners.
struct VertexColors {
    std::vector<ir::Range> rgb{3, ir::Range{1, 1}};
    scene::Pointer called_by;  ///< the first that are not 1
};
/// By material. A layer has the colors of what it lies over.
std::vector<VertexColors> vertex_colors(const scene::Scene& scene);
/// A base color times those of vertices.
InputFact colored(InputFact base_color, const VertexColors& colors);

/// Of a material where vertices have no colors.
RawSurface raw_surface(const scene::Scene& scene, const scene::Material& material);

/// Everything that a blend of two can be.
RawSurface hull(const RawSurface& a, const RawSurface& b);
InputFact hull(const InputFact& a, const InputFact& b);

InputFact surface_field(const RawSurface& raw, ir::SurfaceField field);

}  // namespace lobe::analyze
