#include "ir/packing.h"

#include "ir/module.h"

#include <fmt/format.h>

namespace lobe::ir {

std::string describe(const Code& code, int bits)
{
    const auto pivot = [&] { return fmt::format("{}/{}", code.pivot, (1 << bits) - 1); };
    switch (code.kind) {
    case Code::Kind::linear:
        return code.pivot == 0 ? "linear" : fmt::format("linear({})", pivot());
    case Code::Kind::square_root: return "sqrt";
    case Code::Kind::power: return fmt::format("power({}, {})", code.exponent, pivot());
    case Code::Kind::log2: return code.pivot == 0 ? "log2" : fmt::format("log2({})", pivot());
    case Code::Kind::declared: return code.name;
    }
    return {};
}

std::string field_name(const Module& module, const Field& field)
{
    const Parameter& parameter = module.parameters[field.parameter];
    if (components(parameter.type) == 1) return parameter.name;
    constexpr std::string_view suffixes = "rgba";
    return fmt::format("{}_{}", parameter.name, suffixes[static_cast<std::size_t>(field.component)]);
}

}  // namespace lobe::ir
