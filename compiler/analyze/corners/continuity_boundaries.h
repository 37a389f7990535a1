// Which boundaries a function has, and lines across each.
#pragma once

#include "analyze/corners/continuity.h"
#include "analyze/entry_inputs.h"
#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::analyze {

struct Boundary {
    std::string name;  ///< `n.l = 0`, `falloff = 1`
    std::vector<Crossing> crossings;
    /// The value that is crossed, if it is one: the others may be moved.
    const EntryInputs::Value* value = nullptr;
};

/// The boundaries of the geometry, if the function takes one, then of every value. Values other
/// than the crossed one are at some of their special values; `parameters` says whether parameters
/// are, too, or stay at their defaults.
enum class Parameters : std::uint8_t {
    at_defaults,
    anywhere
};
std::vector<Boundary> boundaries(const ir::Module& module, const EntryInputs& inputs,
                                 Parameters parameters);

}  // namespace lobe::analyze
