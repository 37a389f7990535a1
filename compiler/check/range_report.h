// Telling the author what could not be proved: where, why, at which input, and the way out.
#pragma once

#include "base/diagnostic.h"
#include "check/analysis.h"
#include "check/obligations.h"
#include "check/witness.h"

namespace lobe::check {

/// An obligation that was not proved, with what is known of it.
struct Finding {
    Obligation obligation;
    std::vector<Interval> ranges;             ///< per claim, of its subject
    std::optional<Witness> witness;           ///< an input that breaks it, if one was found
    std::vector<const ir::Input*> unbounded;  ///< inputs without a range that it depends on
    bool takes_geometry = false;
};

Diagnostic describe(const Finding& finding, const Sources& sources);

}  // namespace lobe::check
