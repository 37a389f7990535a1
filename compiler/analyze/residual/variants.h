// Which shaders a scene needs: materials grouped into variants, and what fewer of them would cost.
//
// Materials with the same effects share a shader; a shader with more effects serves materials with
// fewer. Cost is measured issue cycles of a variant times the share of the picture that it shades
// (coverage). The choice of at most K variants is exact: all unions of effects that materials call
// for are candidates, and the cheapest K of them that serve everything are found by a search that
// proves it.
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
    optimize::Residual residual;
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
    std::string no_statistics;  ///< why costs are SPIR-V instructions; empty: they are cycles
};

struct VariantOptions {
    std::size_t most = 0;  ///< 0: as many as make every material cheapest, and no more
    Family family = Family::rdna2;
    unsigned jobs = 0;
};

Variants choose_variants(const ir::Module& module, const Sources& sources, const SceneFacts& facts,
                         const VariantOptions& options, const Store& store);

}  // namespace lobe::analyze
