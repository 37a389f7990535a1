// Roots, exponentials, logarithms, powers and angles.
//
// What the float kernels of exp2 and log2 are off by was measured over all floats; see
// docs/numerics.md. The other functions go through double and are rounded once.
#include "evaluate/rounding_rules.h"

namespace lobe::evaluate {
namespace {

constexpr double ln2 = 0x1.62e42fefa39efp-1;
constexpr double one_over_e = 0x1.78b56362cef38p-2 * (1 + 0x1p-50);

/// Relative errors of the float kernels, rounded up: 1.734 and 2.232 times 2^-24 were found.
constexpr double exp2_error = 1.75 * 0x1p-24;
constexpr double log2_error = 2.25 * 0x1p-24;
/// Past this exponent a float is 0.
constexpr double deepest = 150;

/// w e^-w, which rises up to w = 1 and falls from there; for w >= 0.
double fading(double w) { return w > 1000 ? 0 : w * std::exp(-w) * (1 + 0x1p-48); }
double most_fading(Interval w)
{
    if (w.low <= 1 && w.high >= 1) return one_over_e;
    return fading(w.high < 1 ? w.high : w.low);
}

/// The values of x e^x.
Interval growing(Interval x)
{
    if (x.high <= 0) return {-most_fading({-x.high, -x.low}), 0};
    const double up = x.high > 700 ? infinity : outward(x.high * std::exp(x.high));
    return {x.low >= 0 ? 0 : -most_fading({0, -x.low}), up};
}

/// 1 / (1 + r) for |r| up to this: what turns log(1 + r) into r.
Interval near_one(double relative) { return divide({1, 1}, around(1, relative)); }

}  // namespace

Step Rules::square_root()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    // 1 / (sqrt a + sqrt a')
    const Interval roots = add(exact, hull(exact, through));
    if (roots.low > 0) slopes_[0].aa = evaluate::divide({1, 1}, roots);
    const double r = a().relative;
    if (r <= 0.25) {
        // sqrt(1 + r) - 1 = r / (1 + sqrt(1 + r))
        slopes_[0].rr = evaluate::divide({1, 1}, add({1, 1}, evaluate::square_root(around(1, r))));
        slopes_[0].ar = evaluate::multiply(slopes_[0].rr, exact);
    }
    if (least_size(exact) > 0 && roots.low > 0)
        slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
    // |sqrt a - sqrt b| <= sqrt |a - b|
    folded_[0] = true;
    double underflow = root_up(a().underflow);
    double steep = infinity;
    if (const double least = least_size(a().exact); least > 0)
        steep = outward(a().underflow / root_down(least));
    if (rounding_.machine == Machine::vulkan && least_size(a().computed) < rounding_.least_normal) {
        // A device may read a denormal as nearly the least normal number.
        underflow =
            root_up(std::max(a().underflow, rounding_.least_normal)) * (1 + 16 * rounding_.unit);
        steep = infinity;
    }
    Own own = correctly(through, false);
    if (rounding_.machine == Machine::vulkan)
        own = within(through, 4.5 * rounding_.unit * (1 + 0x1p-8), infinity, true);
    if (through == Interval{0, 0} || (through == Interval{1, 1} && rounding_.nearest))
        own = exactly();
    own.underflow = outward(own.underflow + std::min(underflow, steep));
    own.absolute = outward(own.absolute + std::min(underflow, steep));
    const double apart = root_up(a().absolute);
    Step result = combine(exact, through, own);
    if (own.rounds || own.absolute == 0)
        result.value.computed = common(rounded(rounding_, through), result.value.computed);
    result.value.absolute =
        std::min(result.value.absolute, outward(apart + own.absolute + underflow));
    result.value.computed.low = std::max(result.value.computed.low, 0.0);
    return result;
}

Step Rules::inverse_square_root()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x = between(a());
    if (x.low > 0)
        slopes_[0].aa =
            evaluate::divide({-0.5, -0.5}, evaluate::multiply(x, evaluate::square_root(x)));
    extra_relative_ = fold(a());
    folded_[0] = a().underflow > 0;
    const double r = a().relative + extra_relative_;
    if (r <= 0.125) {
        slopes_[0].rr =
            evaluate::divide({-0.5, -0.5}, evaluate::multiply(around(1, r), around(1, r)));
        slopes_[0].ar = evaluate::multiply(slopes_[0].rr, exact);
    }
    if (least_size(exact) > 0) slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
    const double u = rounding_.unit;
    Own own = within(through, (rounding_.digits == 24 ? 2 : 1) * u * (1 + 4 * u), infinity, false);
    if (rounding_.machine == Machine::vulkan)
        own = within(through, 2 * u * (1 + 0x1p-8), infinity, true);
    return combine(exact, through, own);
}

