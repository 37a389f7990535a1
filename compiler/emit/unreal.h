// How a model meets the engine: what its BxDF reads and writes.
#pragma once

#include "emit/model.h"

namespace lobe::emit {

/// What a BxDF raises roughness to: the least that functions are proved for.
constexpr double least_roughness = 0x1p-6;

/// Whether a model is lit by a light, and so has a BxDF.
bool has_bxdf(const ModelInputs& inputs);

/// Diffuse and transmitted light do not follow the mirror direction of a light with a size: these
/// outputs are computed before SphereMaxNoH.
bool is_before(const ir::ModelOutput& output);

/// The member of FDirectLighting that an output adds to. One whose name the engine does not know
/// is a lobe more: specular.
std::string_view engine_output(const ir::ModelOutput& output);

/// The macro that fills the parameters from the GBuffer.
std::string parameters_macro(std::string_view stem);

/// Where a field of the surface is.
std::string_view gbuffer_field(ir::SurfaceField field);

}  // namespace lobe::emit
