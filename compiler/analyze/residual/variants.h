// Which shaders a scene needs: materials grouped into variants, and what fewer of them would cost.
//
// Materials with the same effects share a shader; a shader with more effects serves materials with
// fewer. Cost is measured issue cycles of a variant, from vectors, times the share of the picture
// that it shades (coverage). The choice of at most K variants is exact: all unions of effects that
// materials call for are candidates, each at the cost of a shader for all materials that it could
// serve, and the cheapest K of them that serve everything are found by a search that proves it.
// The shaders are then made for the materials that they do serve, which can only know more of
// their parameters.
#pragma once

#include "analyze/cost/cost.h"
#include "analyze/residual/facts.h"
#include "optimize/residual.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::analyze {

struct Variant {
    std::string name;                    ///< `callisto_base`, `callisto_retroreflection_…`
    std::vector<std::size_t> materials;  ///< indices into SceneFacts::materials
    optimize::Called called;
    optimize::Residual residual;  ///< under the module's own name; see `renamed`
    Cost cost;
    double coverage = 0;
};

/// The cheapest choice of so many variants.
struct VariantCount {
    std::size_t variants = 0;
    double cycles = 0;  ///< expected per pixel on the family, weighted by coverage
};

struct Variants {
    std::vector<Variant> chosen;         ///< by coverage, then name
    std::vector<VariantCount> frontier;  ///< from 1 to as many as help
    Cost general;                        ///< of the shader for everything
    double cycles = 0;                   ///< of `chosen`
    std::size_t candidates = 0;          ///< unions of effects that were priced
    bool is_proved = true;      ///< false: the search gave up, and there may be a cheaper choice
    std::string no_statistics;  ///< why costs are SPIR-V instructions; empty: they are cycles
    std::string driver;         ///< `radv, Mesa 22.3.6`
};

struct VariantOptions {
    std::size_t most = 0;  ///< 0: as many as make every material cheapest, and no more
    /// A shader for every material, with its surface's constants in it; materials whose shaders are
    /// the same share one. `most` is not asked then, and there is no frontier.
    bool per_material = false;
    Family family = Family::rdna2;
    unsigned jobs = 0;
};

Variants choose_variants(const ir::Module& module, const Sources& sources, const SceneFacts& facts,
                         const VariantOptions& options, const Store& store);

/// Materials by the set of effects that they call for, in the order of the first of each.
std::vector<std::vector<std::size_t>> by_effects(const SceneFacts& facts);
/// Materials that nothing tells apart, likewise.
std::vector<std::vector<std::size_t>> by_facts(const SceneFacts& facts);

/// A module that calls its only model, and the module itself, by another name.
ir::Module renamed(ir::Module module, const std::string& name);

/// By what a choice is judged: issue cycles, or SPIR-V instructions where there are none.
double price_of(const Cost& cost, Family family);

}  // namespace lobe::analyze
