// What jumps, and by how much: limits from both sides of every boundary that a function has.
//
// A boundary is crossed along straight paths in the inputs; at distances 2^-k the values on both
// sides, and on the boundary itself, are computed with MPFR. How their difference shrinks with the
// distance decides: a function that is continuous there (Hoelder, with whatever exponent) has one
// that falls with every halving, down to nothing; one that jumps has one that stays. No tolerance
// is chosen. See docs/stability.md.
#pragma once

#include "analyze/store.h"
#include "analyze/verify.h"
#include "evaluate/tape.h"
#include "ir/module.h"

#include <functional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A boundary at which a function was looked at from both sides.
struct Continuity {
    std::string function;
    std::string
        across;  ///< `n.l = 0`, `v.l = 0`, `diffuse_fresnel_falloff = 1`, `effect "…" on/off`
    double jump = 0;   ///< greatest difference of the limits from both sides
    double scale = 0;  ///< greatest value near the boundary
    bool continuous = false;
    std::string at;
};

/// A straight line through the inputs of a tape, across a boundary at distance 0.
struct Crossing {
    std::vector<double> at;         ///< on the boundary, exactly
    std::vector<double> direction;  ///< what a distance of 1 adds
    bool before = true;             ///< negative distances are inputs, too
    bool after = true;              ///< so are positive ones
};

/// What happens on the way across.
struct Limits {
    double jump = 0;   ///< of the component that jumps most; 0: none does
    double scale = 0;  ///< greatest magnitude met
    /// Where it jumps: 0 on the boundary. Elsewhere it is where a guard switches, on the way.
    double distance = 0;
    /// Not 0: it is no jump, but a ramp that is over within this distance.
    double within = 0;
};
Limits limits(const evaluate::Tape& tape, const Crossing& crossing);

/// Every output and every term over geometry, across every boundary of the geometry and of its
/// parameters: by function and boundary. Results are the same for every number of threads.
struct ContinuityOptions {
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};
std::vector<Continuity> continuity(const ir::Module& module, const ContinuityOptions& options,
                                   const Store& store);

}  // namespace lobe::analyze
