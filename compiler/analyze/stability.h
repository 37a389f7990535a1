// Everything that is known about a module's stability: hazards and their remedies, proofs, the
// corner suite, and what it owes to physics.
#pragma once

#include "analyze/corners/corners.h"
#include "analyze/hazards/hazards.h"
#include "analyze/physics/physics.h"
#include "analyze/proof/proof.h"

namespace lobe::analyze {

struct Stability {
    std::string module;
    std::vector<Proof> proofs;
    std::vector<Proof> fields;
    std::vector<FunctionHazards> hazards;
    Corners corners;
    std::vector<PhysicsRow> physics;
    double seconds = 0;

    /// No open box and no NaN or infinity in float, in anything that the module ships.
    bool ok() const;
};

struct StabilityOptions {
    ProofOptions proof;
    HazardOptions hazard;
    CornerOptions corner;
    PhysicsOptions physics;
    bool hazards = true;
};

/// `checked` has not been through optimize.
Stability stability(const ir::Module& checked, const Sources& sources,
                    const StabilityOptions& options, const Store& store);

}  // namespace lobe::analyze
