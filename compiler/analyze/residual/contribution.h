// What an effect adds, over a box: a function with the effect and without it, bounded together.
//
// Both are one tape; with the effect some inputs have other values. A value's range says little of
// the difference, since both share what is large and uncertain: a highlight times 0.996 differs
// from the highlight by 0.4 %, whatever the highlight is. So every value carries the difference of
// the two and, where there is one, their ratio, as intervals over the real numbers: a product's
// ratio is the product of its operands' ratios, a sum of two positive values has a ratio between
// theirs, and a difference follows from either. The mean value form of [Moore79] with the ratios of
// logarithmic derivatives.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/rounding_tape.h"

#include <optional>
#include <span>
#include <vector>

namespace lobe::analyze {

/// One value, at all points of a box.
struct Contribution {
    evaluate::Interval without;
    evaluate::Interval with;
    evaluate::Interval change;                 ///< with - without
    std::optional<evaluate::Interval> factor;  ///< with = without * factor: 0 stays 0
};

/// An input that the effect leaves alone, or that it changes from one value to a range.
Contribution untouched(evaluate::Interval range);
Contribution changed(double without, evaluate::Interval with);

/// Of the tape's output; one contribution per input. The tape is of `Detail::operations`. `values`
/// is room for it.
Contribution contribution(const evaluate::RoundingTape& tape, std::span<const Contribution> box,
                          std::vector<Contribution>& values);

}  // namespace lobe::analyze
