#include "analyze/packing/packing_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {
namespace {

std::string range_text(const ir::Range& range)
{
    return fmt::format("[{}, {}]", range.low, range.high);
}

std::string joined(const std::vector<std::string>& parts)
{
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    return text;
}

std::string slot_text(const ir::Gbuffer& gbuffer, const ir::Packing& packing, const ir::Slot& slot)
{
    const ir::Channel& channel = gbuffer.channels[slot.channel];
    const std::string name = gbuffer.name_of(channel);
    if (slot.low == 0 && slot.bits == ir::channel_bits(packing, channel)) return name;
    if (slot.bits == 1) return fmt::format("{}[{}]", name, slot.low);
    return fmt::format("{}[{}..{}]", name, slot.low, slot.low + slot.bits - 1);
}

/// What stands before, between and behind the `=` and the `:` of a field.
struct FieldText {
    std::string slots;
    std::string name;
    std::string storage;
};

FieldText field_text(const ir::Module& module, const ir::Gbuffer& gbuffer,
                     const ir::Packing& packing, const ir::Field& field)
{
    std::vector<std::string> slots;
    for (const ir::Slot& slot : field.slots) slots.push_back(slot_text(gbuffer, packing, slot));
    const ir::Parameter& parameter = module.parameters[field.parameter];
    FieldText text{joined(slots), parameter.name, {}};
    if (ir::components(parameter.type) > 1)
        text.name += fmt::format(".{}", "rgba"[static_cast<std::size_t>(field.component)]);
    text.storage = fmt::format("{} {}", field.is_signed ? "snorm" : "unorm", field.bits);
    if (field.range != parameter.range) text.storage += " in " + range_text(field.range);
    const bool plain = field.code.kind == ir::Code::Kind::linear && field.code.pivot == 0;
    if (!plain && !field.is_signed) text.storage += " code " + ir::describe(field.code, field.bits);
    return text;
}

/// `supports version == v4_26, v4_27`, for every setting that the packing does not support all of.
std::vector<std::string> supports(const ir::Gbuffer& gbuffer, const ir::Packing& packing)
{
    std::vector<std::string> clauses;
    for (std::size_t s = 0; s < gbuffer.settings.size(); ++s) {
        const ir::Setting& setting = gbuffer.settings[s];
        std::vector<bool> seen(setting.values.size());
        for (std::size_t i = 0; i < packing.supported.size(); ++i)
            if (packing.supported[i]) seen[gbuffer.values(i)[s]] = true;
        if (std::ranges::all_of(seen, [](bool value) { return value; })) continue;
        std::vector<std::string> values;
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (seen[i]) values.push_back(setting.values[i]);
        clauses.push_back(fmt::format("supports {} == {}", setting.name, joined(values)));
    }
    return clauses;
}

}  // namespace

std::string packing_text(const ir::Module& module, const ir::Packing& packing,
                         const std::vector<std::string>& remarks)
{
    const ir::Gbuffer& gbuffer = *module.find_gbuffer(packing.gbuffer);
    std::string text = fmt::format("packing {} on {} {{\n", packing.model.name, packing.gbuffer);
    std::vector<FieldText> fields;
    std::size_t slots = 0, names = 0;
    for (const ir::Field& field : packing.fields) {
        fields.push_back(field_text(module, gbuffer, packing, field));
        slots = std::max(slots, fields.back().slots.size());
        names = std::max(names, fields.back().name.size());
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
        text += fmt::format("  {:{}} = {:{}} : {}", fields[i].slots, slots, fields[i].name, names,
                            fields[i].storage);
        if (i < remarks.size() && !remarks[i].empty()) text += "  // " + remarks[i];
        text += "\n";
    }
    for (const ir::MeasuredRange& over : packing.measured)
        text += fmt::format("  over {} in {}\n", over.name, range_text(over.range));
    for (const std::string& clause : supports(gbuffer, packing)) text += "  " + clause + "\n";
    if (!packing.without.empty()) text += fmt::format("  without {}\n", joined(packing.without));
    std::vector<std::string> exact;
    for (const ir::ExactRequirement& required : packing.exact)
        exact.push_back(
            fmt::format("{} == {}", module.parameters[required.parameter].name, required.value));
    if (!exact.empty()) text += fmt::format("  require exact {}\n", joined(exact));
    if (packing.radiance_limit)
        text += fmt::format("  require radiance error < {:.6g}%\n", *packing.radiance_limit * 100);
    return text + "}\n";
}

}  // namespace lobe::analyze
