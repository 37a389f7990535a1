// What each scene's residual shader costs beside the general one: the ladder of effects.
#pragma once

#include "analyze/cost/cost.h"
#include "analyze/residual/facts.h"

#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// One shader: the general one, a scene's, or one that a person wrote.
struct Rung {
    std::string name;
    std::vector<std::string> effects;  ///< that are in its code, in the module's order
    Cost cost;                         ///< of one evaluation from vectors
};

struct Ladder {
    std::string module;
    std::string model;
    Rung general;
    std::vector<Rung> scenes;      ///< in the order given, one shader for all materials of each
    std::vector<Rung> references;  ///< models of other modules, in the order given
    Costs about;                   ///< drivers and devices; its `costs` are empty
};

struct LadderScene {
    std::string name;
    SceneFacts facts;
};

/// A model to compare with, of a checked module with sources of its own.
struct LadderReference {
    std::string name;
    const ir::Module* module = nullptr;
    std::string model;
};

/// `module` is checked. Results are the same whatever the number of threads, but for nanoseconds.
Ladder ladder(const ir::Module& module, const std::string& model, const Sources& sources,
              std::span<const LadderScene> scenes, std::span<const LadderReference> references,
              const CostOptions& options, const Store& store);

}  // namespace lobe::analyze
