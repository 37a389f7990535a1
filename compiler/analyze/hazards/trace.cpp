#include "analyze/hazards/trace.h"

#include "evaluate/half.h"
#include "evaluate/kernels.h"
#include "evaluate/literals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::Instruction;
using evaluate::Precision;
using evaluate::TapeOp;

struct ToFloat {
    double operator()(double x) const { return static_cast<double>(static_cast<float>(x)); }
};
struct ToHalf {
    double operator()(double x) const
    {
        return evaluate::round_to_half(x, evaluate::HalfMode::keep_denormals);
    }
};
struct Exactly {
    double operator()(double x) const { return x; }
};

template <class Rounding>
constexpr bool is_exact = std::is_same_v<Rounding, Exactly>;

double logarithm(double x)
{
    if (x == 0) return -std::numeric_limits<double>::infinity();
    return x < 0 ? std::numeric_limits<double>::quiet_NaN() : evaluate::log2_one(x);
}

/// exp2(y log2 x), each step rounded.
template <class Rounding>
double power(double x, double y)
{
    constexpr Rounding r;
    if constexpr (is_exact<Rounding>) return evaluate::power_one(x, y);
    const double exponent = r(y * r(logarithm(x)));
    return std::isnan(exponent) ? exponent : r(evaluate::exp2_one(exponent));
}

template <class Rounding>
double smooth(double low, double high, double x)
{
    constexpr Rounding r;
    const double ratio = r(r(x - low) / r(high - low));
    const double t = ratio > 0 ? std::fmin(ratio, 1) : 0;
    return r(r(t * t) * r(3 - 2 * t));
}

double truth(bool value) { return value ? 1 : 0; }

template <class Rounding>
double apply(const Instruction& step, const double* slots)
{
    constexpr Rounding r;
    const double a = slots[step.a];
    const double b = slots[step.b];
    const double c = slots[step.c];
    const double d = slots[step.d];
    switch (step.op) {
    case TapeOp::negate: return -a;
    case TapeOp::absolute: return std::fabs(a);
    case TapeOp::sign: return truth(a > 0) - truth(a < 0);
    case TapeOp::floor: return std::floor(a);
    case TapeOp::square: return r(a * a);
    case TapeOp::square_root: return r(std::sqrt(a));
    case TapeOp::inverse_square_root: return r(1 / std::sqrt(a));
    case TapeOp::exp2: return r(evaluate::exp2_one(a));
    case TapeOp::log2: return r(logarithm(a));
    case TapeOp::exp: return r(evaluate::exp_one(a));
    case TapeOp::log: return a > 0 ? r(evaluate::log_one(a)) : logarithm(a);
    case TapeOp::sine: return r(evaluate::sine_one(a));
    case TapeOp::cosine: return r(evaluate::cosine_one(a));
    case TapeOp::tangent: return r(evaluate::tangent_one(a));
    case TapeOp::arc_sine:
        return std::fabs(a) <= 1 ? r(evaluate::arc_sine_one(a))
                                 : std::numeric_limits<double>::quiet_NaN();
    case TapeOp::arc_cosine:
        return std::fabs(a) <= 1 ? r(evaluate::arc_cosine_one(a))
                                 : std::numeric_limits<double>::quiet_NaN();
    case TapeOp::arc_tangent: return r(evaluate::arc_tangent_one(a));
    case TapeOp::saturate: return a > 0 ? std::fmin(a, 1) : 0;
    case TapeOp::add: return r(a + b);
    case TapeOp::subtract: return r(a - b);
    case TapeOp::multiply: return r(a * b);
    case TapeOp::divide: return r(a / b);
    case TapeOp::power: return power<Rounding>(a, b);
    case TapeOp::minimum: return std::fmin(a, b);
    case TapeOp::maximum: return std::fmax(a, b);
    case TapeOp::step: return truth(b >= a);
    case TapeOp::normalized: return r(a / r(std::sqrt(b)));
    case TapeOp::lerp: return c == 1 && std::isfinite(a) ? b : r(a + r(r(b - a) * c));
    case TapeOp::clamp: return std::fmin(std::fmax(a, b), c);
    case TapeOp::smoothstep:
        if constexpr (is_exact<Rounding>)
            if (b <= a) return truth(c > a);
        return smooth<Rounding>(a, b, c);
    case TapeOp::less: return truth(a < b);
    case TapeOp::less_equal: return truth(a <= b);
    case TapeOp::equal: return truth(a == b);
    case TapeOp::not_equal: return truth(a != b);
    case TapeOp::logical_and: return truth(a != 0 && b != 0);
    case TapeOp::logical_or: return truth(a != 0 || b != 0);
    case TapeOp::logical_not: return truth(a == 0);
    case TapeOp::select: return a != 0 ? b : c;
    case TapeOp::sum3: return r(r(a + b) + c);
    case TapeOp::sum4: return r(r(r(a + b) + c) + d);
    }
    return 0;
}

}  // namespace

