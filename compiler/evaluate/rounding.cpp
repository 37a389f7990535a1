#include "evaluate/rounding.h"

#include "evaluate/half.h"
#include "evaluate/literals.h"
#include "evaluate/rounding_rules.h"

namespace lobe::evaluate {
namespace {

constexpr Rounding float_kernels{.precision = Precision::float32,
                                 .machine = Machine::kernels,
                                 .digits = 24,
                                 .unit = 0x1p-24,
                                 .largest = 0x1.fffffep127,
                                 .least_normal = 0x1p-126,
                                 .least = 0x1p-149,
                                 .nearest = true,
                                 .flushes = false};
constexpr Rounding half_kernels{.precision = Precision::float16,
                                .machine = Machine::kernels,
                                .digits = 11,
                                // A half is rounded from a double, that may be off by 2^-49.
                                .unit = 0x1p-11 * (1 + 0x1p-36),
                                .largest = 65504,
                                .least_normal = 0x1p-14,
                                .least = 0x1p-24,
                                .nearest = true,
                                .flushes = true};
constexpr Rounding float_vulkan{.precision = Precision::float32,
                                .machine = Machine::vulkan,
                                .digits = 24,
                                .unit = 0x1p-23,
                                .largest = 0x1.fffffep127,
                                .least_normal = 0x1p-126,
                                .least = 0x1p-149,
                                .nearest = false,
                                .flushes = true};
constexpr Rounding half_vulkan{.precision = Precision::float16,
                               .machine = Machine::vulkan,
                               .digits = 11,
                               .unit = 0x1p-10,
                               .largest = 65504,
                               .least_normal = 0x1p-14,
                               .least = 0x1p-24,
                               .nearest = false,
                               .flushes = true};

/// Numbers of the format below `size`, which is no number of a lower binade: one binade less for a
/// power of two, since what is rounded to it from below is spaced more closely.
int binade_below(double size) { return std::ilogb(next_down(size)); }

double round_to_format(const Rounding& rounding, double x)
{
    if (rounding.precision == Precision::float32) return static_cast<double>(static_cast<float>(x));
    return round_to_half(x, HalfMode::keep_denormals);
}

double round_up(const Rounding& rounding, double x)
{
    const double nearest = round_to_format(rounding, x);
    if (nearest >= x || std::abs(nearest) == infinity) return nearest;
    if (std::abs(nearest) < rounding.least_normal) return nearest + rounding.least;
    const double spacing = std::ldexp(1.0, std::ilogb(nearest) + 1 - rounding.digits);
    // Just above a negative power of two the spacing is half of that.
    const double next = nearest + spacing / 2;
    return nearest < 0 && round_to_format(rounding, next) == next ? next : nearest + spacing;
}

/// The operand's distance to the exact value may be that of a device that reads a denormal as 0.
double read_error(const Rounding& rounding, Interval x)
{
    return rounding.flushes && least_size(x) < rounding.least_normal ? rounding.least_normal : 0;
}

}  // namespace

const Rounding& rounding(Machine machine, Precision precision)
{
    if (machine == Machine::kernels)
        return precision == Precision::float32 ? float_kernels : half_kernels;
    return precision == Precision::float32 ? float_vulkan : half_vulkan;
}

double rounding_error(const Rounding& rounding, double size)
{
    if (!(size < infinity)) return infinity;
    const int ulp = size <= rounding.least_normal ? std::ilogb(rounding.least)
                                                  : binade_below(size) + 1 - rounding.digits;
    return std::ldexp(rounding.nearest ? 0.5 : 1.0, ulp) *
           (rounding.digits < 24 ? 1 + 0x1p-36 : 1.0);
}

Interval rounded(const Rounding& rounding, Interval x)
{
    Interval result =
        rounding.nearest
            ? Interval{round_to_format(rounding, x.low), round_to_format(rounding, x.high)}
            : Interval{-round_up(rounding, -x.low), round_up(rounding, x.high)};
    if (rounding.flushes) {
        if (result.low > 0 && result.low < rounding.least_normal) result.low = 0;
        if (result.high < 0 && result.high > -rounding.least_normal) result.high = 0;
    }
    return result;
}

Interval between(const Rounded& x)
{
    Interval result = hull(x.exact, x.computed);
    if (x.relative < 1) {
        const double spread = outward(times(x.relative, size(x.exact)) + x.underflow);
        result = hull(result, {add_down(x.exact.low, -spread), add_up(x.exact.high, spread)});
        if (x.exact.low >= 0 && x.computed.low >= 0) result.low = std::max(result.low, 0.0);
        if (x.exact.high <= 0 && x.computed.high <= 0) result.high = std::min(result.high, 0.0);
    }
    return result;
}

Rounded rounded_input(const Rounding& rounding, Interval range)
{
    Rounded result;
    result.exact = range;
    result.computed = range;
    result.smallest = std::max(least_size(range), rounding.least);
    result.underflow = result.absolute = read_error(rounding, range);
    if (result.underflow > 0) {
        result.computed = hull(range, {0, 0});
        result.smallest = rounding.least;
    }
    return result;
}

Rounded rounded_part(const Rounded& whole, Interval part)
{
    Rounded result = whole;
    result.exact = part;
    if (whole.relative < infinity)
        result.absolute = std::min(whole.absolute,
                                   outward(times(whole.relative, size(part)) + whole.underflow));
    if (const double least = least_size(part); least > 0) {
        const double direct = outward(result.absolute / least);
        if (direct < whole.relative && direct <= 0x1p-2) {
            result.relative = direct;
            result.underflow = 0;
        }
    }
    const double off = outward(result.absolute + whole.jump);
    if (off < infinity)
        result.computed =
            common(whole.computed, {add_down(part.low, -off), add_up(part.high, off)});
    result.smallest = std::max(whole.smallest, least_size(result.computed));
    return result;
}

Rounded rounded_literal(const Rounding& rounding, const ir::Literal& literal)
{
    Rounded result;
    result.exact = to_interval(literal);
    const double value = rounding.precision == Precision::float32
                             ? static_cast<double>(to_float(literal))
                             : to_half(literal);
    result.computed = {value, value};
    result.absolute = std::max(add_up(value, -result.exact.low), add_up(result.exact.high, -value));
    const double least = least_size(result.exact);
    result.relative = result.absolute == 0 ? 0 : least > 0 ? divide_up(result.absolute, least) : 1;
    if (least == 0) result.underflow = result.absolute;
    result.smallest = std::max(std::abs(value), rounding.least);
    const double read = read_error(rounding, result.computed);
    if (read > 0 && value != 0) {
        result.computed = hull(result.computed, {0, 0});
        result.absolute += read;
        result.underflow += read;
    }
    return result;
}

Interval Rules::of_exact() const
{
    const auto at = [this](std::size_t i) { return i < in_.size() ? in_[i].exact : Interval{}; };
    return apply(op_, at(0), at(1), at(2), at(3));
}

Interval Rules::of_computed() const
{
    const auto at = [this](std::size_t i) { return i < in_.size() ? in_[i].computed : Interval{}; };
    return apply(op_, at(0), at(1), at(2), at(3));
}

/// One rounding. `underflows`: a denormal result is not exact anyway, as that of a sum is.
Own Rules::correctly(Interval through, bool underflows) const
{
    Own own;
    own.absolute = rounding_error(rounding_, size(through));
    own.relative = rounding_.unit;
    const double least = least_size(through);
    if (least >= rounding_.least_normal)
        own.relative = std::min(own.relative, outward(own.absolute / least));
    else if (rounding_.flushes)
        own.underflow = rounding_.least_normal;
    else if (underflows)
        own.underflow = rounding_.least / 2;
    own.absolute = std::max(own.absolute, own.underflow);
    return own;
}

/// An operation that is off by no more than the lesser of both.
Own Rules::within(Interval through, double relative, double absolute, bool underflows) const
{
    Own own;
    own.rounds = false;
    const double most = size(through);
    own.absolute = std::min(outward(times(relative, most) + rounding_.least), absolute);
    own.relative = relative;
    const double least = least_size(through);
    if (least > 0 && absolute < infinity)
        own.relative = std::min(relative, outward(absolute / least));
    if (underflows && least < rounding_.least_normal)
        own.underflow = rounding_.flushes ? rounding_.least_normal : rounding_.least;
    own.absolute = outward(own.absolute + own.underflow);
    return own;
}

/// The relative error that an operand's underflow amounts to where it is a divisor, or under a
/// root or power: little, but where the operand itself is hardly more than it. That is a jump.
double Rules::fold(const Rounded& x)
{
    if (x.underflow == 0) return 0;
    const double least = least_size(x.exact);
    const double plain = least > 0 ? outward(x.underflow / least) : infinity;
    constexpr double negligible = 0x1p-40;
    if (plain <= negligible) return plain;
    extra_jump_ = infinity;
    return negligible;
}

Step Rules::combine(Interval exact, Interval through, const Own& own, bool chooses)
{
    Step result;
    Rounded& value = result.value;
    value.exact = exact;
    result.slopes = slopes_;
    result.chooses = chooses;

    double absolute = 0;
    double relative = 0;
    double underflow = 0;
    // Where an operand jumps, no bound that knows its relative error counts: the whole error once
    // more, by absolute slopes.
    double jump = extra_jump_;
    bool jumps = extra_jump_ > 0;
    const auto gather = [chooses](double& total, double part) {
        total = chooses ? std::max(total, part) : total + part;
    };
    for (std::size_t i = 0; i < in_.size(); ++i) {
        const Rounded& x = in_[i];
        const Slope& slope = slopes_[i];
        // An unknown relative error says nothing, not even where the operand is 0.
        const bool known = x.relative < infinity;
        const double by_relative = known ? times(size(slope.ar), x.relative) +
                                               times(size(slope.aa), folded_[i] ? 0 : x.underflow)
                                         : infinity;
        gather(absolute, std::min(times(size(slope.aa), x.absolute), by_relative));
        const double through_relative = known ? times(size(slope.rr), x.relative) : infinity;
        const double through_absolute = times(size(slope.ra), x.absolute);
        // In the units of the operand's own bound, so that the parts of a sum stay comparable.
        if (!known || (through_absolute <= through_relative && x.underflow == 0)) {
            gather(relative, std::min(through_absolute, through_relative));
        } else {
            gather(relative, through_relative);
            if (!folded_[i]) gather(underflow, times(size(slope.aa), x.underflow));
        }
        jumps = jumps || times(size(slope.aa), x.jump) > 0;
        gather(jump, times(size(slope.aa), x.jump + x.absolute));
    }
    relative += extra_relative_;
    if (extra_relative_ > 0) absolute += times(extra_relative_, size(exact));

    result.own_absolute = outward(own.absolute + times(extra_relative_, size(exact)));
    result.own_relative = outward(own.relative * (1 + relative) + extra_relative_);
    value.absolute = outward(absolute + own.absolute);
    value.relative = outward(relative + own.relative * (1 + relative));
    value.underflow = outward(times(underflow, 1 + own.relative) + own.underflow);
    const double all_underflow = value.underflow;
    value.jump = jumps ? outward(jump + own.absolute) : 0;

    // An operand that may have overflowed may make a NaN, or stay infinite. A select passes on what
    // it takes; a minimum or maximum of x and y is y where x is a NaN, and a NaN where y is.
    bool overflowed = false;
    if (!chooses)
        for (const Rounded& x : in_) overflowed = overflowed || !is_bounded(x.computed);
    else if (op_ != TapeOp::select)
        overflowed = !is_bounded(b().computed);

    // What may be computed: the operation's own range, and what its error leaves.
    if (own.absolute == 0 && own.underflow == 0)
        value.computed = through;
    else if (own.rounds)
        value.computed = rounded(rounding_, through);
    else {
        const auto off = [&own](double end) {
            return std::min(own.absolute, outward(own.relative * std::abs(end) + own.underflow));
        };
        value.computed = {add_down(through.low, -off(through.low)),
                          add_up(through.high, off(through.high))};
    }
    if (overflowed) value.computed = everything;
    if (!(size(value.computed) <= rounding_.largest)) {
        value.jump = infinity;
        value.computed = {value.computed.low < -rounding_.largest ? -infinity : value.computed.low,
                          value.computed.high > rounding_.largest ? infinity : value.computed.high};
    }
    const double apart = is_bounded(value.computed) && is_bounded(exact)
                             ? std::max({add_up(value.computed.high, -exact.low),
                                         add_up(exact.high, -value.computed.low), 0.0})
                             : infinity;
    value.absolute = std::min(value.absolute, apart);
    value.jump = std::min(value.jump, apart);
    if (!(value.relative <= 0x1p-2) || !(value.underflow < infinity)) {
        value.relative = infinity;
        value.underflow = 0;
    } else {
        value.absolute =
            std::min(value.absolute, outward(value.relative * size(exact) + value.underflow));
    }
    const double least = least_size(exact);
    if (least > 0) {
        const double direct = outward(value.absolute / least);
        if (direct < value.relative && direct <= 0x1p-2) {
            value.relative = direct;
            value.underflow = 0;
            result.own_relative =
                outward(std::min(own.relative * (1 + direct), own.absolute / least) +
                        extra_relative_ + all_underflow / least);
        }
    }
    const double distance = outward(value.absolute + value.jump);
    if (distance < infinity)
        value.computed =
            common(value.computed, {add_down(exact.low, -distance), add_up(exact.high, distance)});
    value.smallest = std::max(least_size(value.computed), rounding_.least);
    return result;
}

/// A result that depends on its operands by a condition alone: exact, or turned.
Step Rules::decision(Interval exact, Interval computed) const
{
    Step result;
    result.value.exact = exact;
    result.value.computed = computed;
    result.value.smallest = rounding_.least;
    for (Slope& slope : result.slopes) slope = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    const bool same = exact == computed && exact.low == exact.high;
    bool certain = true;
    for (const Rounded& x : in_) certain = certain && x.absolute == 0 && x.jump == 0;
    if (!same && !certain)
        result.value.jump =
            !is_bounded(exact) || !is_bounded(computed)
                ? infinity
                : std::max(add_up(computed.high, -exact.low), add_up(exact.high, -computed.low));
    return result;
}

Step Rules::step()
{
    constexpr double ln2 = 0x1.62e42fefa39efp-1;
    switch (op_) {
    case TapeOp::negate: {
        slopes_[0] = {{-1, -1}, negate(a().exact), everything, {1, 1}};
        Step result = combine(of_exact(), of_computed(), exactly());
        result.value.smallest = a().smallest;
        return result;
    }
    case TapeOp::absolute: {
        const Interval x = between(a());
        const Interval sign{x.low < 0 ? -1.0 : 1.0, x.high > 0 ? 1.0 : -1.0};
        slopes_[0] = {sign, evaluate::multiply(sign, a().exact), everything, {1, 1}};
        Step result = combine(of_exact(), of_computed(), exactly());
        result.value.smallest = a().smallest;
        return result;
    }
    case TapeOp::square: return square();
    case TapeOp::square_root: return square_root();
    case TapeOp::normalized: return normalized();
    case TapeOp::inverse_square_root: return inverse_square_root();
    case TapeOp::exp2: return exponential(ln2);
    case TapeOp::exp: return exponential(1);
    case TapeOp::log2: return logarithm(1 / ln2);
    case TapeOp::log: return logarithm(1);
    case TapeOp::sine:
    case TapeOp::cosine:
    case TapeOp::tangent: return wave();
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine:
    case TapeOp::arc_tangent: return arc();
    case TapeOp::add: return sum(1);
    case TapeOp::subtract: return sum(-1);
    case TapeOp::sum3:
    case TapeOp::sum4: return long_sum();
    case TapeOp::multiply: return multiply();
    case TapeOp::divide: return divide();
    case TapeOp::power: return power();
    case TapeOp::minimum:
    case TapeOp::maximum: return choose_extreme();
    case TapeOp::lerp: return lerp();
    case TapeOp::smoothstep: return hermite();
    case TapeOp::select: return select();
    case TapeOp::sign:
    case TapeOp::floor:
    case TapeOp::step:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or:
    case TapeOp::logical_not: return decision(of_exact(), of_computed());
    // Taken apart by rounding_tape.
    case TapeOp::saturate:
    case TapeOp::clamp: break;
    }
    return combine(everything, everything, {infinity, infinity, 0, false});
}

Step step(const Rounding& rounding, TapeOp op, std::span<const Rounded> operands)
{
    return Rules{rounding, op, operands}.step();
}

}  // namespace lobe::evaluate
