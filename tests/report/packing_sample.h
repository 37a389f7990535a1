// A packing made by hand, with one of everything that is drawn: what the tests of reports show.
#pragma once

#include "report/packing.h"

namespace lobe::tests {

/// A module `skin` with four parameters and a gbuffer `small` of four targets, and the packing of
/// the parameters. The results are made up: nothing here was measured.
struct PackingSample {
    ir::Module module;
    analyze::Suggestion suggestion;  ///< of the same packing

    /// The packing as reported; pointers into this sample.
    report::Packed packed() const;
    /// As found by a search.
    report::Packed suggested() const;
};

PackingSample packing_sample();

}  // namespace lobe::tests
