// Every value that has to survive is met without rounding. A division by the last code would be off
// by up to 2.5 units in the last place on a device, so there is none: code times a step, from an
// anchor on. The step is the least float that takes the outermost codes to the ends of the range or
// past them, where they are cut off: so the ends are exact too, whichever way a device rounds.
#include "ir/field_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lobe::ir {
namespace {

// ---- numbers of a shader

double down(double x) { return float_below(x); }
double up(double x) { return -down(-x); }
bool is_float(double x) { return static_cast<double>(static_cast<float>(x)) == x; }
/// What a shader's compiler makes of a literal.
double as_read(double x) { return static_cast<float>(x); }

/// A factor, and the real number that its text stands for.
struct Factor {
    double value = 0;  ///< a float
    double real = 0;
};

Factor factor(double value)
{
    const double read = as_read(value);
    Graph graph;
    return {read, graph.literal_of(graph.literal(literal_text(read))).value};
}

/// The least factor from `wanted` on that `covers` accepts; `wanted` itself where none of the next
/// ones does. Steps of one unit first, so that no more is given away than must be.
template <class Covers>
Factor covering(double wanted, const Covers& covers)
{
    Factor tried = factor(wanted);
    for (int i = 0; i < 8; ++i) {
        if (covers(tried)) return tried;
        tried = factor(std::nextafter(static_cast<float>(tried.value),
                                      std::numeric_limits<float>::infinity()));
    }
    return factor(wanted);
}

// ---- expressions

/// Value to code and back, for one field.
class FieldCodes {
public:
    FieldCodes(const Module& module, const Packing& packing, const Field& field)
        : field_(field), code_(field.code), last_(field.last_code()), low_(field.range.low),
          high_(field.range.high), size_(high_ - low_),
          parameter_(module.parameters[field.parameter])
    {
        for (const double value : kept_values(module, packing, field))
            if (const auto code = code_of(field, value)) kept_.push_back({*code, value});
    }

    ExprId encode(Writer& write, ExprId x) const
    {
        if (parameter_.type == Type::boolean)
            x = write.graph.apply(Op::select, {x, write.number(1), write.number(0)}, write.span);
        const ExprId kept = write.clamp(x, field_.range);
        if (field_.is_signed)
            return write.apply(Op::floor,
                               write.add(write.times(kept, middle() / high_), middle() + 0.5));
        const ExprId above = write.add(kept, -low_);
        switch (code_.kind) {
        case Code::Kind::linear: return write.rounded(write.times(above, pivot() / size_));
        case Code::Kind::square_root: {
            const ExprId part = write.times(above, 1 / size_);
            return write.rounded(write.times(write.apply(Op::square_root, part), last_));
        }
        case Code::Kind::power:
            return up_to_last(
                write, write.rounded(
                           write.times(root(write, write.times(above, 1 / code_.unit)), pivot())));
        case Code::Kind::log2: {
            const ExprId log = write.apply(Op::log2, write.add(kept, 1 - low_));
            return up_to_last(write, write.rounded(write.times(log, 1 / log_step())));
        }
        case Code::Kind::halving: {
            const ExprId missing =
                write.times(write.below(code_.top, kept), 1 / (code_.top - low_));
            const ExprId log = write.apply(Op::log2, missing);
            return up_to_last(write, write.rounded(write.times(log, 1 / halving_step())));
        }
        case Code::Kind::declared: {
            const ExprId part =
                write.graph.call(code_.encode, Type::scalar, {&kept, 1}, write.span);
            return write.rounded(write.times(write.apply(Op::saturate, part), last_));
        }
        }
        return x;
    }

    ExprId decode(Writer& write, ExprId code) const
    {
        auto [value, exact] = decoded(write, code);
        for (const Anchor& anchor : kept_) {
            if (std::ranges::find(exact, anchor) != exact.end()) continue;
            const ExprId here =
                write.graph.apply(Op::equal, {code, write.number(anchor.code)}, write.span);
            value = write.graph.apply(Op::select, {here, write.number(anchor.value), value},
                                      write.span);
        }
        if (parameter_.type == Type::boolean)
            return write.graph.apply(Op::less, {write.number(0.5), value}, write.span);
        return parameter_.quantity == Quantity::integer ? whole(write, value) : value;
    }

private:
    double pivot() const { return code_.pivot == 0 ? last_ : code_.pivot; }
    double middle() const { return last_ / 2; }  ///< the code of 0 of a signed field
    /// As a float, so that no platform's logarithm shows in its digits.
    double log_step() const
    {
        return as_read(code_.pivot == 0 ? std::log2(1 + size_) / last_ : 1 / pivot());
    }

