// The error of a whole tape over one box of inputs.
//
// Forward, every value carries its error. Backward, every rounding is an independent unknown and
// the result's error is the sum of each times its slope ([Solovyev15], in mean value form): there
// errors that cancel do so, as those of alpha^2 above and below a fraction bar. Both hold; the
// lesser is told.
#pragma once

#include "evaluate/rounding.h"
#include "evaluate/rounding_tape.h"

#include <span>
#include <vector>

namespace lobe::evaluate {

struct BoxError {
    Interval exact;
    Interval computed;
    double absolute = 0;  ///< |computed - exact|, but for jumps
    double relative = 0;  ///< |computed - exact| / max(|exact|, floor), but for jumps
    double jump = 0;      ///< what a turned decision adds
};

/// A tape made ready for many boxes.
class RoundingBounds {
public:
    /// `given`: where inputs are results (waist.h), what each is over its whole range.
    RoundingBounds(const RoundingTape& tape, const Rounding& rounding, double floor,
                   std::vector<Rounded> given = {});

    /// One interval per input of the tape.
    BoxError error(std::span<const Interval> box);
    /// Of the last box, by node.
    const std::vector<Rounded>& values() const { return values_; }

private:
    void forward(std::span<const Interval> box);
    void as_length(std::size_t root);
    void start_centers(std::span<const Interval> box);
    void center(std::size_t node, std::span<const Interval> box);
    Rounded limited(const RoundingNode& node, std::size_t operand) const;
    Interval exact_range(std::span<const Interval> box) const;
    Interval monotone_range(std::span<const Interval> box) const;
    void find_trends();
    double backward_absolute();
    double backward_relative();

    const RoundingTape& tape_;
    const Rounding& rounding_;
    double floor_;
    /// Of a root of a sum of squares: what is squared.
    std::vector<std::vector<std::uint32_t>> components_;
    std::vector<Rounded> given_;  ///< empty: inputs are exact
    std::vector<Rounded> values_;
    mutable std::vector<Interval> ranges_;
    std::vector<Step> steps_;
    std::vector<std::array<Rounded, 4>> operands_;
    std::vector<Interval> adjoint_;
    /// Mean value forms: the exact values at the middle of the box, and by node and input how they
    /// change from there. Empty for boxes of many sides.
    std::vector<Interval> middle_;
    std::vector<Interval> gradient_;
    /// How the exact result depends on each input over the last box: 1 rises, -1 falls, 0 unknown.
    std::vector<int> trend_;
};

}  // namespace lobe::evaluate
