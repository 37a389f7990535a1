// The rows of each law, for one function: what physics.h joins and keeps.
#pragma once

#include "analyze/physics/hemisphere.h"
#include "analyze/physics/physics.h"

#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

/// A term that is a distribution of normals.
std::vector<PhysicsRow> normalized_rows(EmittedFunction& function);

/// An output: one row per surface and view, then the view of every parameter's ends that reflects
/// most. Not over light: the output is itself what is reflected.
std::vector<PhysicsRow> albedo_rows(EmittedFunction& function, bool over_light);

/// All outputs of a model together, for a white dielectric.
std::vector<PhysicsRow> whole_albedo_rows(std::vector<EmittedFunction>& outputs,
                                          const std::string& name);

/// An output over light and view.
std::vector<PhysicsRow> reciprocal_rows(EmittedFunction& function);

/// Anything: the least value over the corner suite's points.
std::vector<PhysicsRow> positive_rows(EmittedFunction& function);

/// `callisto_diffuse, roughness = 0.5`
std::string physics_subject(std::string_view name, std::string_view setting);

/// The row of a law that could not be asked.
PhysicsRow failed_row(std::string_view name, Law law, std::string why);

}  // namespace lobe::analyze