    /// Halvings a code, less than 0; as a float too.
    double halving_step() const
    {
        return as_read(std::log2((code_.top - code_.at_pivot) / (code_.top - low_)) / pivot());
    }

    ExprId up_to_last(Writer& write, ExprId code) const
    {
        // A quarter of a code is far more than any rounding.
        return position(field_, high_) < last_ + 0.25 ? code : write.at_most(code, last_);
    }

    /// x^(1/n): square roots, which are exact where they can be, for the powers of two.
    ExprId root(Writer& write, ExprId x) const
    {
        const auto exponent = static_cast<unsigned>(code_.exponent);
        if (std::has_single_bit(exponent)) {
            for (unsigned n = exponent; n > 1; n /= 2) x = write.apply(Op::square_root, x);
            return x;
        }
        return write.graph.apply(Op::power, {x, write.number(1.0 / code_.exponent)}, write.span);
    }

    /// The nearest whole number that is in the range.
    ExprId whole(Writer& write, ExprId x) const
    {
        x = write.rounded(x);
        if (high_ != std::floor(high_)) x = write.at_most(x, std::floor(high_));
        if (low_ != std::ceil(low_)) x = write.at_least(x, std::ceil(low_));
        return x;
    }

    /// A value, and which of the kept values its arithmetic meets by itself.
    struct Decoded {
        ExprId value;
        std::vector<Anchor> exact;
    };

    Decoded decoded(Writer& write, ExprId code) const
    {
        switch (code_.kind) {
        case Code::Kind::linear: return straight(write, code);
        case Code::Kind::square_root: return squared(write, code);
        case Code::Kind::power: return raised(write, code);
        case Code::Kind::log2: return exponential(write, code);
        case Code::Kind::halving: return halved(write, code);
        case Code::Kind::declared: return declared(write, code);
        }
        return {code, {}};
    }

    /// Where decode starts from: the default, or else the low end (for snorm, 0).
    Anchor start() const
    {
        if (!kept_.empty()) return kept_.front();
        return {0, low_};
    }

    Decoded straight(Writer& write, ExprId code) const
    {
        const Anchor anchor = start();
        const double step = field_.is_signed ? high_ / middle() : size_ / pivot();
        const auto distance = [anchor](double c) { return c - anchor.code; };
        const double top = field_.is_signed ? last_ : pivot();
        return stepped(write, anchor, step, write.add(code, -anchor.code), distance, top);
    }

    /// From the low end: its codes are the closest ones, and next to a greater anchor they would be
    /// lost in the rounding of the sum.
    Decoded squared(Writer& write, ExprId code) const
    {
        const auto distance = [](double c) { return c * c; };
        return stepped(write, {0, low_}, size_ / (last_ * last_), write.multiply(code, code),
                       distance, last_);
    }

    /// anchor + distance * step, cut off at the ends. `top` is the code of the high end.
    template <class Distance>
    Decoded stepped(Writer& write, const Anchor& anchor, double step, ExprId distance,
                    const Distance& distance_of, double top) const
    {
        const double start = as_read(anchor.value);
        const double to_high = distance_of(top);
        const double to_low = distance_of(0);
        const auto reaches_high = [&](const Factor& by) {
            return down(down(down(to_high) * by.value) + start) >= as_read(high_) &&
                   to_high * by.real + anchor.value >= high_;
        };
        const auto reaches_low = [&](const Factor& by) {
            return up(up(up(to_low) * by.value) + start) <= as_read(low_) &&
                   to_low * by.real + anchor.value <= low_;
        };
        const Factor by = covering(
            step, [&](const Factor& tried) { return reaches_high(tried) && reaches_low(tried); });
        // No rounding takes place on the way to this value.
        const auto meets = [&](double code, double value) {
            const double product = distance_of(code) * by.value;
            return is_float(distance_of(code)) && is_float(product) && is_float(product + start) &&
                   product + start == as_read(value) && by.real == by.value;
        };
        Decoded result;
        for (const Anchor& kept : kept_) {
            const bool cut_off = (kept.value == high_ && reaches_high(by)) ||
                                 (kept.value == low_ && reaches_low(by));
            if (kept == anchor || cut_off || meets(kept.code, kept.value))
                result.exact.push_back(kept);
        }
        result.value = write.from(anchor.value, write.times(distance, by.value));
        if (anchor.code != 0 && !meets(0, low_)) result.value = write.at_least(result.value, low_);
        // A signed field has a code past the last one, which nothing is stored as.
        const double greatest = (1 << field_.bits) - 1;
        if (top < greatest || (anchor.code != last_ && !meets(top, high_)))
            result.value = write.at_most(result.value, high_);
        return result;
    }

