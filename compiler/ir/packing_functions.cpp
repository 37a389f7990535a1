// The functions that say what a packing does: from values to codes, to what a channel stores, and
// back.
//
// Every step between codes and stored values is exact in float: codes are whole numbers below 2^16,
// they are split and joined by powers of two, and a stored value is rounded to the nearest code
// before anything is made of it. What is left is decode, and there every value that has to survive
// is met without rounding. A division by the last code would be off by up to 2.5 units in the last
// place on a device, so there is none: code times a step, from an anchor on. The step is the least
// float that takes the outermost codes to the ends of the range or past them, where they are cut
// off: so the ends are exact too, whichever way a device rounds.
#include "ir/module.h"
#include "ir/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace lobe::ir {
namespace {

// ---- numbers of a shader

/// The largest float that is not above a double; the ends of the range of float are not met here.
double down(double x)
{
    const auto nearest = static_cast<float>(x);
    return nearest <= x ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::max());
}
double up(double x) { return -down(-x); }
bool is_float(double x) { return static_cast<double>(static_cast<float>(x)) == x; }
/// What a shader's compiler makes of a literal.
double as_read(double x) { return static_cast<float>(x); }

/// The shortest decimal that reads back: as a float where it is one. So a step has the nine digits
/// that a shader takes, and an end that was written as 0.9 stays 0.9.
std::string text(double value)
{
    if (value == std::floor(value) && std::abs(value) < 0x1p53) return fmt::format("{}", value);
    return is_float(value) ? fmt::format("{}", static_cast<float>(value))
                           : fmt::format("{}", value);
}

/// A factor, and the real number that its text stands for.
struct Factor {
    double value = 0;  ///< a float
    double real = 0;
};

