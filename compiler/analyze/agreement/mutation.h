// Wrong shaders on purpose: the emitted text of one function, changed in one place.
//
// A check that never fails proves nothing. Each mutant is a mistake that a person or a compiler
// could make; `verify` has to notice it (see kill.h).
#pragma once

#include "emit/emit.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

enum class Mutation : std::uint8_t {
    swap_inputs,      ///< two parameters of a function trade places: n.l and n.v
    drop_pi,          ///< a factor or divisor of pi, or of its reciprocal, becomes 1
    swap_ends,        ///< mix(a, b, t) becomes mix(b, a, t)
    flip_sign,        ///< + becomes -, or - becomes +
    change_constant,  ///< a literal grows by 1e-4 of itself
    remove_guard,     ///< saturate(x), max(x, c), `c ? x : y`, a guarded helper: the bare x
    swap_min_max,     ///< min becomes max
    drop_square,      ///< x * x becomes x
    invert_quotient,  ///< a / b becomes a * b
};

std::string_view name(Mutation mutation);
const std::vector<Mutation>& all_mutations();

struct Mutant {
    Mutation mutation{};
    int line = 0;          ///< of the text
    std::string function;  ///< the emitted function that was changed
    std::string before;    ///< the changed piece: `mix(1.0, tint, weight)`
    std::string after;     ///< `mix(tint, 1.0, weight)`
    std::string text;      ///< the whole shader
    /// For swap_inputs: which parameters of `function` traded places, counted from 0.
    std::optional<std::pair<int, int>> swapped;
};

/// Every mutant of a harness, in the order of their places; within a place in the order of
/// `Mutation`. Only lines that stem from a .lobe file are changed, and not the entry point: what
/// an engine would include, not what reads and writes the points.
std::vector<Mutant> mutants(const emit::Harness& harness);

}  // namespace lobe::analyze
