// What is left of a module when a scene has said what it calls for.
//
// In: a checked module and what is known of its parameters and surfaces. Out: the checked module of
// exactly that: constants are literals, effects that are off are absent with the parameters that
// only they read, exponents that became whole or half-whole are products, guards that only wider
// ranges needed are gone, and packings carry only the parameters that are left. Comes before
// `optimize`, like specialize.h, which it is made of.
#pragma once

#include "ir/module.h"
#include "optimize/specialize.h"

#include <set>
#include <string>
#include <vector>

namespace lobe::optimize {

/// What is known of the inputs of a module: parameters and surface fields, by name.
struct Called {
    Settings constants;            ///< the same for everything that is shaded
    Limits ranges;                 ///< of all components together
    std::set<std::string> binary;  ///< 0 or 1 and nothing between, as metallic often is
    std::set<std::string> off;     ///< effects to leave out, by name; see `effect_states`
};

/// An effect that is off has the parameters of its condition at values that make it so: their
/// defaults, or, where the defaults do not, the constants that do. By the language the model is
/// then the same as wherever the condition holds.
struct Residual {
    ir::Module module;
    std::vector<std::string> fixed;   ///< parameters that are constants now, in declared order
    std::vector<std::string> absent;  ///< parameters that nothing reads any more
    std::vector<std::string> left;    ///< parameters that are still inputs
    std::vector<std::string> off;     ///< effects that are not in the code, in declared order
    /// What was set: the constants, and what switches effects off.
    Settings settings;
};

/// Of the outputs of one model, or of all where `model` is empty. Pure and total; names that the
/// module does not have are ignored.
Residual residual(const ir::Module& module, const Called& called, std::string_view model = {});

}  // namespace lobe::optimize