Factor factor(double value)
{
    const double read = as_read(value);
    return {read, std::stod(text(read))};
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

// ---- graphs

/// Builds one function; arithmetic with 0 and 1 is left out.
class Writer {
public:
    Graph graph;
    Span span;

    ExprId number(double value) { return graph.literal(text(value), span); }
    ExprId add(ExprId x, double value)
    {
        if (value == 0) return x;
        return value < 0 ? graph.apply(Op::subtract, {x, number(-value)}, span)
                         : graph.apply(Op::add, {x, number(value)}, span);
    }
    /// value + x
    ExprId from(double value, ExprId x)
    {
        return value == 0 ? x : graph.apply(Op::add, {number(value), x}, span);
    }
    ExprId times(ExprId x, double value)
    {
        return value == 1 ? x : graph.apply(Op::multiply, {x, number(value)}, span);
    }
    ExprId multiply(ExprId x, ExprId y) { return graph.apply(Op::multiply, {x, y}, span); }
    ExprId apply(Op op, ExprId x) { return graph.apply(op, {x}, span); }
    ExprId at_least(ExprId x, double low)
    {
        return graph.apply(Op::maximum, {x, number(low)}, span);
    }
    ExprId at_most(ExprId x, double high)
    {
        return graph.apply(Op::minimum, {x, number(high)}, span);
    }
    ExprId clamp(ExprId x, const Range& range)
    {
        if (range == Range{0, 1}) return apply(Op::saturate, x);
        return graph.apply(Op::clamp, {x, number(range.low), number(range.high)}, span);
    }
    /// To the nearest whole number, halves up.
    ExprId rounded(ExprId x) { return apply(Op::floor, add(x, 0.5)); }
    ExprId named(ExprId x, std::string_view name)
    {
        graph.set_name(x, name);
        return x;
    }
};

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
            return up_to_last(write, write.rounded(write.times(root(write, above), pivot())));
        case Code::Kind::log2: {
            const ExprId log = write.apply(Op::log2, write.add(kept, 1 - low_));
            return up_to_last(write, write.rounded(write.times(log, 1 / log_step())));
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
        ExprId value = decoded(write, code);
        for (const Anchor& anchor : kept_) {
            if (std::ranges::find(exact_, anchor) != exact_.end()) continue;
            const ExprId here =
                write.graph.apply(Op::equal, {code, write.number(anchor.code)}, write.span);
            value = write.graph.apply(Op::select, {here, write.number(anchor.value), value},
                                      write.span);
        }
        if (parameter_.type == Type::boolean)
            return write.graph.apply(Op::less, {write.number(0.5), value}, write.span);
        return parameter_.quantity == Quantity::integer ? write.rounded(value) : value;
    }

private:
    double pivot() const { return code_.pivot == 0 ? last_ : code_.pivot; }
    double middle() const { return last_ / 2; }  ///< the code of 0 of a signed field
    double log_step() const
    {
        return code_.pivot == 0 ? std::log2(1 + size_) / last_ : 1 / pivot();
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
        return write.graph.apply(Op::guarded_power, {x, write.number(1.0 / code_.exponent)},
                                 write.span);
    }

    /// Sets `exact_`, those of the kept values that this meets.
    ExprId decoded(Writer& write, ExprId code) const
    {
        exact_.clear();
        switch (code_.kind) {
        case Code::Kind::linear: return straight(write, code);
        case Code::Kind::square_root: return squared(write, code);
        case Code::Kind::power: return raised(write, code);
        case Code::Kind::log2: return exponential(write, code);
        case Code::Kind::declared: return declared(write, code);
        }
        return code;
    }

    /// Where decode starts from: the default, or else the low end (for snorm, 0).
    Anchor start() const
    {
        if (!kept_.empty()) return kept_.front();
        return {0, low_};
    }

    ExprId straight(Writer& write, ExprId code) const
    {
        const Anchor anchor = start();
        const double step = field_.is_signed ? high_ / middle() : size_ / pivot();
        const auto distance = [anchor](double c) { return c - anchor.code; };
        const double top = field_.is_signed ? last_ : pivot();
        return stepped(write, anchor, step, write.add(code, -anchor.code), distance, top);
    }

    ExprId squared(Writer& write, ExprId code) const
    {
        const Anchor anchor = start();
        const double c0 = anchor.code;
        const auto distance = [c0](double c) { return (c - c0) * (c + c0); };
        const ExprId between = write.multiply(write.add(code, -c0), write.add(code, c0));
        return stepped(write, anchor, size_ / (last_ * last_), between, distance, last_);
    }

    /// anchor + distance * step, cut off at the ends. `top` is the code of the high end.
    template <class Distance>
    ExprId stepped(Writer& write, const Anchor& anchor, double step, ExprId distance,
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
        for (const Anchor& kept : kept_) {
            const bool cut_off = (kept.value == high_ && reaches_high(by)) ||
                                 (kept.value == low_ && reaches_low(by));
            if (kept == anchor || cut_off || meets(kept.code, kept.value)) exact_.push_back(kept);
        }
        ExprId value = write.from(anchor.value, write.times(distance, by.value));
        if (anchor.code != 0 && !meets(0, low_)) value = write.at_least(value, low_);
        if (top < last_ || (anchor.code != last_ && !meets(top, high_)))
            value = write.at_most(value, high_);
        return value;
    }

    /// low + (1 + (code - pivot) / pivot)^n: the base is 1 at the pivot, and 0 at code 0, whatever
    /// is rounded.
    ExprId raised(Writer& write, ExprId code) const
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
        value = write.from(low_, value);
        // Far more than the roundings of 32 factors.
        const double reached = low_ + std::pow(last_ / p, code_.exponent);
        const double margin = 0x1p-16 * (reached - low_);
        if (reached + margin > high_) value = write.at_most(value, high_);
        for (const Anchor& kept : kept_) {
            const double there = low_ + std::pow(kept.code / p, code_.exponent);
            if (kept.code == code_.pivot || kept.code == 0 ||
                (kept.value == high_ && there - margin >= high_))
                exact_.push_back(kept);
        }
        return value;
    }

    ExprId exponential(Writer& write, ExprId code) const
    {
        const ExprId power = write.apply(Op::exp2, write.times(code, log_step()));
        return write.clamp(write.add(power, low_ - 1), field_.range);
    }

    ExprId declared(Writer& write, ExprId code) const
    {
        const Factor by = covering(1 / last_, [this](const Factor& tried) {
            return down(last_ * tried.value) >= 1 && last_ * tried.real >= 1;
        });
        ExprId part = write.times(code, by.value);
        if (last_ > 1) part = write.at_most(part, 1);
        write.named(part, "part");
        const ExprId value = write.graph.call(code_.decode, Type::scalar, {&part, 1}, write.span);
        return write.clamp(value, field_.range);
    }

    const Field& field_;
    const Code& code_;
    double last_;
    double low_;
    double high_;
    double size_;
    const Parameter& parameter_;
    std::vector<Anchor> kept_;           ///< those that lie on a code, the default first
    mutable std::vector<Anchor> exact_;  ///< those that the arithmetic meets by itself
};

