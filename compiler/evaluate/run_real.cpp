// MPFR: the same tape at any precision, as the truth that the others are measured against.
#include "evaluate/literals.h"
#include "evaluate/run.h"

#include <cassert>

namespace lobe::evaluate {
namespace {

constexpr mpfr_rnd_t nearest = MPFR_RNDN;

/// The registers of one run. Results go through `out_`, since a result's slot may be an operand's.
class RealUnit {
public:
    RealUnit(const Tape& tape, int bits)
        : slots_(tape.slots, Real{bits}), out_{bits}, first_{bits}, second_{bits}
    {
        for (const Constant& constant : tape.constants)
            slots_[constant.slot] = to_real(constant.literal, bits);
    }

    void set(std::size_t slot, const Real& value)
    {
        mpfr_set(slots_[slot].get(), value.get(), nearest);
    }
    const Real& operator[](std::size_t slot) const { return slots_[slot]; }

    void step(const Instruction& step)
    {
        apply(step.op, slots_[step.a].get(), slots_[step.b].get(), slots_[step.c].get(),
              slots_[step.d].get());
        mpfr_swap(slots_[step.result].get(), out_.get());
    }

private:
    void apply(TapeOp op, mpfr_srcptr a, mpfr_srcptr b, mpfr_srcptr c, mpfr_srcptr d);
    void smooth(mpfr_srcptr edge0, mpfr_srcptr edge1, mpfr_srcptr x);
    void power(mpfr_srcptr x, mpfr_srcptr y);
    void truth(bool value) { mpfr_set_si(out_.get(), value ? 1 : 0, nearest); }

