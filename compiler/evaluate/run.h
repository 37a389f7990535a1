// Running a tape over many points, in one kind of number.
//
// Inputs and outputs are columns (structure of arrays): inputs[i][p] is scalar i of point p.
// Blocks of points go through the tape together; results do not depend on the block size, the
// compiler, or the number of threads. float and double use IEEE +, -, *, / and square root and
// the polynomials of this folder, never the platform's libm, and no fused multiply-add.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/real.h"
#include "evaluate/tape.h"

#include <cstddef>
#include <span>

namespace lobe::evaluate {

template <class Number>
using Columns = std::span<const Number* const>;
template <class Number>
using Results = std::span<Number* const>;

void run(const Tape& tape, Columns<float> inputs, Results<float> outputs, std::size_t count);
void run(const Tape& tape, Columns<double> inputs, Results<double> outputs, std::size_t count);

/// binary16: every operation is computed exactly, then rounded to nearest even. Values travel
/// as floats that are halves. Inputs are rounded first.
enum class HalfMode {
    keep_denormals,
    flush_denormals
};
void run_half(const Tape& tape, HalfMode mode, Columns<float> inputs, Results<float> outputs,
              std::size_t count);

void run(const Tape& tape, Columns<Interval> inputs, Results<Interval> outputs, std::size_t count);

/// The table of the precision a target computes in: fp32 or fp16 of the Vulkan specification,
/// appendix "Precision and Operation of SPIR-V Instructions".
enum class Precision {
    float32,
    float16
};
void run_acceptance(const Tape& tape, Precision precision, Columns<Acceptance> inputs,
                    Results<Acceptance> outputs, std::size_t count);

/// MPFR, every operation rounded to nearest at `bits` (53 .. 4096).
void run_real(const Tape& tape, int bits, Columns<Real> inputs, Results<Real> outputs,
              std::size_t count);

/// `reals`: the values over the real numbers, rounded outward in double: what a declared range is
/// proved with. `float32`: what any target may compute too, by the Vulkan precision table, so that
/// what it excludes cannot be reached by a shader either: what guards are removed with.
enum class Arithmetic {
    reals,
    float32
};

/// The ranges of every expression of a function whose inputs lie in `inputs` (one per input of
/// the function, for every component): the hull over components.
Facts<ir::Expr, Interval> ranges(const ir::Module& module, const ir::Function& function,
                                 std::span<const Interval> inputs,
                                 Arithmetic arithmetic = Arithmetic::float32);

/// The ranges that the inputs of a function were declared with.
std::vector<Interval> declared_ranges(const ir::Function& function);

}  // namespace lobe::evaluate
