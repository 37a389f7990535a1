// For which parameters and surfaces a law is asked.
#pragma once

#include "analyze/entry_inputs.h"

#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

struct PhysicsSetting {
    std::string text;  ///< `roughness = 0.5, retroreflection = 256`; empty: nothing to say
    EntryInputs::Values values;
    double alpha = 1;  ///< how narrow its lobe is
};

/// White surfaces, every parameter at its default: of some roughnesses and, where that matters,
/// of both metals and dielectrics.
std::vector<PhysicsSetting> surface_settings(const EntryInputs& inputs);

/// One end of a parameter, alone and with the others at their upper ends: some parameters do
/// nothing while an effect is off.
struct ParameterEnd {
    PhysicsSetting alone;
    PhysicsSetting with_others;
};
/// Both ends of every parameter, but not defaults; for a roughness of 0.5.
std::vector<ParameterEnd> parameter_ends(const EntryInputs& inputs);
/// What an end is compared with, to see whether it does anything.
PhysicsSetting parameters_at_defaults(const EntryInputs& inputs, PhysicsSetting setting);

/// White, with the reflectance of a dielectric, and this roughness.
PhysicsSetting dielectric_setting(const EntryInputs& inputs, double roughness);

/// For a normal distribution: its widths, and the ends of everything else that it takes.
struct WidthSetting {
    std::string text;
    EntryInputs::Values values;
    double alpha_x = 1;
    double alpha_y = 1;
};
std::vector<WidthSetting> width_settings(const EntryInputs& inputs);

}  // namespace lobe::analyze