    std::vector<Real> slots_;
    Real out_;
    Real first_;
    Real second_;
};

void RealUnit::smooth(mpfr_srcptr edge0, mpfr_srcptr edge1, mpfr_srcptr x)
{
    mpfr_ptr t = first_.get();
    mpfr_sub(t, x, edge0, nearest);
    mpfr_sub(second_.get(), edge1, edge0, nearest);
    mpfr_div(t, t, second_.get(), nearest);
    if (mpfr_sgn(t) <= 0) return truth(false);
    if (mpfr_cmp_si(t, 1) >= 0) return truth(true);
    mpfr_mul_si(out_.get(), t, 2, nearest);
    mpfr_si_sub(out_.get(), 3, out_.get(), nearest);
    mpfr_sqr(t, t, nearest);
    mpfr_mul(out_.get(), out_.get(), t, nearest);
}

void RealUnit::power(mpfr_srcptr x, mpfr_srcptr y)
{
    if (mpfr_zero_p(y) != 0)
        truth(true);
    else if (mpfr_sgn(x) <= 0)
        truth(false);
    else
        mpfr_pow(out_.get(), x, y, nearest);
}

void RealUnit::apply(TapeOp op, mpfr_srcptr a, mpfr_srcptr b, mpfr_srcptr c, mpfr_srcptr d)
{
    mpfr_ptr out = out_.get();
    switch (op) {
    case TapeOp::negate: mpfr_neg(out, a, nearest); break;
    case TapeOp::absolute: mpfr_abs(out, a, nearest); break;
    case TapeOp::sign: mpfr_set_si(out, mpfr_sgn(a), nearest); break;
    case TapeOp::floor: mpfr_rint_floor(out, a, nearest); break;
    case TapeOp::square: mpfr_sqr(out, a, nearest); break;
    case TapeOp::square_root: mpfr_sqrt(out, a, nearest); break;
    case TapeOp::inverse_square_root: mpfr_rec_sqrt(out, a, nearest); break;
    case TapeOp::exp2: mpfr_exp2(out, a, nearest); break;
    case TapeOp::log2: mpfr_log2(out, a, nearest); break;
    case TapeOp::exp: mpfr_exp(out, a, nearest); break;
    case TapeOp::log: mpfr_log(out, a, nearest); break;
    case TapeOp::sine: mpfr_sin(out, a, nearest); break;
    case TapeOp::cosine: mpfr_cos(out, a, nearest); break;
    case TapeOp::tangent: mpfr_tan(out, a, nearest); break;
    case TapeOp::arc_sine: mpfr_asin(out, a, nearest); break;
    case TapeOp::arc_cosine: mpfr_acos(out, a, nearest); break;
    case TapeOp::arc_tangent: mpfr_atan(out, a, nearest); break;
    case TapeOp::saturate:
        if (mpfr_sgn(a) <= 0)
            truth(false);
        else if (mpfr_cmp_si(a, 1) >= 0)
            truth(true);
        else
            mpfr_set(out, a, nearest);
        break;
    case TapeOp::add: mpfr_add(out, a, b, nearest); break;
    case TapeOp::subtract: mpfr_sub(out, a, b, nearest); break;
    case TapeOp::multiply: mpfr_mul(out, a, b, nearest); break;
    case TapeOp::divide: mpfr_div(out, a, b, nearest); break;
    case TapeOp::power: power(a, b); break;
    case TapeOp::minimum: mpfr_min(out, a, b, nearest); break;
    case TapeOp::maximum: mpfr_max(out, a, b, nearest); break;
    case TapeOp::step: truth(mpfr_greaterequal_p(b, a) != 0); break;
    case TapeOp::normalized:
        mpfr_sqrt(first_.get(), b, nearest);
        mpfr_div(out, a, first_.get(), nearest);
        break;
    case TapeOp::lerp:
        if (mpfr_cmp_si(c, 1) == 0) {
            mpfr_set(out, b, nearest);
            break;
        }
        mpfr_sub(first_.get(), b, a, nearest);
        mpfr_mul(first_.get(), first_.get(), c, nearest);
        mpfr_add(out, a, first_.get(), nearest);
        break;
    case TapeOp::clamp:
        mpfr_max(first_.get(), a, b, nearest);
        mpfr_min(out, first_.get(), c, nearest);
        break;
    case TapeOp::smoothstep:
        if (mpfr_less_p(a, b) != 0)
            smooth(a, b, c);
        else
            truth(mpfr_greater_p(c, a) != 0);
        break;
    case TapeOp::less: truth(mpfr_less_p(a, b) != 0); break;
    case TapeOp::less_equal: truth(mpfr_lessequal_p(a, b) != 0); break;
    case TapeOp::equal: truth(mpfr_equal_p(a, b) != 0); break;
    case TapeOp::not_equal: truth(mpfr_lessgreater_p(a, b) != 0); break;
    case TapeOp::logical_and: mpfr_min(out, a, b, nearest); break;
    case TapeOp::logical_or: mpfr_max(out, a, b, nearest); break;
    case TapeOp::logical_not: truth(mpfr_zero_p(a) != 0); break;
    case TapeOp::select: mpfr_set(out, mpfr_zero_p(a) != 0 ? c : b, nearest); break;
    case TapeOp::sum4:
        mpfr_add(first_.get(), a, b, nearest);
        mpfr_add(first_.get(), first_.get(), c, nearest);
        mpfr_add(out, first_.get(), d, nearest);
        break;
    case TapeOp::sum3:
        mpfr_add(first_.get(), a, b, nearest);
        mpfr_add(out, first_.get(), c, nearest);
        break;
    }
}

}  // namespace

void run_real(const Tape& tape, int bits, Columns<Real> inputs, Results<Real> outputs,
              std::size_t count)
{
    assert(inputs.size() == tape.inputs.size() && outputs.size() == tape.outputs.size());
    RealUnit unit{tape, bits};
    for (std::size_t point = 0; point < count; ++point) {
        for (std::size_t i = 0; i < inputs.size(); ++i) unit.set(i, inputs[i][point]);
        for (const Instruction& instruction : tape.code) unit.step(instruction);
        for (std::size_t i = 0; i < outputs.size(); ++i) outputs[i][point] = unit[tape.outputs[i]];
    }
}

}  // namespace lobe::evaluate
