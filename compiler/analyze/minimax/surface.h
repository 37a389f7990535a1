// A term as a surface over its box: a scalar function of one or two scalars, known by running its
// tape in double, and how far another one is from it.
//
// Double is enough here: values err by 2^-53 times their conditioning, and what is asked is a
// difference of 1e-9 and more of their range. `confirmed` asks MPFR all the same.
#pragma once

#include "analyze/minimax/fit.h"
#include "evaluate/interval.h"
#include "evaluate/tape.h"

#include <functional>
#include <span>
#include <vector>

namespace lobe::analyze {

/// What a surface is compared with: the values of another function at places.
using OtherValues = std::function<std::vector<double>(std::span<const Place>)>;

class Surface {
public:
    /// `tape` has one output, and one input per side.
    Surface(evaluate::Tape tape, std::vector<evaluate::Interval> sides);

    const evaluate::Tape& tape() const { return tape_; }
    const std::vector<evaluate::Interval>& sides() const { return sides_; }

    std::vector<double> values(std::span<const Place> places) const;
    /// The same by MPFR with 113 bits, rounded once.
    std::vector<double> confirmed(std::span<const Place> places) const;

    /// Places over the box, denser towards its ends, which are among them, and the values there.
    /// Fewer places where the tape is long.
    Samples samples() const;

private:
    evaluate::Tape tape_;
    std::vector<evaluate::Interval> sides_;
};

/// A place, and how far two functions differ there.
struct Difference {
    Place at;
    double size = 0;
};

/// The greatest differences between a surface and another function, greatest first: the peaks on
/// the lattice of `samples`, each followed between its neighbors to where it is highest. Observed,
/// not proved. Where the other function is not finite, the difference is infinite.
std::vector<Difference> greatest_differences(const Surface& surface, const Samples& samples,
                                             const OtherValues& other);

}  // namespace lobe::analyze
