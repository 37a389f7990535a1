#include "evaluate/acceptance.h"

#include "evaluate/device_rules.h"
#include "evaluate/intervals.h"
#include "evaluate/kernels.h"

namespace lobe::evaluate {
namespace {

constexpr Rules float32_rules{.digits = 24,
                              .epsilon = 0x1p-23,
                              .largest = 0x1.fffffep127,
                              .least_normal = 0x1p-126,
                              .largest_divisor = 0x1p126,
                              .exp2_units = 3,
                              .log2_error = 0x1p-21,
                              .sine_error = 0x1p-11,
                              .atan2_units = 4096};

constexpr Rules float16_rules{.digits = 11,
                              .epsilon = 0x1p-10,
                              .largest = 65504,
                              .least_normal = 0x1p-14,
                              .largest_divisor = 0x1p14,
                              .exp2_units = 1,
                              .log2_error = 0x1p-7,
                              .sine_error = 0x1p-7,
                              .atan2_units = 5};

Acceptance select(const Acceptance& condition, const Acceptance& yes, const Acceptance& no)
{
    if (condition.undefined) {
        Acceptance result = hull(yes, no);
        result.undefined = true;
        return result;
    }
    if (condition.low > 0) return yes;
    return condition.high == 0 ? no : hull(yes, no);
}

}  // namespace

const Rules& rules(Precision precision)
{
    return precision == Precision::float32 ? float32_rules : float16_rules;
}

Acceptance admit(const Rules& rules, Acceptance x) { return Device{rules}.admitted(x); }

Acceptance apply(const Rules& rules, TapeOp op, const Acceptance& a, const Acceptance& b,
                 const Acceptance& c, const Acceptance& d)
{
    const Device device{rules};
    // Operations that choose or compare, and round nothing.
    const auto exact1 = [&] {
        const Interval result = apply(op, bounds(a), {}, {}, {});
        return Acceptance{result.low, result.high, a.undefined};
    };
    const auto exact2 = [&] {
        const Interval result = apply(op, bounds(a), bounds(b), {}, {});
        return Acceptance{result.low, result.high, a.undefined || b.undefined};
    };

    switch (op) {
    case TapeOp::negate:
    case TapeOp::absolute:
    case TapeOp::sign:
    case TapeOp::floor:
    case TapeOp::saturate:
    case TapeOp::logical_not: return exact1();
    case TapeOp::minimum:
        return {std::min(a.low, b.low), std::min(a.high, b.high), a.undefined || b.undefined};
    case TapeOp::maximum:
        return {std::max(a.low, b.low), std::max(a.high, b.high), a.undefined || b.undefined};
    case TapeOp::step:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or: return exact2();
    case TapeOp::clamp: {
        const Interval result = apply(op, bounds(a), bounds(b), bounds(c), {});
        return {result.low, result.high, a.undefined || b.undefined || c.undefined};
    }
    case TapeOp::square: return device.square(a);
    case TapeOp::square_root: return device.square_root(a);
    case TapeOp::inverse_square_root: return device.inverse_square_root(a);
    case TapeOp::exp2: return device.exponential(a, exp2_one);
    case TapeOp::exp: return device.exponential(a, exp_one);
    case TapeOp::log2: return device.logarithm(a, log2_one);
    case TapeOp::log: return device.logarithm(a, log_one);
    case TapeOp::sine: return device.wave(a, sine(bounds(a)));
    case TapeOp::cosine: return device.wave(a, cosine(bounds(a)));
    case TapeOp::tangent: return device.tangent(a);
    case TapeOp::arc_sine: return device.arc_sine(a);
    case TapeOp::arc_cosine: return device.arc_cosine(a);
    case TapeOp::arc_tangent: return device.arc_tangent(a);
    case TapeOp::add: return device.add(a, b);
    case TapeOp::subtract: return device.subtract(a, b);
    case TapeOp::multiply: return device.multiply(a, b);
    case TapeOp::divide: return device.divide(a, b);
    case TapeOp::power: return device.power(a, b);
    case TapeOp::normalized: return device.normalized(a, b);
    case TapeOp::lerp: return device.lerp(a, b, c);
    case TapeOp::smoothstep: return device.smoothstep(a, b, c);
    case TapeOp::select: return select(a, b, c);
    case TapeOp::sum3: return device.sum3(a, b, c);
    case TapeOp::sum4: return device.sum4({a, b, c, d});
    }
    return {-infinity, infinity, true};
}

}  // namespace lobe::evaluate