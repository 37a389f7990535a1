// Numbers that carry their error: what an operation of the tape does to the distance between what
// is computed and what is meant.
//
// A Rounded stands for all values that one place of a tape takes over a box of inputs: over the
// real numbers, and as a machine computes them. An operation says three things: the values of its
// result, the error that its own rounding adds, and by how much an error of each operand is
// multiplied on the way (its slopes: [Moore79] mean value form, so that nothing of second order is
// left out). rounding_bounds.h adds the errors of a whole tape up in both directions.
//
// All bounds are rounded outward: they hold for the doubles that state them.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/run.h"
#include "evaluate/tape.h"
#include "ir/graph.h"

#include <array>
#include <span>

namespace lobe::evaluate {

/// Who computes: the kernels of this folder, or any device that keeps to the precision table of
/// the Vulkan specification (acceptance.h).
enum class Machine : std::uint8_t {
    kernels,  ///< float: IEEE 754 to nearest. half: likewise, denormals kept or flushed
    vulkan    ///< either direction, denormals flushed or not
};

/// A machine's format and what one rounding of it may do.
struct Rounding {
    Precision precision{};
    Machine machine{};
    int digits = 24;  ///< of the significand, with the hidden one
    double unit = 0;  ///< one rounding, relative
    double largest = 0;
    double least_normal = 0;
    double least = 0;  ///< the least denormal
    bool nearest = true;
    bool flushes = false;
};
const Rounding& rounding(Machine machine, Precision precision);

struct Rounded {
    Interval exact;     ///< over the reals
    Interval computed;  ///< numbers of the format; infinite ends: it may overflow
    /// |computed - exact|, but for jumps.
    double absolute = 0;
    /// |computed - exact| <= relative |exact| + underflow, but for jumps; infinite: not known.
    double relative = 0;
    double underflow = 0;
    /// What is added where rounding turns a decision: a condition that holds for the computed
    /// operands and not for the exact ones, or a divisor that underflowed. 0: none can be.
    double jump = 0;
    /// No computed value is smaller than this and not 0.
    double smallest = 0;
};

/// An operand's error times this is the result's: [absolute or relative result][absolute or
/// relative operand]. Infinite ends: no bound in these units.
struct Slope {
    Interval aa;
    Interval ar;
    Interval ra;
    Interval rr;
};

struct Step {
    Rounded value;
    std::array<Slope, 4> slopes;
    /// What the operation itself adds, in both units, and what of the operands' underflow.
    double own_absolute = 0;
    double own_relative = 0;
    /// The result's error is no more than the greatest of its operands', not their sum.
    bool chooses = false;
};

/// An input whose values are exact numbers of the format.
Rounded rounded_input(const Rounding& rounding, Interval range);
/// A value that others gave, where it lies in this part of its range.
Rounded rounded_part(const Rounded& whole, Interval part);
Rounded rounded_literal(const Rounding& rounding, const ir::Literal& literal);

/// One operation. Of the tape's, not those that `rounding_tape` (rounding_tape.h) takes apart;
/// `smoothstep` is its polynomial t^2 (3 - 2 t) of one operand here.
Step step(const Rounding& rounding, TapeOp op, std::span<const Rounded> operands);

}  // namespace lobe::evaluate