/// x / sqrt(squares)
Step Rules::normalized()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const double u = rounding_.unit;
    const double divisor = fold(b());
    folded_[1] = b().underflow > 0;
    extra_relative_ = divisor;
    const double r = b().relative + divisor;
    if (r <= 0.125) {
        const Interval inverse = near_one(outward(r));
        slopes_[0].rr = inverse;
        slopes_[0].ar = evaluate::multiply(inverse, exact);
        slopes_[1].rr = evaluate::multiply({-0.5, 0.5}, evaluate::multiply(inverse, inverse));
        slopes_[1].ar = evaluate::multiply(slopes_[1].rr, exact);
    }
    const Interval squares = between(b());
    if (squares.low > 0) {
        slopes_[0].aa = evaluate::inverse_square_root(squares);
        slopes_[1].aa = evaluate::divide(
            evaluate::multiply(evaluate::divide({-0.5, 0.5}, squares), exact), {1, 1});
    }
    for (std::size_t i = 0; i < 2; ++i)
        if (least_size(exact) > 0) slopes_[i].ra = evaluate::divide(slopes_[i].aa, exact);
    const double units = rounding_.machine == Machine::vulkan ? 7.1 : 2;
    return combine(exact, through, within(through, units * u * (1 + 8 * u), infinity, true));
}

Step Rules::exponential(double scale)
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x = between(a());
    const Interval factor = around(scale, scale == 1 ? 0 : 0x1p-52);
    slopes_[0].aa = evaluate::multiply(factor, apply(op_, x, {}, {}, {}));
    // x e^x: however far down x is, its relative error moves the result by no more than 1 / e.
    if (a().relative < 0.25) {
        const Interval natural = evaluate::multiply(factor, x);
        slopes_[0].ar = evaluate::multiply(growing(natural), near_one(a().relative));
    } else {
        slopes_[0].ar = evaluate::multiply(slopes_[0].aa, a().exact);
    }
    const double moved = outward(scale * a().absolute);
    if (moved < 0.1) {
        slopes_[0].ra = evaluate::multiply(factor, around(1, moved));
        slopes_[0].rr = evaluate::multiply(slopes_[0].ra, a().exact);
    }
    Own own = correctly(through, true);
    const Interval bits = evaluate::multiply(
        scale == 1 ? Interval{1.4426950408889634, 1.4426950408889636} : Interval{1, 1},
        a().computed);
    if (rounding_.machine == Machine::vulkan)
        own = raised(bits, through, 0, 0);
    else if (op_ == TapeOp::exp2 && rounding_.digits == 24)
        own = within(through, exp2_error, infinity, true);
    if (a().computed == Interval{0, 0} && rounding_.nearest) own = exactly();
    Step result = combine(exact, through, own);
    result.value.computed.low = std::max(result.value.computed.low, 0.0);
    return result;
}

Step Rules::logarithm(double scale)
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x = between(a());
    const Interval factor = around(scale, scale == 1 ? 0 : 0x1p-51);
    if (x.low > 0) slopes_[0].aa = evaluate::divide(factor, x);
    extra_relative_ = 0;
    const double folded = fold(a());
    folded_[0] = a().underflow > 0;
    const double r = a().relative + folded;
    if (r < 0.25) slopes_[0].ar = evaluate::multiply(factor, near_one(r));
    if (least_size(exact) > 0) {
        slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
        slopes_[0].rr = evaluate::divide(slopes_[0].ar, exact);
    }
    Own own = correctly(through, false);
    if (rounding_.machine == Machine::vulkan) {
        // Relative, but near 1, where it is so much whatever the result is.
        const double relative = 3 * rounding_.unit * (1 + 0x1p-8);
        const bool inside = a().computed.low <= 2 && a().computed.high >= 0.5;
        const double near = inside ? (rounding_.digits == 24 ? 0x1p-21 : 0x1p-7) : 0.0;
        own = within(through, relative, infinity, true);
        own.underflow = outward(own.underflow + near);
        own.absolute = outward(std::max(relative * size(through), near) + own.underflow);
    } else if (op_ == TapeOp::log2 && rounding_.digits == 24) {
        own = within(through, log2_error, infinity, false);
    }
    own.absolute = outward(own.absolute + (folded > 0 ? 2 * folded * scale : 0));
    own.underflow = outward(own.underflow + (folded > 0 ? 2 * folded * scale : 0));
    return combine(exact, through, own);
}

