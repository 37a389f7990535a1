// Sums, products, choices and what is built of them.
#include "evaluate/rounding_rules.h"

namespace lobe::evaluate {
namespace {

constexpr Interval unit_range{0, 1};

double spacing(const Rounding& rounding, double x)
{
    const double least = rounding.flushes ? rounding.least_normal : rounding.least;
    return x <= rounding.least_normal ? std::min(least, rounding.least)
                                      : std::ldexp(1.0, std::ilogb(x) + 1 - rounding.digits);
}

/// Both terms are multiples of the spacing at the smaller one, and so is their sum: where it is
/// small enough it is a number of the format ([Sterbenz74] is the case of a difference of numbers
/// within a factor of two).
bool is_exact_sum(const Rounding& rounding, Interval a, Interval b, Interval through)
{
    if (a == Interval{0, 0} || b == Interval{0, 0}) return true;
    const double least = std::min(least_size(a), least_size(b));
    if (least < rounding.least_normal) return false;
    const double grid = spacing(rounding, least);
    if (size(through) > std::ldexp(grid, rounding.digits)) return false;
    // A difference may be denormal, and a device may flush it.
    return !rounding.flushes || grid >= rounding.least_normal ||
           least_size(through) >= rounding.least_normal;
}

bool is_power_of_two(Interval x)
{
    int exponent = 0;
    return x.low == x.high && x.low != 0 && std::abs(std::frexp(x.low, &exponent)) == 0.5;
}

/// What an operand is, exactly or as computed: slopes over both are derivatives, too.
Interval either(const Rounded& x) { return hull(x.exact, x.computed); }

/// a / (a + b), the share of a in a sum: 1 / (1 + b / a).
Interval share(Interval a, Interval b, Interval total)
{
    if ((a.low >= 0 && b.low >= 0) || (a.high <= 0 && b.high <= 0)) {
        if (a == Interval{0, 0}) return {0, 0};
        if (b == Interval{0, 0}) return {1, 1};
        Interval result = unit_range;
        if (least_size(a) > 0)
            result = divide({1, 1}, add({1, 1}, divide(absolute(b), absolute(a))));
        else if (least_size(b) > 0)
            result =
                subtract({1, 1}, divide({1, 1}, add({1, 1}, divide(absolute(a), absolute(b)))));
        return common(result, unit_range);
    }
    if (least_size(total) == 0) return everything;
    Interval result = divide(a, total);
    if (least_size(b) > 0 && is_bounded(result))
        result = common(result, subtract({1, 1}, divide(b, total)));
    return result;
}

/// slope * exact operand, slope / exact result, and both; where the result's range allows it.
void fill(Slope& slope, Interval operand, Interval result)
{
    slope.ar = multiply(slope.aa, operand);
    if (least_size(result) > 0) {
        slope.ra = divide(slope.aa, result);
        slope.rr = multiply(slope.ra, operand);
    }
}

}  // namespace

Step Rules::sum(double sign)
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval second = sign < 0 ? negate(b().exact) : b().exact;
    slopes_[0].aa = {1, 1};
    slopes_[1].aa = {sign, sign};
    fill(slopes_[0], a().exact, exact);
    fill(slopes_[1], b().exact, exact);
    slopes_[0].rr = share(a().exact, second, exact);
    slopes_[1].rr = share(second, a().exact, exact);
    // Multiples of the least denormal: a denormal sum is exact, unless flushed.
    const Own own = is_exact_sum(rounding_, a().computed, b().computed, through)
                        ? exactly()
                        : correctly(through, false);
    Step result = combine(exact, through, own);

