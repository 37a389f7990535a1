// A model under a light: the one function that a host calls for each light and point.
//
// In: a checked or optimized module with the outputs of both. Out: a function from the light's
// fields, v, n (and x, y), the surface and the parameters to
//
//   irradiance * (sum of what sees the light as it is + specular_gain * sum of what mirrors it)
//
// which the caller multiplies by the light's color and intensity. Diffuse and transmitted light
// are lit from the light's `direction`; every other output is a lobe about the mirror direction and
// lit from its `specular_direction`. The fields of a geometry are computed from the vectors exactly
// as in an entry point. The light's name is no part of what is computed: a module that never calls
// for a light has no code of it.
#pragma once

#include "ir/module.h"

namespace lobe::ir {

/// Diffuse and transmitted light do not follow the mirror direction of a light with a size.
bool follows_mirror(const ModelOutput& output);

Function shade(const Module& module, const Model& model, const Model& light);

/// The module with a function behind all others for every one of its shadings that has none yet.
/// Passes that move fields between functions do not know it: it comes last.
Module with_shades(Module module);

/// A checked module with the shadings of `model`, or of all its models where that is empty, under
/// the lights of another checked module, which has no parameters. Only what these lights call comes
/// along; a function whose name is taken gets the other module's before its own.
Module join_lights(const Module& module, const Module& lights, std::string_view model = {});

/// `shade_callisto_point`
std::string shade_name(const Model& model, const Model& light);

}  // namespace lobe::ir
