// Where points of an entry point lie in a box of its function's inputs.
//
// A proof speaks of what a function is given: arguments, parameters and fields. A point has vectors
// in place of the fields, and what becomes of those is the device's affair, within its contract.
#pragma once

#include "analyze/entry_inputs.h"
#include "analyze/points.h"
#include "analyze/proof/proof.h"
#include "evaluate/run.h"

#include <vector>

namespace lobe::analyze {

enum class Inside : std::uint8_t {
    certainly,  ///< whatever a conforming device makes of the fields; they are defined
    possibly    ///< on some device
};

/// One per point. Sides of one component of a color are those of all of them: what is proved of one
/// output holds for those that are the same function of other inputs.
std::vector<bool> inside(const EntryInputs& inputs, const Points& points,
                         evaluate::Precision precision, const NamedBox& box, Inside which);

}  // namespace lobe::analyze