    // The shares add up to one, so of two relative errors the result has a mean.
    if (slopes_[0].rr.low >= 0 && slopes_[1].rr.low >= 0) {
        const Interval weight = slopes_[0].rr;
        const double ra = a().relative;
        const double rb = b().relative;
        if (ra < infinity && rb < infinity) {
            const double mean = outward(ra >= rb ? rb + weight.high * (ra - rb)
                                                 : ra + slopes_[1].rr.high * (rb - ra));
            const double relative = outward(mean + own.relative * (1 + mean));
            if (relative < result.value.relative) {
                result.value.relative = relative;
                result.value.underflow =
                    outward((a().underflow + b().underflow) * (1 + own.relative) + own.underflow);
                result.value.absolute =
                    std::min(result.value.absolute,
                             outward(relative * size(exact) + result.value.underflow));
            }
        }
    }
    // c - x, with x a number of the format: 0, or no closer to it than the next number.
    for (const Rounded* x : {&a(), &b()})
        if (x->computed.low == x->computed.high && x->computed.low != 0 && !rounding_.flushes) {
            const double next =
                std::ldexp(1.0, std::ilogb(next_down(size(x->computed))) + 1 - rounding_.digits);
            result.value.smallest = std::max(result.value.smallest, next);
        }
    return result;
}

/// Sums of three or four terms. The kernels add from the left, a device in any order.
Step Rules::long_sum()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    double all = 0;
    double absolute = 0;
    Interval partial = a().computed;
    for (std::size_t i = 0; i < in_.size(); ++i) {
        slopes_[i].aa = {1, 1};
        fill(slopes_[i], in_[i].exact, exact);
        all += size(in_[i].computed);
        if (i == 0) continue;
        partial = evaluate::add(partial, in_[i].computed);
        absolute += rounding_error(rounding_, size(partial)) * (1 + 4 * rounding_.unit);
    }
    if (!rounding_.nearest)
        absolute = static_cast<double>(in_.size() - 1) *
                   rounding_error(rounding_, all * (1 + 4 * rounding_.unit));
    if (rounding_.flushes) absolute += 4 * rounding_.least_normal;
    Own own{outward(absolute), infinity, 0, false};
    const bool positive = std::ranges::all_of(
        in_, [](const Rounded& x) { return x.exact.low >= 0 && x.computed.low >= 0; });
    if (positive) {
        own.relative = outward(static_cast<double>(in_.size() - 1) * rounding_.unit *
                               (1 + 4 * rounding_.unit));
        own.underflow = rounding_.flushes ? 4 * rounding_.least_normal : 0;
        for (std::size_t i = 0; i < in_.size(); ++i)
            slopes_[i].rr = common(slopes_[i].rr, unit_range);
    } else if (least_size(through) > 0) {
        own.relative = outward(absolute / least_size(through));
    }
    Step result = combine(exact, through, own);
    if (positive) {
        // The shares add up to one.
        double mean = 0;
        double underflow = own.underflow;
        for (const Rounded& x : in_) {
            mean = std::max(mean, x.relative);
            underflow += x.underflow * (1 + own.relative);
        }
        const double relative = outward(mean + own.relative * (1 + mean));
        if (relative < result.value.relative && relative < 0x1p-2) {
            result.value.relative = relative;
            result.value.underflow = outward(underflow);
        }
        result.value.computed.low = std::max(result.value.computed.low, 0.0);
    }
    return result;
}

Step Rules::multiply()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    // a' b' - a b = (a' - a) b + a' (b' - b)
    slopes_[0].aa = b().exact;
    slopes_[1].aa = either(a());
    slopes_[0].ar = exact;
    slopes_[1].ar = evaluate::multiply(slopes_[1].aa, b().exact);
    slopes_[0].rr = {1, 1};
    slopes_[1].rr = a().relative < infinity ? around(1, a().relative) : everything;
    if (least_size(a().exact) > 0) slopes_[0].ra = evaluate::divide({1, 1}, a().exact);
    if (least_size(exact) > 0) slopes_[1].ra = evaluate::divide(slopes_[1].aa, exact);
    // Underflow is carried on the other operand with its relative error.
    if (a().underflow > 0 && size(slopes_[0].aa) < infinity)
        slopes_[0].aa = hull(slopes_[0].aa, between(b()));
    if (b().underflow > 0) slopes_[1].aa = hull(slopes_[1].aa, between(a()));

    const double smallest = a().smallest * b().smallest * (1 - 0x1p-40);
    const bool underflows = smallest < rounding_.least_normal;
    Own own = correctly(through, underflows);
    const bool scales = is_power_of_two(a().computed) || is_power_of_two(b().computed) ||
                        a().computed == Interval{0, 0} || b().computed == Interval{0, 0};
    if (scales) {
        own.absolute = own.relative = 0;
        const double factor = size(is_power_of_two(a().computed) ? a().computed : b().computed);
        if (!underflows || (factor >= 1 && !rounding_.flushes)) own.underflow = 0;
        own.absolute = own.underflow;
    }
    if (!underflows && !rounding_.flushes) own.underflow = 0;
    Step result = combine(exact, through, own);
    if (!underflows && !rounding_.flushes)
        result.value.smallest =
            std::max(result.value.smallest, outward(smallest) * (1 - 4 * rounding_.unit));
    return result;
}

