// Effects that a scene calls for, and that change so little that an epsilon lets them go.
#pragma once

#include "analyze/residual/certificate.h"
#include "analyze/residual/facts.h"
#include "analyze/residual/variants.h"

#include <vector>

namespace lobe::analyze {

/// What may go for some materials: those that call for the same effects.
struct DroppedEffects {
    std::vector<std::size_t> materials;  ///< indices into SceneFacts::materials
    std::vector<Dropped> effects;
};

/// Takes the calls for such effects away from the facts; what a material says of their parameters
/// is then of no account. Every group of materials with the same effects is looked at by itself.
std::vector<DroppedEffects> drop_effects(SceneFacts& facts, const ir::Module& module,
                                         double epsilon, const CertificateOptions& options);

/// Of a variant's materials, what was dropped and is not in its code; with the largest bound.
std::vector<Dropped> dropped_in(const Variant& variant, const std::vector<DroppedEffects>& dropped);

}  // namespace lobe::analyze
