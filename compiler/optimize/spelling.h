// How much of the compiler's care goes into the text: from what an author types to what ships.
//
// All spellings of a module are the same functions over the real numbers (the naive one where it is
// defined at all). They differ in rounding, in what happens at the edges, and in cost; that makes
// them points of the trade between accuracy and time, and the witnesses of what stabilizing is for.
#pragma once

#include "ir/module.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace lobe::optimize {

enum class Spelling : std::uint8_t {
    naive,       ///< as typed by hand: no guard, no rewrite, `pow` for every power but a square.
                 ///< For comparison only: it may be undefined, and is never emitted into a build
    as_written,  ///< guards where ranges cannot exclude the hazard, no rewrite
    factored,    ///< and rewrites that need nothing but what the function was given
    stable,      ///< and inputs that are made from the vectors: what a build emits
};

std::string_view name(Spelling spelling);  ///< `as written`
std::span<const Spelling> spellings();

/// A checked module in a spelling. `stable` is what `optimize` (optimize.h) makes. All but `naive`
/// keep the promise `legal`.
ir::Module spell(const ir::Module& checked, Spelling spelling);

}  // namespace lobe::optimize