Step Rules::divide()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    // a'/b' - a/b = (a' - a) / b' - (a / b) (b' - b) / b'
    const Interval divisors = either(b());
    slopes_[0].aa = least_size(divisors) > 0 ? evaluate::divide({1, 1}, divisors) : everything;
    slopes_[1].aa =
        least_size(divisors) > 0 ? negate(evaluate::divide(exact, divisors)) : everything;
    const double divisor = fold(b());
    if (b().underflow > 0) {
        folded_[1] = true;
        extra_relative_ = divisor;
    }
    const double rb = b().relative + divisor;
    if (rb < 0.5) {
        const Interval one_off = evaluate::divide({1, 1}, around(1, outward(rb)));
        slopes_[0].rr = one_off;
        slopes_[1].rr = negate(one_off);
        slopes_[0].ar = evaluate::multiply(exact, one_off);
        slopes_[1].ar = negate(slopes_[0].ar);
        extra_relative_ = outward(divisor * one_off.high);
        // Underflow of the dividend, by a divisor that is no smaller than it is known to be.
        double least = least_size(b().exact);
        if (extra_jump_ > 0) least = std::max(least, b().underflow * 0x1p40);
        if (least > 0 && b().jump == 0)
            slopes_[0].aa = common(slopes_[0].aa, around(0, outward(one_off.high / least)));
    }
    if (least_size(exact) > 0) {
        slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
        if (least_size(divisors) > 0) slopes_[1].ra = negate(evaluate::divide({1, 1}, divisors));
    }
    Own own = correctly(through, true);
    if (rounding_.machine == Machine::vulkan)
        own = within(through, 2.5 * rounding_.unit * (1 + 0x1p-8), infinity, true);
    else if (is_power_of_two(b().computed) && least_size(through) >= rounding_.least_normal)
        own = exactly();
    if (a().computed == Interval{0, 0}) own = exactly();
    return combine(exact, through, own);
}

Step Rules::square()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    // a'^2 - a^2 = (a' + a) (a' - a)
    slopes_[0].aa = add(a().exact, either(a()));
    if (a().underflow > 0)
        slopes_[0].aa = evaluate::multiply({2, 2}, hull(slopes_[0].aa, between(a())));
    const double r = a().relative;
    if (r < 1) {
        slopes_[0].rr = around(2, r);
        slopes_[0].ar = evaluate::multiply(exact, slopes_[0].rr);
    }
    if (least_size(exact) > 0) slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
    const double smallest = a().smallest * a().smallest * (1 - 0x1p-40);
    const bool underflows = smallest < rounding_.least_normal;
    Own own = correctly(through, underflows);
    if (!underflows && !rounding_.flushes) own.underflow = 0;
    if (is_power_of_two(absolute(a().computed)) && least_size(through) >= rounding_.least_normal)
        own = exactly();
    Step result = combine(exact, through, own);
    result.value.computed.low = std::max(result.value.computed.low, 0.0);
    if (!underflows && !rounding_.flushes)
        result.value.smallest =
            std::max(result.value.smallest, smallest * (1 - 4 * rounding_.unit));
    return result;
}