// ---- words

std::string number_text(double value) { return fmt::format("{}", value); }

std::string range_text(const Range& range)
{
    return fmt::format("[{}, {}]", number_text(range.low), number_text(range.high));
}

/// `d.b`, `bits 4..7 of d.b`, `bit 3 of d.b`
std::string slot_text(const Gbuffer& gbuffer, const Packing& packing, const Slot& slot)
{
    const Channel& channel = gbuffer.channels[slot.channel];
    const std::string name = gbuffer.name_of(channel);
    if (slot.low == 0 && slot.bits == channel_bits(packing, channel)) return name;
    if (slot.bits == 1) return fmt::format("bit {} of {}", slot.low, name);
    return fmt::format("bits {}..{} of {}", slot.low, slot.low + slot.bits - 1, name);
}

/// Both of them, most significant first: `d.r, bits 4..7 of d.g`.
std::string slots_text(const Gbuffer& gbuffer, const Packing& packing, const Field& field)
{
    std::string result;
    for (const Slot& slot : field.slots)
        result += (result.empty() ? "" : ", ") + slot_text(gbuffer, packing, slot);
    return result;
}

std::string codes_text(const Field& field)
{
    return fmt::format("{} codes over {}, {}", field.last_code() + 1, range_text(field.range),
                       describe(field.code, field.bits));
}

/// x - low, in a formula.
std::string above_low(const Field& field, std::string_view x)
{
    if (field.range.low == 0) return std::string{x};
    return field.range.low < 0 ? fmt::format("({} + {})", x, number_text(-field.range.low))
                               : fmt::format("({} - {})", x, number_text(field.range.low));
}

std::string plus_low(const Field& field, const std::string& rest)
{
    return field.range.low == 0 ? rest : fmt::format("{} + {}", number_text(field.range.low), rest);
}

std::string encode_formula(const Field& field)
{
    const Code& code = field.code;
    const int last = field.last_code();
    const int pivot = code.pivot == 0 ? last : code.pivot;
    const std::string size = number_text(field.range.high - field.range.low);
    const std::string above = above_low(field, "x");
    if (field.is_signed)
        return fmt::format("round({} + {} * x / {})", last / 2, last / 2,
                           number_text(field.range.high));
    switch (code.kind) {
    case Code::Kind::linear: return fmt::format("round({} * {} / {})", pivot, above, size);
    case Code::Kind::square_root:
        return fmt::format("round({} * sqrt({} / {}))", last, above, size);
    case Code::Kind::power:
        return fmt::format("round({} * {}^(1/{}))", pivot, above, code.exponent);
    case Code::Kind::log2:
        return code.pivot == 0 ? fmt::format("round({} * log2(1 + {}) / log2(1 + {}))", last,
                                             above_low(field, "x"), size)
                               : fmt::format("round({} * log2(1 + {}))", pivot, above);
    case Code::Kind::declared: return fmt::format("round({} * {}_encode(x))", last, code.name);
    }
    return {};
}

std::string decode_formula(const Field& field)
{
    const Code& code = field.code;
    const int last = field.last_code();
    const int pivot = code.pivot == 0 ? last : code.pivot;
    const double size = field.range.high - field.range.low;
    if (field.is_signed)
        return fmt::format("{} * (code - {}) / {}", number_text(field.range.high), last / 2,
                           last / 2);
    switch (code.kind) {
    case Code::Kind::linear:
        return plus_low(field, fmt::format("{} * code / {}", number_text(size), pivot));
    case Code::Kind::square_root:
        return plus_low(field, fmt::format("{} * (code / {})^2", number_text(size), last));
    case Code::Kind::power:
        return plus_low(field, fmt::format("(code / {})^{}", pivot, code.exponent));
    case Code::Kind::log2:
        return code.pivot == 0
                   ? plus_low(field, fmt::format("{}^(code / {}) - 1", number_text(1 + size), last))
                   : plus_low(field, fmt::format("2^(code / {}) - 1", pivot));
    case Code::Kind::declared: return fmt::format("{}_decode(code / {})", code.name, last);
    }
    return {};
}

