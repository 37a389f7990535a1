// What a material gives to the parameters of a model, and what is wrong with that.
#pragma once

#include "analyze/residual/facts.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::analyze {

/// Every parameter of a module at its default.
std::map<std::string, InputFact> default_facts(const ir::Module& module);

/// The parameters that a material gives, by name. Adds what is wrong to `complaints`, and leaves
/// that parameter out.
std::map<std::string, InputFact> given_parameters(const scene::Scene& scene,
                                                  const scene::Material& material,
                                                  const ir::Module& module,
                                                  std::vector<scene::Complaint>& complaints);

/// Extensions that this material uses and that are neither the surface's nor a parameter's, by the
/// names that a file knows them under.
std::vector<std::string> not_modeled(const scene::Scene& scene, const scene::Material& material,
                                     const ir::Module& module);

/// `0.5`, `(1, 0.5, 0)`, `in [0, 4]`: what an input can be, in words.
std::string in_words(const InputFact& fact);

}  // namespace lobe::analyze