/// Minimum or maximum: an error of either operand, never of both together.
Step Rules::choose_extreme()
{
    const bool least = op_ == TapeOp::minimum;
    const Interval x = between(a());
    const Interval y = between(b());
    const bool first = least ? x.high <= y.low : x.low >= y.high;
    const bool second = least ? y.high <= x.low : y.low >= x.high;
    Slope none{{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    const auto part = [&](const Rounded& operand, bool all) {
        const Interval weight = all ? Interval{1, 1} : unit_range;
        return Slope{weight, evaluate::multiply(weight, operand.exact), everything, weight};
    };
    slopes_[0] = second && !first ? none : part(a(), first);
    slopes_[1] = first ? none : part(b(), second);
    Step result = combine(of_exact(), of_computed(), exactly(), true);
    result.value.smallest = std::min(a().smallest, b().smallest);
    return result;
}

Step Rules::select()
{
    const Rounded& condition = a();
    const Rounded& yes = b();
    const Rounded& no = c();
    slopes_[0] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    const auto is = [](Interval x, double value) { return x.low == value && x.high == value; };
    const bool always = is(condition.exact, 1) && is(condition.computed, 1);
    const bool never = is(condition.exact, 0) && is(condition.computed, 0);
    Slope none{{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    const auto part = [&](const Rounded& operand, bool all) {
        const Interval weight = all ? Interval{1, 1} : unit_range;
        return Slope{weight, evaluate::multiply(weight, operand.exact), everything, weight};
    };
    slopes_[1] = never ? none : part(yes, always);
    slopes_[2] = always ? none : part(no, never);
    // Slopes of 0 keep an infinite error of the arm that is not taken out.
    Step result = combine(of_exact(), of_computed(), exactly(), true);
    Rounded& value = result.value;
    if (!always && !never) {
        value.jump = std::max(yes.jump, no.jump);
        if (condition.jump > 0) {
            const auto apart = [](Interval computed, Interval exact) {
                if (!is_bounded(computed) || !is_bounded(exact)) return infinity;
                return std::max(
                    {add_up(computed.high, -exact.low), add_up(exact.high, -computed.low), 0.0});
            };
            value.jump = outward(std::max(
                {value.jump, apart(yes.computed, no.exact), apart(no.computed, yes.exact)}));
        }
        value.computed = of_computed();
        value.smallest = std::min(yes.smallest, no.smallest);
    } else {
        value.smallest = always ? yes.smallest : no.smallest;
    }
    return result;
}

/// a + (b - a) t; a device may also compute a (1 - t) + b t.
Step Rules::lerp()
{
    const Interval exact = of_exact();
    const Interval through = of_computed();
    const Interval from = a().computed;
    const Interval to = b().computed;
    const Interval t = c().computed;
    // (1 - t') (a' - a) + t' (b' - b) + (b - a) (t' - t)
    slopes_[0].aa = evaluate::subtract({1, 1}, between(c()));
    slopes_[1].aa = between(c());
    slopes_[2].aa = c().underflow > 0 ? evaluate::subtract(between(b()), between(a()))
                                      : evaluate::subtract(b().exact, a().exact);
    const bool inside = c().exact.low >= 0 && c().exact.high <= 1 && t.low >= 0 && t.high <= 1;
    for (std::size_t i = 0; i < 3; ++i) fill(slopes_[i], in_[i].exact, exact);
    if (inside && a().exact.low >= 0 && b().exact.low >= 0 && c().absolute == 0) {
        // Shares of the result that add up to one.
        const Interval one_minus = evaluate::subtract({1, 1}, c().exact);
        const Interval left = share(evaluate::multiply(a().exact, one_minus),
                                    evaluate::multiply(b().exact, c().exact), exact);
        slopes_[0].rr = common(slopes_[0].rr, left);
        slopes_[1].rr = common(slopes_[1].rr, evaluate::subtract({1, 1}, left));
    }
    if (least_size(exact) > 0 && a().exact.low >= 0)
        // (b - a) t / v = 1 - a / v
        slopes_[2].rr =
            common(slopes_[2].rr, evaluate::subtract({1, 1}, evaluate::divide(a().exact, exact)));

    const double gap = size(evaluate::subtract(to, from));
    const double weight = size(t);
    const double moved = times(gap, weight) * (1 + 2 * rounding_.unit);
    Own own{0, infinity, 0, false};
    own.absolute = times(rounding_error(rounding_, gap), weight) +
                   rounding_error(rounding_, moved) +
                   rounding_error(rounding_, size(through) + 4 * rounding_.unit * moved);
    if (!rounding_.nearest) {
        const double kept =
            size(evaluate::subtract({1, 1}, t)) * size(from) * (1 + 4 * rounding_.unit);
        const double other =
            rounding_.unit * (2 * kept + size(to) * weight) * (1 + 8 * rounding_.unit) +
            rounding_.unit * (size(through) + 4 * rounding_.unit * (kept + size(to) * weight));
        own.absolute = std::max(own.absolute, other);
    }
    double small = rounding_.least;
    if (rounding_.flushes) small = rounding_.least_normal * (4 + weight + size(slopes_[0].aa));
    own.absolute = outward(own.absolute + small);
    const double least = least_size(through);
    if (least > 0) own.relative = outward(own.absolute / least);
    if (inside && from.low >= 0 && to.low >= from.high) {
        // |b - a| t is part of the result.
        own.relative =
            std::min(own.relative, outward(4 * rounding_.unit * (1 + 8 * rounding_.unit)));
        own.underflow = outward(small);
    }
    if ((from == to && from.low == from.high) || t == Interval{0, 0})
        own = rounding_.flushes ? own : exactly();
    if (rounding_.nearest && t == Interval{1, 1}) own = exactly();
    return combine(exact, through, own);
}

/// t^2 (3 - 2 t) for t in [0, 1].
Step Rules::hermite()
{
    const Interval t = common(between(a()), unit_range);
    const auto polynomial = [](Interval x) {
        const Interval clamped = common(x, unit_range);
        return evaluate::smoothstep({0, 0}, {1, 1}, clamped);
    };
    const Interval exact = polynomial(a().exact);
    const Interval through = polynomial(a().computed);
    // 6 t (1 - t), and 6 t^2 (1 - t), which is 8/9 at 2/3.
    const Interval rest = evaluate::subtract({1, 1}, t);
    slopes_[0].aa = common(evaluate::multiply({6, 6}, evaluate::multiply(t, rest)), {0, 1.5});
    slopes_[0].ar = evaluate::multiply(slopes_[0].aa, t);
    if (a().relative < 0.25)
        slopes_[0].ar =
            common(slopes_[0].ar, {0, outward(0x1.c71c71c71c72p-1 * (1 + 2 * a().relative))});
    if (least_size(exact) > 0) slopes_[0].ra = evaluate::divide(slopes_[0].aa, exact);
    // 6 (1 - t) / (3 - 2 t)
    if (a().relative < 0.25)
        slopes_[0].rr = evaluate::multiply(
            evaluate::divide(evaluate::multiply({6, 6}, rest),
                             evaluate::subtract({3, 3}, evaluate::multiply({2, 2}, t))),
            around(1, 4 * a().relative));
    const double u = rounding_.unit;
    Own own{0, outward(3 * u * (1 + 2 * u)), 0, false};
    if (rounding_.machine == Machine::vulkan) own.relative = 5 * u;  // as acceptance.h allows
    const Interval computed = common(a().computed, unit_range);
    const double least = rounding_.flushes ? rounding_.least_normal : rounding_.least;
    if (computed.low * computed.low < rounding_.least_normal) own.underflow = 8 * least;
    const double line = 3 - 2 * computed.low;
    own.absolute =
        outward(rounding_error(rounding_, computed.high * computed.high) * line +
                rounding_error(rounding_, line) * computed.high * computed.high * (1 + u) +
                rounding_error(rounding_, through.high * (1 + 4 * u)) + own.underflow);
    if (rounding_.machine == Machine::vulkan)
        own.absolute = outward(own.relative * through.high + own.underflow);
    if (through == Interval{0, 0} || (through == Interval{1, 1} && rounding_.nearest))
        own = exactly();
    return combine(exact, through, own);
}

}  // namespace lobe::evaluate
