// The corner suite: directions and parameters at and next to every boundary, through every
// function, number type, target and device. No NaN and no infinity may come out; and what jumps is
// named.
#pragma once

#include "analyze/agreement.h"
#include "analyze/store.h"
#include "analyze/verify.h"
#include "ir/module.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::analyze {

/// All corner points of an entry point: every polar angle at and next to 0, the horizon and below,
/// for light and view, coinciding, mirrored and opposed; parameters at and next to their ends and
/// neutral values. `open` boxes of a proof become points, too.
Points corner_points(const ir::Module& module, const ir::Function& entry,
                     evaluate::Precision precision);

struct CornerRow {
    std::string function;
    std::string target;  ///< `evaluator` for the CPU
    emit::Precision precision{};
    std::size_t points = 0;  ///< times routes
    std::size_t not_a_number = 0;
    std::size_t infinite = 0;
    std::string example;   ///< inputs and result of one
    std::string failure;   ///< why it could not run
    bool required = true;  ///< false: half, where no proof claims it
};

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

struct CornerOptions {
    std::vector<const emit::Target*> targets;  ///< empty: all
    std::string device;
    bool execute = true;
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

struct Corners {
    std::vector<CornerRow> rows;
    std::vector<Continuity> continuity;
    std::string device;
    std::string no_device;
};

/// `module` has been through optimize.
Corners corners(const ir::Module& module, const Sources& sources, const CornerOptions& options,
                const Store& store);

}  // namespace lobe::analyze