    /// low + unit (1 + (code - pivot) / pivot)^n: the base is 1 at the pivot, and 0 at code 0,
    /// whatever is rounded.
    Decoded raised(Writer& write, ExprId code) const
    {
        const double p = pivot();
        const Factor by = covering(1 / p, [p](const Factor& tried) {
            return down(p * tried.value) >= 1 && p * tried.real >= 1;
        });
        ExprId base = write.from(1, write.times(write.add(code, -p), by.value));
        if (p * by.value != 1 || p * by.real != 1) base = write.at_least(base, 0);
        write.named(base, "base");
        ExprId value = base;
        if (code_.exponent > 1)
            value = write.graph.apply(Op::power, {base, write.number(code_.exponent)}, write.span);
        value = write.from(low_, write.times(value, code_.unit));
        // Far more than the roundings of 32 factors.
        const double reached = low_ + code_.unit * std::pow(last_ / p, code_.exponent);
        const double margin = 0x1p-16 * (reached - low_);
        if (reached + margin > high_) value = write.at_most(value, high_);
        Decoded result{value, {}};
        const bool sum_is_exact =
            low_ == 0 || (as_read(low_) + as_read(code_.unit) == as_read(low_ + code_.unit) &&
                          as_read(code_.unit) == code_.unit);
        for (const Anchor& kept : kept_) {
            const double there = low_ + code_.unit * std::pow(kept.code / p, code_.exponent);
            if ((kept.code == code_.pivot && sum_is_exact) || kept.code == 0 ||
                (kept.value == high_ && there - margin >= high_))
                result.exact.push_back(kept);
        }
        return result;
    }

    Decoded exponential(Writer& write, ExprId code) const
    {
        const ExprId power = write.apply(Op::exp2, write.times(code, log_step()));
        return {write.clamp(write.add(power, low_ - 1), field_.range), {}};
    }

    Decoded halved(Writer& write, ExprId code) const
    {
        const ExprId part = write.apply(Op::exp2, write.times(code, halving_step()));
        const ExprId missing = write.times(part, code_.top - low_);
        return {write.clamp(write.below(code_.top, missing), field_.range), {}};
    }

    Decoded declared(Writer& write, ExprId code) const
    {
        const Factor by = covering(1 / last_, [this](const Factor& tried) {
            return down(last_ * tried.value) >= 1 && last_ * tried.real >= 1;
        });
        ExprId part = write.times(code, by.value);
        if (last_ > 1) part = write.at_most(part, 1);
        write.named(part, "part");
        const ExprId value = write.graph.call(code_.decode, Type::scalar, {&part, 1}, write.span);
        return {write.clamp(value, field_.range), {}};
    }

    const Field& field_;
    const Code& code_;
    double last_;
    double low_;
    double high_;
    double size_;
    const Parameter& parameter_;
    std::vector<Anchor> kept_;  ///< those that lie on a code, the default first
};

}  // namespace

double float_below(double x)
{
    // The ends of the range of float are not met here.
    const auto nearest = static_cast<float>(x);
    return nearest <= x ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::max());
}

std::string literal_text(double value)
{
    const auto nearest = static_cast<float>(value);
    const bool whole = value == std::floor(value) && std::abs(value) < 0x1p53;
    return !whole && nearest == value ? fmt::format("{}", nearest) : fmt::format("{}", value);
}

ExprId encode(Writer& write, const Module& module, const Packing& packing, const Field& field,
              ExprId x)
{
    return FieldCodes{module, packing, field}.encode(write, x);
}

ExprId decode(Writer& write, const Module& module, const Packing& packing, const Field& field,
              ExprId code)
{
    return FieldCodes{module, packing, field}.decode(write, code);
}

}  // namespace lobe::ir
