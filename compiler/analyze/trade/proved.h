// What is proved of a way to compute something: how far rounding can take it, beside the worst that
// a search found of the same.
//
// The same measure as the observed rounding error (deviation.h). But the inputs are arguments and
// fields, exact. What the fields lose from vectors is proved of them alone (proof.h): between
// vectors that are anywhere no bound of a whole would be worth its name.
#pragma once

#include "analyze/trade/candidates.h"
#include "evaluate/run.h"

#include <cstddef>
#include <string>

namespace lobe::analyze {

struct ProvedRounding {
    double bound = 0;       ///< in IEEE's arithmetic, as of the CPU; infinite: there is none
    double observed = 0;    ///< the worst that was found
    double any_device = 0;  ///< the bound on any Vulkan device
    /// Of half: the part of the box that the bound is of, where every result is finite.
    std::string over;
};

/// The worst of the outputs. It holds wherever rounding turns no decision (`ErrorBound::jump`).
/// `boxes`: how many may be looked at, of each output, machine and question.
ProvedRounding proved_rounding(const Spelled& spelled, evaluate::Precision precision, double floor,
                               std::size_t boxes);

}  // namespace lobe::analyze
