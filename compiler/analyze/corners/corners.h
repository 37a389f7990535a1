// The corner suite: directions and parameters at and next to every boundary, through every
// function, number type, target and device. No NaN and no infinity may come out; and what jumps is
// named.
#pragma once

#include "analyze/agreement/agreement.h"
#include "analyze/corners/continuity.h"
#include "analyze/entry_inputs.h"
#include "analyze/proof/proof.h"
#include "analyze/store.h"
#include "analyze/verify.h"
#include "ir/module.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lobe::analyze {

/// All corner points of an entry point: every polar angle at and next to 0, the horizon and below,
/// for light and view, coinciding, mirrored and opposed; parameters at and next to their ends and
/// neutral values: one at a time, all combinations of ends (a thousand of them, that cover every
/// three inputs, where there are more), and mixed. `open` boxes of a proof become points, too.
Points corner_points(const EntryInputs& inputs, const Grid& grid,
                     std::span<const NamedBox> open = {});

struct CornerRow {
    std::string function;
    std::string target;  ///< `evaluator` for the CPU
    emit::Precision precision{};
    std::size_t points = 0;        ///< times routes: before and after spirv-opt, half's two modes
    std::size_t not_a_number = 0;  ///< points with a NaN, whatever the contract says of them
    std::size_t infinite = 0;
    std::string example;   ///< inputs and result of one
    std::string failure;   ///< why it could not run
    bool required = true;  ///< false: half, where no proof claims it
    /// Of half. Required: the box of which it is proved; a point counts whose fields are in it,
    /// whatever a device makes of them. Not required: why not; empty if nobody asked for proofs.
    std::string claim;
};

/// What proofs say of a function's half: finite in a box, or why they refuse.
struct HalfClaim {
    std::string function;
    std::optional<NamedBox> over;
    std::string refused;
};

struct CornerOptions {
    std::vector<const emit::Target*> targets;  ///< empty: all
    std::string device;
    bool execute = true;
    bool continuity = true;
    unsigned jobs = 0;
    std::vector<std::pair<std::string, NamedBox>> open;  ///< of proofs, by function
    std::vector<HalfClaim> half;                         ///< of proofs
    std::function<void(const Progress&)> progress;
};

struct Corners {
    /// By function, precision, target; of half, what is claimed before what is not.
    std::vector<CornerRow> rows;
    std::vector<Continuity> continuity;  ///< by function and boundary
    std::string device;
    std::string no_device;
};

/// `module` has been through optimize.
Corners corners(const ir::Module& module, const Sources& sources, const CornerOptions& options,
                const Store& store);

}  // namespace lobe::analyze
