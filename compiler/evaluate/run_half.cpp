// binary16, by rounding double: a double result of two halves is exact, or so much closer to the
// true value than to the midpoint of two halves that rounding it again rounds the true value.
#include "evaluate/blocks.h"
#include "evaluate/half.h"
#include "evaluate/literals.h"

#include <array>
#include <cassert>

namespace lobe::evaluate {
namespace {

using Lane = std::array<double, block_lanes>;

class HalfUnit {
public:
    HalfUnit(HalfMode mode, const KernelTable<double>& table) : mode_{mode}, table_{table} {}

    void round(double* lanes) const
    {
        for (std::size_t i = 0; i < block_lanes; ++i) lanes[i] = round_to_half(lanes[i], mode_);
    }

    /// One operation of the tape. Those that a target computes in steps are rounded at each.
    void step(TapeOp op, double* result, const double* a, const double* b, const double* c,
              const double* d);

private:
    /// Operands past the arity are read and ignored.
    void simple(TapeOp op, double* result, const double* a, const double* b, const double* c) const
    {
        table_[static_cast<std::size_t>(op)](result, a, b, c, a);
        round(result);
    }
    void simple(TapeOp op, double* result, const double* a, const double* b) const
    {
        simple(op, result, a, b, a);
    }
    void simple(TapeOp op, double* result, const double* a) const { simple(op, result, a, a, a); }
    void smooth(double* result, const double* edge0, const double* edge1, const double* x);

    HalfMode mode_;
    const KernelTable<double>& table_;
    Lane first_{};
    Lane second_{};
};

/// t = saturate((x - edge0) / (edge1 - edge0)); t * t * (3 - 2 * t)
void HalfUnit::smooth(double* result, const double* edge0, const double* edge1, const double* x)
{
    double* const t = first_.data();
    double* const slope = second_.data();
    simple(TapeOp::subtract, t, x, edge0);
    simple(TapeOp::subtract, slope, edge1, edge0);
    simple(TapeOp::divide, t, t, slope);
    simple(TapeOp::saturate, t, t);
    for (std::size_t i = 0; i < block_lanes; ++i) slope[i] = 3 - 2 * t[i];
    round(slope);
    simple(TapeOp::square, t, t);
    simple(TapeOp::multiply, result, t, slope);
}

void HalfUnit::step(TapeOp op, double* result, const double* a, const double* b, const double* c,
                    const double* d)
{
    double* const first = first_.data();
    switch (op) {
    case TapeOp::sum3:
        simple(TapeOp::add, first, a, b);
        simple(TapeOp::add, result, first, c);
        return;
    case TapeOp::sum4:
        simple(TapeOp::add, first, a, b);
        simple(TapeOp::add, first, first, c);
        simple(TapeOp::add, result, first, d);
        return;
    case TapeOp::lerp:
        simple(TapeOp::subtract, first, b, a);
        simple(TapeOp::multiply, first, first, c);
        simple(TapeOp::add, first, first, a);
        for (std::size_t i = 0; i < block_lanes; ++i) result[i] = c[i] == 1 ? b[i] : first[i];
        return;
    case TapeOp::normalized:
        simple(TapeOp::square_root, first, b);
        simple(TapeOp::divide, result, a, first);
        return;
    case TapeOp::smoothstep: smooth(result, a, b, c); return;
    case TapeOp::negate:
    case TapeOp::absolute:
    case TapeOp::sign:
    case TapeOp::floor:
    case TapeOp::square:
    case TapeOp::square_root:
    case TapeOp::inverse_square_root:
    case TapeOp::exp2:
    case TapeOp::log2:
    case TapeOp::exp:
    case TapeOp::log:
    case TapeOp::sine:
    case TapeOp::cosine:
    case TapeOp::tangent:
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine:
    case TapeOp::arc_tangent:
    case TapeOp::saturate:
    case TapeOp::add:
    case TapeOp::subtract:
    case TapeOp::multiply:
    case TapeOp::divide:
    case TapeOp::power:
    case TapeOp::minimum:
    case TapeOp::maximum:
    case TapeOp::step:
    case TapeOp::clamp:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or:
    case TapeOp::logical_not:
    case TapeOp::select: simple(op, result, a, b, c); return;
    }
}

}  // namespace

void run_half(const Tape& tape, HalfMode mode, Columns<float> inputs, Results<float> outputs,
              std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    HalfUnit unit{mode, kernels<double>(widest())};
    std::vector<Lane> slots(tape.slots);
    for (const Constant& constant : tape.constants) {
        slots[constant.slot].fill(to_half(constant.literal));
        unit.round(slots[constant.slot].data());
    }
    for (std::size_t begin = 0; begin < count; begin += block_lanes) {
        const std::size_t size = std::min(block_lanes, count - begin);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            slots[i].fill(static_cast<double>(inputs[i][begin]));
            for (std::size_t lane = 0; lane < size; ++lane)
                slots[i][lane] = static_cast<double>(inputs[i][begin + lane]);
            unit.round(slots[i].data());
        }
        for (const Instruction& step : tape.code)
            unit.step(step.op, slots[step.result].data(), slots[step.a].data(),
                      slots[step.b].data(), slots[step.c].data(), slots[step.d].data());
        for (std::size_t i = 0; i < outputs.size(); ++i)
            for (std::size_t lane = 0; lane < size; ++lane)
                outputs[i][begin + lane] = static_cast<float>(slots[tape.outputs[i]][lane]);
    }
}

}  // namespace lobe::evaluate