// ---- functions

class Building {
public:
    Building(Module& module, Packing& packing, const Gbuffer& gbuffer)
        : module_(module), packing_(packing), gbuffer_(gbuffer)
    {
        packing_.channels.clear();
        packing_.parameters.clear();
    }

    void run()
    {
        for (Field& field : packing_.fields) {
            field.encode = encode(field);
            field.decode = decode(field);
        }
        for (std::size_t i = 0; i < gbuffer_.channels.size(); ++i)
            if (is_used(i)) packing_.channels.push_back({i, pack(i)});
        for (std::uint32_t i = 0; i < module_.parameters.size(); ++i)
            if (std::ranges::any_of(packing_.fields,
                                    [i](const Field& field) { return field.parameter == i; }))
                unpack(i);
    }

private:
    /// A name that no function has; several packings of a model differ by their gbuffers.
    std::string unique(const std::string& name) const
    {
        if (!module_.find(name)) return name;
        std::string other = fmt::format("{}_{}", name, packing_.gbuffer);
        for (int i = 2; module_.find(other); ++i)
            other = fmt::format("{}_{}_{}", name, packing_.gbuffer, i);
        return other;
    }

    Function start(const std::string& name, const Span& span, std::string doc) const
    {
        Function function;
        function.name = unique(name);
        function.kind = Function::Kind::storage;
        function.module = packing_.module;
        function.doc = std::move(doc);
        function.span = span;
        return function;
    }

    FunctionId enter(Function function, Writer write, ExprId result, Quantity quantity,
                     const Range& range)
    {
        function.graph = std::move(write.graph);
        function.result = result;
        function.quantity = quantity;
        function.range = range;
        function.declared_range = range;
        module_.functions.push_back(std::move(function));
        return FunctionId{module_.functions.size() - 1};
    }

    const Parameter& parameter_of(const Field& field) const
    {
        return module_.parameters[field.parameter];
    }
    /// Of one component.
    static Type component_type(const Parameter& parameter)
    {
        return parameter.type == Type::boolean ? Type::boolean : Type::scalar;
    }
    static Quantity component_quantity(const Parameter& parameter)
    {
        return components(parameter.type) == 1 ? parameter.quantity : Quantity::number;
    }

    FunctionId encode(const Field& field)
    {
        const Parameter& parameter = parameter_of(field);
        const std::string name = field_name(module_, field);
        Function function = start("encode_" + name, field.span,
                                  fmt::format("The code of {}: {}.", name, codes_text(field)));
        function.formula = encode_formula(field);
        const Type type = component_type(parameter);
        // Anything: what a material gives is not always in its range, and a code past the last one
        // would spill into the field beside it. The clamp is part of the code.
        constexpr double infinity = std::numeric_limits<double>::infinity();
        function.inputs = {{"x",
                            type,
                            component_quantity(parameter),
                            {-infinity, infinity},
                            Origin::argument,
                            0,
                            field.span}};
        Writer write{{}, field.span};
        const ExprId x = write.graph.input(0, type, field.span);
        const ExprId code = FieldCodes{module_, packing_, field}.encode(write, x);
        return enter(std::move(function), std::move(write), code, Quantity::integer,
                     {0, static_cast<double>(field.last_code())});
    }

    FunctionId decode(const Field& field)
    {
        const Parameter& parameter = parameter_of(field);
        const std::string name = field_name(module_, field);
        std::string where = slots_text(gbuffer_, packing_, field);
        if (where.starts_with('b')) where[0] = 'B';
        Function function = start("decode_" + name, field.span,
                                  fmt::format("{}: {}, {}.", where, name, codes_text(field)));
        function.formula = decode_formula(field);
        function.inputs = {{"code",
                            Type::scalar,
                            Quantity::integer,
                            {0, static_cast<double>(field.last_code())},
                            Origin::argument,
                            0,
                            field.span}};
        Writer write{{}, field.span};
        const ExprId code = write.graph.input(0, Type::scalar, field.span);
        const ExprId value = FieldCodes{module_, packing_, field}.decode(write, code);
        return enter(std::move(function), std::move(write), value, component_quantity(parameter),
                     field.range);
    }

