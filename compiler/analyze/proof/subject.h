// One output of a function as something to prove bounds of: its tape, the box of its inputs, and
// the two ways to evaluate it at points.
#pragma once

#include "evaluate/rounding.h"
#include "evaluate/rounding_tape.h"
#include "evaluate/run.h"
#include "ir/module.h"

#include <array>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A closed box, one side per input of the subject.
using Box = std::vector<evaluate::Interval>;

struct Subject {
    evaluate::Tape tape;  ///< the whole function's
    std::size_t output = 0;
    evaluate::Precision precision{};
    evaluate::RoundingTape operations;  ///< for what a device accepts
    evaluate::RoundingTape steps;       ///< for errors
    Box box;                            ///< declared, ends on the grid, for the inputs it reads
    std::vector<std::string> names;     ///< of these
    std::vector<bool> whole;            ///< holds integers only
    std::vector<std::array<std::size_t, 3>> vectors;  ///< inputs that are x, y and z of one
    /// What its errors are relative to at least.
    double floor = 0;
    /// Not empty: `steps` starts at a waist (waist.h), whose values are these over the whole box;
    /// sides are of real numbers, and there are no points to evaluate.
    std::vector<evaluate::Rounded> given;
};

/// A point: one value per input of the subject, on the grid of the precision.
using Point = std::vector<float>;

struct Observed {
    double computed = 0;
    double exact = 0;
};

/// Computed in the precision (of half: with denormals kept and flushed, the worse), and exact.
void evaluate_points(const Subject& subject, const std::vector<Point>& points,
                     std::vector<Observed>& results);
/// The exact value by MPFR instead of double.
Observed confirm_point(const Subject& subject, const Point& point);

/// One per output that is another function than those before it.
std::vector<Subject> subjects(const ir::Module& module, const ir::Function& function,
                              evaluate::Precision precision);

/// The same subject from its waists on, those through which errors stay bounded, the narrowest
/// first. What holds of such a one holds of the subject.
/// `jumps`: what a turned decision may do to the waist's values goes on; else none was turned.
std::vector<Subject> from_waists(const Subject& subject, evaluate::Machine machine, bool jumps);

/// How many boxes of this subject a budget allows. It is told in boxes of a tape of 128 operations;
/// of a longer tape there are fewer, so that no function takes more time than another. At least 1.
std::size_t boxes_within(std::size_t budget, const Subject& subject);

/// The nearest number of the precision within the side.
float on_grid(double value, const evaluate::Interval& side, evaluate::Precision precision);

std::string describe(const Subject& subject, const Point& point);

}  // namespace lobe::analyze