/// The error of 2^(y log2 x) for computed x and y, by the exponents that it passes through.
Own Rules::powers(Interval exponent, Interval through) const
{
    const double u = rounding_.unit;
    double of_log = log2_error;  // relative
    double near = 0;             // absolute, of log2
    if (rounding_.machine == Machine::vulkan) {
        of_log = 3 * u * (1 + 0x1p-8);
        if (a().computed.low <= 2 && a().computed.high >= 0.5)
            near = (rounding_.digits == 24 ? 0x1p-21 : 0x1p-7) * (1 + 2 * u) * size(b().computed);
    }
    // Error of the exponent, per its size, beside what exp2 adds.
    return raised(exponent, through, ln2 * (of_log + u * (1 + of_log)), ln2 * near);
}

/// The error of exp2 for computed exponents that are off by `per_exponent` of their size over ln 2,
/// and by `fixed` over ln 2.
Own Rules::raised(Interval exponent, Interval through, double per_exponent, double fixed) const
{
    if (rounding_.machine == Machine::vulkan) {
        per_exponent += 2 * rounding_.unit * (1 + 0x1p-8);
        fixed += 3.25 * rounding_.unit;
    } else {
        fixed += exp2_error;
    }
    const auto at = [&](double e) {
        const double first = per_exponent * e + fixed;
        return first > 0.1 ? infinity : outward(first * (1 + 2 * first));
    };
    Own own;
    own.rounds = false;
    const double deep = rounding_.digits == 24 ? deepest : 26;
    const double up = std::max(exponent.high, 0.0);
    const double down = std::min(std::max(-exponent.low, 0.0), deep);
    own.relative = at(std::max(up, down));
    if (exponent.low < -deep + 26)
        own.underflow = rounding_.flushes ? 2 * rounding_.least_normal : 4 * rounding_.least;
    // Far down the error fades with the result: 2^-e e, as fading(e ln 2) / ln 2.
    const Interval depth{std::max(-exponent.high, 0.0) * ln2, std::max(-exponent.low, 0.0) * ln2};
    const double first = per_exponent / ln2 * most_fading(depth) + fixed * std::exp(-depth.low);
    const double worst = at(down);
    const double below = outward(first * (1 + 2 * worst));
    own.absolute = up > 0 ? std::max(below, outward(own.relative * size(through))) : below;
    own.absolute = outward(own.absolute + own.underflow);
    return own;
}

/// x^y for x >= 0: 1 where y = 0, else 0 where x = 0.
Step Rules::power()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x{std::max(between(a()).low, 0.0), std::max(between(a()).high, 0.0)};
    const Interval y = between(b());
    const Interval base{std::max(a().exact.low, 0.0), std::max(a().exact.high, 0.0)};
    const Interval results = evaluate::power(x, y);
    const Interval logs =
        base.low > 0 ? log(base) : Interval{-infinity, base.high > 0 ? log(base).high : infinity};

    // y x^(y-1), and y x^y by relative error of x
    if (x.low > 0 || y.low >= 1)
        slopes_[0].aa = evaluate::multiply(y, evaluate::power(x, evaluate::subtract(y, {1, 1})));
    const double by_base = fold(a());
    folded_[0] = a().underflow > 0;
    const double rx = outward(a().relative + by_base);
    extra_relative_ = outward(2 * size(y) * by_base);
    if (rx < 0.25) slopes_[0].ar = evaluate::multiply(evaluate::multiply(y, results), near_one(rx));

    // x^y ln x, which is (1 / y) w e^-w with w = -y ln x, and y times that by relative error of y
    Interval steep = everything;
    if (base.low > 0)
        steep = evaluate::multiply(evaluate::power(base, y), logs);
    else if (y.low > 0)
        steep = {-outward(one_over_e / y.low),
                 logs.high > 0 ? outward(logs.high * evaluate::power(base, y).high) : 0.0};
    slopes_[1].aa = steep;
    double by_exponent = 0;
    if (b().underflow > 0 && y.low <= 0) {
        // A vanishing exponent: x^y is 1 but for x = 0 or next to it.
        extra_jump_ = infinity;
        folded_[1] = true;
        by_exponent = outward(200 * b().underflow);
    }
    const double ry = b().relative;
    if (ry < 0.25 && y.low >= 0) {
        Interval weighted = growing(evaluate::multiply(y, logs));
        slopes_[1].ar = evaluate::multiply(weighted, near_one(ry));
    }
    // In relative units: (1 + r)^y - 1, and x^(y' - y) - 1
    const double lifted = times(size(evaluate::multiply(y, logs)), ry);
    const double moved = times(size(logs), b().absolute);
    const double second = std::min(lifted, moved);
    if (lifted < 0.1)
        slopes_[1].rr = evaluate::multiply(evaluate::multiply(y, logs), around(1, outward(lifted)));
    if (moved < 0.1) slopes_[1].ra = evaluate::multiply(logs, around(1, outward(moved)));
    if (size(y) * rx < 0.1 && second < 0.1) {
        slopes_[0].rr =
            evaluate::multiply(y, around(1, outward(2 * (size(y) * rx + second) + 4 * rx)));
        if (least_size(base) > 0) slopes_[0].ra = evaluate::divide(slopes_[0].rr, base);
    }

    Own own = correctly(through, true);
    const Interval positive{std::max(a().computed.low, 0.0), std::max(a().computed.high, 0.0)};
    if (rounding_.digits == 24 || rounding_.machine == Machine::vulkan) {
        const Interval bits = positive.high > 0 ? log2(positive) : Interval{-infinity, 0};
        own = powers(evaluate::multiply(b().computed, bits), through);
    }
    if (rounding_.nearest && (b().computed == Interval{0, 0} || positive == Interval{1, 1}))
        own = exactly();
    own.absolute = outward(own.absolute + by_exponent);
    own.underflow = outward(own.underflow + by_exponent);
    Step result = combine(exact, through, own);
    result.value.computed.low = std::max(result.value.computed.low, 0.0);
    return result;
}