Trace::Trace(const WatchedLine& line, Precision precision)
    : line_{&line}, grid_{&grid_of(precision)}, device_(line.tape.slots), exact_(line.tape.slots),
      demanded_(line.tape.slots)
{
    for (const evaluate::Constant& constant : line.tape.constants) {
        exact_[constant.slot] = evaluate::to_double(constant.literal);
        device_[constant.slot] = precision == Precision::float16
                                     ? ToHalf{}(evaluate::to_half(constant.literal))
                                     : static_cast<double>(evaluate::to_float(constant.literal));
    }
}

template <class Rounding>
void Trace::run_as(std::span<const double> point, Repair repaired)
{
    constexpr Rounding r;
    for (std::size_t i = 0; i < line_->feeds.size(); ++i) {
        const double value = line_->feeds[i](point);
        exact_[i] = value;
        device_[i] = r(value);
    }
    any_infinite_ = false;
    const std::vector<Instruction>& code = line_->tape.code;
    for (std::size_t i = 0; i < code.size(); ++i) {
        const Instruction& step = code[i];
        const double exact = apply<Exactly>(step, exact_.data());
        const double device = repaired == i ? r(exact) : apply<Rounding>(step, device_.data());
        exact_[step.result] = exact;
        device_[step.result] = device;
        any_infinite_ |= std::isinf(device);
    }
}

void Trace::run(std::span<const double> point, Repair repaired)
{
    if (grid_->precision == Precision::float16)
        run_as<ToHalf>(point, repaired);
    else
        run_as<ToFloat>(point, repaired);
}

void Trace::confirm(std::span<const double> point)
{
    constexpr int bits = 113;
    evaluate::Tape all = line_->tape;
    all.outputs.clear();
    for (evaluate::Slot slot = 0; slot < all.slots; ++slot) all.outputs.push_back(slot);
    std::vector<evaluate::Real> inputs;
    // One minus a float has no more digits than 113 bits hold, and no more than double holds unless
    // the float is so small that nobody can tell.
    for (const WatchedLine::Feed& feed : line_->feeds) inputs.emplace_back(feed(point), bits);
    std::vector<evaluate::Real> values(all.slots, evaluate::Real{bits});
    std::vector<const evaluate::Real*> in;
    for (const evaluate::Real& input : inputs) in.push_back(&input);
    std::vector<evaluate::Real*> out;
    for (evaluate::Real& value : values) out.push_back(&value);
    evaluate::run_real(all, bits, in, out, 1);
    for (evaluate::Slot slot = 0; slot < all.slots; ++slot) exact_[slot] = values[slot].to_double();
}

void Trace::find_demand()
{
    std::ranges::fill(demanded_, 0);
    for (const evaluate::Slot slot : line_->tape.outputs) demanded_[slot] = 1;
    const std::vector<Instruction>& code = line_->tape.code;
    for (std::size_t i = code.size(); i-- > 0;) {
        const Instruction& step = code[i];
        if (demanded_[step.result] == 0) continue;
        if (step.op == TapeOp::select) {
            demanded_[step.a] = 1;
            demanded_[device_[step.a] != 0 ? step.b : step.c] = 1;
            continue;
        }
        const std::array operands{step.a, step.b, step.c, step.d};
        for (std::size_t k = 0; k < static_cast<std::size_t>(arity(step.op)); ++k)
            demanded_[operands[k]] = 1;
    }
}

double Trace::kept_bits(evaluate::Slot slot) const
{
    const auto digits = static_cast<double>(grid_->digits);
    const double exact = exact_[slot];
    const double error = std::fabs(device_[slot] - exact);
    if (error == 0) return digits;
    if (!(error < std::fabs(exact))) return 0;
    return std::min(digits, -std::log2(error / std::fabs(exact)));
}

}  // namespace lobe::analyze