    bool is_used(std::size_t channel) const
    {
        return std::ranges::any_of(packing_.fields, [channel](const Field& field) {
            return std::ranges::find(field.slots, channel, &Slot::channel) != field.slots.end();
        });
    }

    std::string channel_name(std::size_t channel) const
    {
        std::string name = gbuffer_.name_of(gbuffer_.channels[channel]);
        std::ranges::replace(name, '.', '_');
        return name;
    }

    double last_stored(std::size_t channel) const
    {
        return (1 << channel_bits(packing_, gbuffer_.channels[channel])) - 1;
    }

    FunctionId pack(std::size_t channel)
    {
        Function function = start("pack_" + channel_name(channel), packing_.span, {});
        Writer write{{}, packing_.span};

        std::vector<std::uint32_t> stored;
        for (const Field& field : packing_.fields)
            for (const Slot& slot : field.slots)
                if (slot.channel == channel) stored.push_back(field.parameter);
        std::ranges::sort(stored);
        stored.erase(std::unique(stored.begin(), stored.end()), stored.end());
        for (const std::uint32_t which : stored) {
            const Parameter& parameter = module_.parameters[which];
            function.inputs.push_back({parameter.name, parameter.type, parameter.quantity,
                                       parameter.range, Origin::parameter, which, parameter.span});
        }

        // From the most significant bits down.
        struct Part {
            int low;
            ExprId value;
            std::string doc;
        };
        std::vector<Part> parts;
        for (const Field& field : packing_.fields) {
            int below = field.bits;
            for (const Slot& slot : field.slots) {
                below -= slot.bits;
                if (slot.channel != channel) continue;
                write.span = field.span;
                const auto input = static_cast<std::uint32_t>(
                    std::ranges::find(stored, field.parameter) - stored.begin());
                const std::string name = field_name(module_, field);
                const ExprId code = code_of_input(write, field, input);
                write.named(code, name + "_code");
                parts.push_back({slot.low, part(write, field, code, below, slot.bits),
                                 part_doc(field, slot, name)});
            }
        }
        write.span = packing_.span;
        std::ranges::sort(parts, std::ranges::greater{}, &Part::low);
        std::optional<ExprId> sum;
        std::string doc;
        for (const Part& one : parts) {
            const ExprId shifted = write.times(one.value, std::ldexp(1.0, one.low));
            sum = sum ? write.graph.apply(Op::add, {*sum, shifted}, write.span) : shifted;
            doc += (doc.empty() ? "" : ", ") + one.doc;
        }
        const Channel& target = gbuffer_.channels[channel];
        function.doc =
            fmt::format("What {} stores{}: {}.", gbuffer_.name_of(target),
                        target.label.empty() ? "" : fmt::format(" ({})", target.label), doc);
        // Below the nearest float where that is above: nothing past 1 is stored.
        const ExprId value = write.times(*sum, down(1 / last_stored(channel)));
        return enter(std::move(function), std::move(write), value, Quantity::number, {0, 1});
    }

    std::string part_doc(const Field& field, const Slot& slot, const std::string& name) const
    {
        const Channel& channel = gbuffer_.channels[slot.channel];
        std::string doc = name;
        if (slot.bits != channel_bits(packing_, channel))
            doc += slot.bits == 1
                       ? fmt::format(" in bit {}", slot.low)
                       : fmt::format(" in bits {}..{}", slot.low, slot.low + slot.bits - 1);
        if (field.slots.size() > 1)
            doc += fmt::format(" ({} of its {} bits)", slot.bits, field.bits);
        return doc;
    }

    ExprId code_of_input(Writer& write, const Field& field, std::uint32_t input)
    {
        const Parameter& parameter = parameter_of(field);
        ExprId x = write.graph.input(input, parameter.type, field.span);
        if (components(parameter.type) > 1)
            x = write.graph.component(x, field.component, field.span);
        return write.graph.call(field.encode, Type::scalar, {&x, 1}, field.span);
    }

    /// Bits below .. below + bits - 1 of a field's code.
    static ExprId part(Writer& write, const Field& field, ExprId code, int below, int bits)
    {
        ExprId value = code;
        if (below > 0) value = write.apply(Op::floor, write.times(code, std::ldexp(1.0, -below)));
        return without_above(write, value, code, field.bits, below + bits, bits);
    }