Step Rules::wave()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x = between(a());
    const bool tangent = op_ == TapeOp::tangent;
    if (op_ == TapeOp::sine) slopes_[0].aa = cosine(x);
    if (op_ == TapeOp::cosine) slopes_[0].aa = negate(sine(x));
    if (tangent && is_bounded(evaluate::tangent(x)))
        slopes_[0].aa = add({1, 1}, evaluate::square(evaluate::tangent(x)));
    slopes_[0].ar = evaluate::multiply(slopes_[0].aa, a().exact);
    if (least_size(exact) > 0) {
        slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
        slopes_[0].rr = evaluate::divide(slopes_[0].ar, exact);
    }
    Own own = correctly(through, true);
    if (rounding_.machine == Machine::vulkan) {
        double off = rounding_.digits == 24 ? 0x1p-11 : 0x1p-7;
        if (size(x) > 3.141592653589793) off = infinity;
        if (tangent) {
            const double least = least_size(cosine(x)) - off;
            const double most = size(through);
            off = least > 0 ? (off * (1 + most) / least) * (1 + 4 * rounding_.unit) +
                                  3 * rounding_.unit * most
                            : infinity;
        }
        own = {off * (1 + 0x1p-30) + rounding_.least_normal, infinity, 0, false};
        if (least_size(through) > 0) own.relative = outward(own.absolute / least_size(through));
    }
    return combine(exact, through, own);
}

Step Rules::arc()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval x = between(a());
    if (op_ == TapeOp::arc_tangent) {
        slopes_[0].aa = evaluate::divide({1, 1}, add({1, 1}, evaluate::square(x)));
    } else if (size(x) < 1) {
        slopes_[0].aa =
            evaluate::inverse_square_root(evaluate::subtract({1, 1}, evaluate::square(x)));
        if (op_ == TapeOp::arc_cosine) slopes_[0].aa = negate(slopes_[0].aa);
    }
    slopes_[0].ar = evaluate::multiply(slopes_[0].aa, a().exact);
    if (least_size(exact) > 0) {
        slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
        slopes_[0].rr = evaluate::divide(slopes_[0].ar, exact);
    }
    Own own = correctly(through, true);
    if (rounding_.machine == Machine::vulkan) {
        const double units = rounding_.digits == 24 ? 4096 : 5;
        double off = units * rounding_.unit * 3.15;
        // asin and acos: atan2 of x and sqrt(1 - x^2), whose argument two roundings move.
        if (op_ != TapeOp::arc_tangent)
            off += 2 * std::sqrt(2 * rounding_.unit) + rounding_.unit * 16;
        own = {off * (1 + 0x1p-30) + rounding_.least_normal, infinity, 0, false};
        if (least_size(through) > 0) own.relative = outward(own.absolute / least_size(through));
    }
    return combine(exact, through, own);
}

}  // namespace lobe::evaluate
