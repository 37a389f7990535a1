// How far a form is from its term, where only parts of the term were approximated.
#pragma once

#include "analyze/minimax/fit.h"
#include "ir/module.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lobe::analyze {

/// Inputs of a function that are held at one of these places in every point.
struct Held {
    std::vector<std::uint32_t> inputs;  ///< one or two
    std::vector<Place> places;
};

struct Departure {
    double error = 0;  ///< the greatest difference of any component
    double range = 0;  ///< of the term's components together: greatest less least
};

/// Over points of the box, by double: other inputs at their ends or anywhere between, each of
/// `held` in turn where its part is worst; from the worst points uphill. Observed, not proved.
/// Nothing where an input is not bounded, or something not finite was met.
std::optional<Departure> departure(const ir::Module& module, const ir::Function& term,
                                   const ir::Function& form, const std::vector<Held>& held);

}  // namespace lobe::analyze