    /// `value`, the bits of `code` from `end - bits` on, without those from `end` on.
    static ExprId without_above(Writer& write, ExprId value, ExprId code, int code_bits, int end,
                                int bits)
    {
        if (end == code_bits) return value;
        const ExprId above = write.apply(Op::floor, write.times(code, std::ldexp(1.0, -end)));
        return write.graph.apply(Op::subtract, {value, write.times(above, std::ldexp(1.0, bits))},
                                 write.span);
    }

    void unpack(std::uint32_t which)
    {
        const Parameter& parameter = module_.parameters[which];
        std::vector<const Field*> fields(static_cast<std::size_t>(components(parameter.type)));
        const Field* first = nullptr;
        for (const Field& field : packing_.fields) {
            if (field.parameter != which) continue;
            fields[static_cast<std::size_t>(field.component)] = &field;
            if (first == nullptr) first = &field;
        }
        Packing::UnpackedParameter result{which, {}, {}};
        for (std::size_t i = 0; i < packing_.channels.size(); ++i)
            for (const Field& field : packing_.fields)
                if (field.parameter == which &&
                    std::ranges::find(field.slots, packing_.channels[i].channel, &Slot::channel) !=
                        field.slots.end() &&
                    (result.channels.empty() || result.channels.back() != i))
                    result.channels.push_back(i);

        Function function = start("unpack_" + parameter.name, first->span, {});
        Writer write{{}, first->span};
        for (std::size_t i = 0; i < result.channels.size(); ++i)
            function.inputs.push_back({channel_name(packing_.channels[result.channels[i]].channel),
                                       Type::scalar,
                                       Quantity::number,
                                       {0, 1},
                                       Origin::argument,
                                       static_cast<std::uint32_t>(i),
                                       first->span});

        std::string doc;
        Range range = parameter.range;
        std::vector<ExprId> values;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            if (fields[i] == nullptr) {
                values.push_back(write.number(parameter.default_value[i]));
                continue;
            }
            const Field& field = *fields[i];
            doc += (doc.empty() ? "" : "; ") + slots_text(gbuffer_, packing_, field);
            write.span = field.span;
            const ExprId code = stored_code(write, field, result.channels);
            values.push_back(
                write.graph.call(field.decode, component_type(parameter), {&code, 1}, field.span));
        }
        write.span = first->span;
        ExprId value = values[0];
        if (values.size() > 1) value = write.graph.construct(parameter.type, values, write.span);
        function.doc = fmt::format("{} as it was stored: {}.", parameter.name, doc);
        result.unpack =
            enter(std::move(function), std::move(write), value, parameter.quantity, range);
        packing_.parameters.push_back(std::move(result));
    }

    /// The code of a field, out of what its channels read.
    ExprId stored_code(Writer& write, const Field& field, const std::vector<std::size_t>& channels)
    {
        std::optional<ExprId> code;
        int below = field.bits;
        for (const Slot& slot : field.slots) {
            below -= slot.bits;
            const auto input = static_cast<std::uint32_t>(
                std::ranges::find_if(
                    channels,
                    [&](std::size_t i) { return packing_.channels[i].channel == slot.channel; }) -
                channels.begin());
            const int bits = channel_bits(packing_, gbuffer_.channels[slot.channel]);
            const ExprId read = write.graph.input(input, Type::scalar, write.span);
            const ExprId whole = write.rounded(write.times(read, last_stored(slot.channel)));
            write.named(whole, channel_name(slot.channel) + "_code");
            ExprId value = whole;
            if (slot.low > 0)
                value = write.apply(Op::floor, write.times(whole, std::ldexp(1.0, -slot.low)));
            value = without_above(write, value, whole, bits, slot.low + slot.bits, slot.bits);
            value = write.times(value, std::ldexp(1.0, below));
            code = code ? write.graph.apply(Op::add, {*code, value}, write.span) : value;
        }
        return *code;
    }

    Module& module_;
    Packing& packing_;
    const Gbuffer& gbuffer_;
};

}  // namespace

void build_functions(Module& module, Packing& packing, const Gbuffer& gbuffer)
{
    Building{module, packing, gbuffer}.run();
}

}  // namespace lobe::ir
