// The functions that say what a packing does: from values to codes, to what a channel stores, and
// back.
//
// Every step between codes and stored values is exact in float: codes are whole numbers below 2^16,
// they are split and joined by powers of two, and a stored value is rounded to the nearest code
// before anything is made of it. What is left is the arithmetic of codes, in field_functions.h.
#include "ir/field_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::ir {
namespace {

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
        const ExprId code = ir::encode(write, module_, packing_, field, x);
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
        // What the bits can hold: the code past the last one of a signed field as well.
        function.inputs = {{"code",
                            Type::scalar,
                            Quantity::integer,
                            {0, static_cast<double>((1 << field.bits) - 1)},
                            Origin::argument,
                            0,
                            field.span}};
        Writer write{{}, field.span};
        const ExprId code = write.graph.input(0, Type::scalar, field.span);
        const ExprId value = ir::decode(write, module_, packing_, field, code);
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
        const ExprId value = write.times(*sum, float_below(1 / last_stored(channel)));
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
