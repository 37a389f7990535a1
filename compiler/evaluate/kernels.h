// The kernels of float and double: one operation over a block of lanes.
//
// kernels.inc is compiled once per instruction set that a machine may have, and `kernels` picks
// the widest at run time. Every copy computes the same bits: IEEE operations in one fixed order,
// no fused multiply-add, no libm.
#pragma once

#include "evaluate/fused.h"
#include "evaluate/run.h"

#include <array>

namespace lobe::evaluate {

/// Lanes of a block. A slot of 128 floats is 512 bytes: a tape of 60 slots fits the first-level
/// cache, and the cost of choosing an operation is spread over 128 results.
constexpr std::size_t block_lanes = 128;

/// Computes `block_lanes` results. `result` may be any of the operands; operands past the arity are
/// blocks too, and may be any.
template <class Number>
using Kernel = void (*)(Number* result, const Number* a, const Number* b, const Number* c,
                        const Number* d);

template <class Number>
using KernelTable = std::array<Kernel<Number>, tape_op_count>;
using FusedTable = std::array<Kernel<float>, fused_op_count>;

/// The instruction sets that this build has kernels for; `baseline` is the compiler's default.
enum class InstructionSet : std::uint8_t {
    baseline,
    avx2,
    avx512
};

/// True when kernels were built for it and the processor runs them.
bool available(InstructionSet set);
/// The widest available.
InstructionSet widest();

/// Only for an available set.
template <class Number>
const KernelTable<Number>& kernels(InstructionSet set);
const FusedTable& fused_kernels(InstructionSet set);

/// `run` on one instruction set, for tests and benchmarks.
void run_on(InstructionSet set, const Tape& tape, Columns<float> inputs, Results<float> outputs,
            std::size_t count);

/// One number through the same functions as the double kernels, for the ends of intervals.
double exp2_one(double x);
double log2_one(double x);
double exp_one(double x);
double log_one(double x);
double sine_one(double x);
double cosine_one(double x);
double tangent_one(double x);
double arc_sine_one(double x);
double arc_cosine_one(double x);
double arc_tangent_one(double x);
double power_one(double x, double y);

namespace baseline {
extern const KernelTable<float> float_kernels;
extern const KernelTable<double> double_kernels;
extern const FusedTable fused_kernels;
}  // namespace baseline
namespace avx2 {
extern const KernelTable<float> float_kernels;
extern const KernelTable<double> double_kernels;
extern const FusedTable fused_kernels;
}  // namespace avx2
namespace avx512 {
extern const KernelTable<float> float_kernels;
extern const KernelTable<double> double_kernels;
extern const FusedTable fused_kernels;
}  // namespace avx512

}  // namespace lobe::evaluate
