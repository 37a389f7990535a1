// What codes mean, as numbers; their functions are in packing_functions.cpp.
#include "ir/packing.h"

#include "ir/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lobe::ir {

std::string describe(const Code& code, int bits)
{
    const auto pivot = [&] { return fmt::format("{}/{}", code.pivot, (1 << bits) - 1); };
    switch (code.kind) {
    case Code::Kind::linear: return code.pivot == 0 ? "linear" : fmt::format("linear({})", pivot());
    case Code::Kind::square_root: return "sqrt";
    case Code::Kind::power: return fmt::format("power({}, {})", code.exponent, pivot());
    case Code::Kind::log2: return code.pivot == 0 ? "log2" : fmt::format("log2({})", pivot());
    case Code::Kind::halving: return fmt::format("halving({})", pivot());
    case Code::Kind::declared: return code.name;
    }
    return {};
}

double power_unit(const Parameter& parameter, int component, const Range& range)
{
    const double value = parameter.default_value[static_cast<std::size_t>(component)];
    return value > range.low && value <= range.high ? value - range.low : 1;
}

std::optional<Code> halving(const Parameter& parameter, int component, const Range& range,
                            int pivot)
{
    Code code;
    code.kind = Code::Kind::halving;
    code.name = "halving";
    code.pivot = pivot;
    code.top = parameter.range.high;
    code.at_pivot = parameter.default_value[static_cast<std::size_t>(component)];
    if (!std::isfinite(code.top)) return std::nullopt;
    if (range.high >= code.top || code.at_pivot <= range.low || code.at_pivot > range.high)
        return std::nullopt;
    return code;
}

std::string field_name(const Module& module, const Field& field)
{
    const Parameter& parameter = module.parameters[field.parameter];
    if (components(parameter.type) == 1) return parameter.name;
    constexpr std::string_view suffixes = "rgba";
    return fmt::format("{}_{}", parameter.name,
                       suffixes[static_cast<std::size_t>(field.component)]);
}

double position(const Field& field, double value)
{
    const Code& code = field.code;
    const double last = field.last_code();
    const double pivot = code.pivot == 0 ? last : code.pivot;
    const double size = field.range.high - field.range.low;
    const double above = value - field.range.low;
    if (field.is_signed) return last / 2 * (1 + value / field.range.high);
    switch (code.kind) {
    case Code::Kind::linear: return pivot * above / size;
    case Code::Kind::square_root: return last * std::sqrt(above / size);
    case Code::Kind::power: return pivot * std::pow(above / code.unit, 1.0 / code.exponent);
    case Code::Kind::log2:
        return pivot * std::log2(1 + above) / (code.pivot == 0 ? std::log2(1 + size) : 1);
    case Code::Kind::halving: {
        const auto halvings = [&](double x) {
            return std::log2((code.top - x) / (code.top - field.range.low));
        };
        return pivot * halvings(value) / halvings(code.at_pivot);
    }
    case Code::Kind::declared: break;
    }
    assert(false);
    return 0;
}

std::optional<int> code_of(const Field& field, double value)
{
    if (field.code.kind == Code::Kind::declared) {
        const auto anchor = std::ranges::find(field.anchors, value, &Anchor::value);
        if (anchor == field.anchors.end()) return std::nullopt;
        return anchor->code;
    }
    if (value < field.range.low || value > field.range.high) return std::nullopt;
    const double place = position(field, value);
    const double nearest = std::round(place);
    // Some roundings of doubles, of numbers up to 2^16.
    if (std::abs(place - nearest) > 0x1p-32 || nearest > field.last_code()) return std::nullopt;
    return static_cast<int>(nearest);
}

std::vector<double> kept_values(const Module& module, const Packing& packing, const Field& field)
{
    std::vector<double> values;
    const auto add = [&](double value) {
        if (std::ranges::find(values, value) == values.end()) values.push_back(value);
    };
    const Parameter& parameter = module.parameters[field.parameter];
    add(parameter.default_value[static_cast<std::size_t>(field.component)]);
    for (const ExactRequirement& required : packing.exact)
        if (required.parameter == field.parameter) add(required.value);
    const bool has_unit =
        field.code.kind == Code::Kind::power || field.code.kind == Code::Kind::log2;
    const double unit = field.code.kind == Code::Kind::power ? field.code.unit : 1;
    if (has_unit && field.range.low + unit <= field.range.high) add(field.range.low + unit);
    if (field.is_signed) add(0);
    for (const Anchor& anchor : field.anchors) add(anchor.value);
    return values;
}

int channel_bits(const Packing& packing, const Channel& channel)
{
    int bits = 0;
    for (std::size_t i = 0; i < packing.supported.size(); ++i)
        if (packing.supported[i])
            bits = bits == 0 ? channel.formats[i].bits : std::min(bits, channel.formats[i].bits);
    return bits == 0 ? channel.formats[0].bits : bits;
}

}  // namespace lobe::ir
