// One line of a packing: slots, parameter, storage, range and code.
#include "check/codes.h"
#include "check/declarations.h"
#include "check/packings.h"
#include "check/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::check {
namespace {

/// Codes of more bits are not whole numbers in every float that they pass through.
constexpr int most_bits = 16;

struct PlacedSlot {
    ir::Slot slot;
    Span place;
};

class FieldReader {
public:
    FieldReader(Program& program, const Subject& subject, const ir::Configurations& supported,
                const syntax::FieldClause& clause, Diagnostics& diagnostics)
        : program_(program), subject_(subject), gbuffer_(*subject.gbuffer), supported_(supported),
          clause_(clause), diagnostics_(diagnostics)
    {
    }

    std::vector<PlacedField> read()
    {
        const auto slots = read_slots();
        const auto parameter = find_parameter(program_, subject_, clause_.parameter,
                                              Code::packing_clause, diagnostics_);
        const bool stored = read_storage();
        if (!parameter) return {};
        parameter_ = &program_.parameters[*parameter];
        ir::Field field;
        field.parameter = *parameter;
        field.bits = clause_.storage.bits;
        field.is_signed = clause_.storage.kind.text == "snorm";
        field.span = clause_.span;
        const auto components = read_components();
        const bool ranged = read_range(field.range);
        if (!slots || !stored || !components || !ranged) return {};

        std::vector<PlacedField> result = place(field, *components, *slots);
        if (result.empty()) return {};
        // Each for itself: a pivot is where the component has its own default.
        for (PlacedField& placed : result) {
            const auto code = read_code(program_, subject_.file, clause_, placed.field, *parameter_,
                                        diagnostics_);
            if (!code) return {};
            placed.field.code = *code;
        }
        return result;
    }

private:
    // ---- slots

    std::optional<std::vector<PlacedSlot>> read_slots()
    {
        std::vector<PlacedSlot> result;
        bool good = true;
        for (const syntax::SlotClause& slot : clause_.slots) good = read_slot(slot, result) && good;
        if (!good) return std::nullopt;
        return result;
    }

    bool read_slot(const syntax::SlotClause& slot, std::vector<PlacedSlot>& result)
    {
        if (slot.target.text.empty() || slot.channels.text.empty()) return false;  // reported
        const auto target =
            std::ranges::find(gbuffer_.targets, slot.target.text, &ir::RenderTarget::name);
        if (target == gbuffer_.targets.end()) {
            std::vector<std::string> known;
            for (const ir::RenderTarget& other : gbuffer_.targets) known.push_back(other.name);
            return unknown_slot(slot.target, fmt::format("`{}` has no target", gbuffer_.name),
                                known, "targets");
        }
        std::vector<std::size_t> channels;
        const std::string& name = slot.channels.text;
        if (const auto whole = gbuffer_.find_channel(slot.target.text, name)) {
            channels.push_back(*whole);
        } else {
            for (const char letter : name)
                if (const auto one = gbuffer_.find_channel(slot.target.text, {&letter, 1}))
                    channels.push_back(*one);
            if (channels.size() < name.size()) return unknown_channel(slot, *target);
        }
        if (slot.low && channels.size() > 1) {
            diagnostics_.report(
                {.code = Code::unknown_slot,
                 .message = "bits are bits of one channel",
                 .primary = {slot.span, fmt::format("these are {} channels", channels.size())},
                 .helps = {"write each channel with its bits: `d.r[0..3], "
                           "d.g[0..3]`"}});
            return false;
        }
        for (const std::size_t channel : channels) {
            ir::Slot placed{channel, 0, whole_width(gbuffer_.channels[channel], supported_)};
            if (slot.low) {
                placed.low = *slot.low;
                placed.bits = slot.high.value_or(*slot.low) - *slot.low + 1;
                if (!has_bits(slot, placed)) return false;
            }
            result.push_back({placed, slot.span});
        }
        return true;
    }

    bool unknown_slot(const syntax::Identifier& name, std::string_view what,
                      const std::vector<std::string>& known, std::string_view kind)
    {
        Diagnostic diagnostic{
            .code = Code::unknown_slot,
            .message = fmt::format("{} `{}`{}", what, name.text, did_you_mean(name.text, known)),
            .primary = {name.span, ""},
            .fix = rename_fix(name.text, name.span, known)};
        if (!diagnostic.fix)
            diagnostic.notes = {fmt::format("its {} are {}", kind, fmt::join(known, ", "))};
        diagnostics_.report(std::move(diagnostic));
        return false;
    }

    bool unknown_channel(const syntax::SlotClause& slot, const ir::RenderTarget& target)
    {
        const auto index = static_cast<std::size_t>(&target - gbuffer_.targets.data());
        std::vector<std::string> known;
        for (const ir::Channel& channel : gbuffer_.channels)
            if (channel.target == index) known.push_back(channel.name);
        return unknown_slot(slot.channels, fmt::format("`{}` has no channel", target.name), known,
                            "channels");
    }

    /// Under some configuration; whether under all that are supported is a question for channels.h.
    bool has_bits(const syntax::SlotClause& clause, const ir::Slot& slot)
    {
        const ir::Channel& channel = gbuffer_.channels[slot.channel];
        int most = 0;
        for (const ir::Format& format : channel.formats) most = std::max(most, format.bits);
        if (slot.low + slot.bits <= most) return true;
        diagnostics_.report(
            {.code = Code::unknown_slot,
             .message = fmt::format("`{}` has no bit {}", gbuffer_.name_of(channel),
                                    slot.low + slot.bits - 1),
             .primary = {clause.span, fmt::format("it has {} bits, 0 to {}", most, most - 1)},
             .secondary = {{channel.span, "declared here"}}});
        return false;
    }

    // ---- storage

    void refuse_storage(std::string message, const Span& span, std::string label,
                        std::vector<std::string> helps = {})
    {
        diagnostics_.report({.code = Code::field_width,
                             .message = std::move(message),
                             .primary = {span, std::move(label)},
                             .helps = std::move(helps)});
    }

    bool read_storage()
    {
        const syntax::StorageClause& storage = clause_.storage;
        const std::string& kind = storage.kind.text;
        if (kind.empty()) return false;  // a syntax error was reported
        if (kind != "unorm" && kind != "snorm") {
            diagnostics_.report(
                {.code = Code::field_width,
                 .message = fmt::format("a field is stored as unorm or snorm, not as {}{}", kind,
                                        did_you_mean(kind, {"unorm", "snorm"})),
                 .primary = {storage.kind.span, ""},
                 .notes =
                     {"unorm counts codes from the low end of a range, snorm has a code for 0"},
                 .fix = rename_fix(kind, storage.kind.span, {"unorm", "snorm"})});
            return false;
        }
        const int least = kind == "snorm" ? 2 : 1;
        if (storage.bits >= least && storage.bits <= most_bits) return true;
        refuse_storage(fmt::format("{} has {} to {} bits", kind, least, most_bits), storage.span,
                       fmt::format("this asks for {}", storage.bits));
        return false;
    }

    // ---- what is stored

    /// The components that this line stores, in order.
    std::optional<std::vector<int>> read_components()
    {
        const int count = ir::components(parameter_->type);
        if (!clause_.component) {
            std::vector<int> all;
            for (int i = 0; i < count; ++i) all.push_back(i);
            return all;
        }
        const syntax::Identifier& name = *clause_.component;
        const bool color = parameter_->quantity == ir::Quantity::color;
        for (int i = 0; count > 1 && i < count; ++i) {
            const auto letter = static_cast<std::size_t>(i);
            if (name.text == std::string_view{"rgba"}.substr(letter, 1) ||
                (!color && name.text == std::string_view{"xyzw"}.substr(letter, 1)))
                return std::vector<int>{i};
        }
        diagnostics_.report(
            {.code = Code::unknown_member,
             .message = fmt::format("`{}` has no component `{}`", parameter_->name, name.text),
             .primary = {name.span, count == 1 ? "it is one number" : ""},
             .secondary = {{parameter_->span, "declared here"}}});
        return std::nullopt;
    }

    bool read_range(ir::Range& range)
    {
        range = parameter_->range;
        if (clause_.range) {
            if (!resolve_range(program_.files[subject_.file]->tree, *clause_.range, range,
                               diagnostics_))
                return false;
            const ir::Range& declared = parameter_->range;
            if (range.low >= declared.low && range.high <= declared.high) return true;
            diagnostics_.report(
                {.code = Code::field_width,
                 .message =
                     fmt::format("this field carries more than `{}` can be", parameter_->name),
                 .primary = {clause_.range->span,
                             fmt::format(
                                 "{} is outside of its range",
                                 describe(range.low < declared.low ? range.low : range.high))},
                 .secondary = {{parameter_->span,
                                fmt::format("its range is {}", describe(declared))}},
                 .helps = {"carry its range or less: codes for other values are lost"}});
            return false;
        }
        if (std::isfinite(range.low) && std::isfinite(range.high)) return true;
        diagnostics_.report(
            {.code = Code::range_clamped,
             .message =
                 fmt::format("`{}` has no range, and every storage has one", parameter_->name),
             .primary = {clause_.parameter.span,
                         fmt::format("it is in {}", describe(parameter_->range))},
             .secondary = {{parameter_->span, "declared here"}},
             .helps = {"give the parameter a range, or say what is carried: `in [low, high]`"}});
        return false;
    }

    /// Shares the slots out among the components, most significant bits first.
    std::vector<PlacedField> place(const ir::Field& field, const std::vector<int>& components,
                                   const std::vector<PlacedSlot>& slots)
    {
        int width = 0;
        for (const PlacedSlot& slot : slots) width += slot.slot.bits;
        const int wanted = field.bits * static_cast<int>(components.size());
        if (width != wanted) {
            const Span whole = join(clause_.slots.front().span, clause_.slots.back().span);
            Diagnostic diagnostic{.code = Code::field_width,
                                  .message =
                                      fmt::format("`{}` takes {} bits, and its slots have {}",
                                                  clause_.parameter.text, wanted, width),
                                  .primary = {clause_.storage.span,
                                              components.size() == 1
                                                  ? fmt::format("{} bits", wanted)
                                                  : fmt::format("{} bits for each of {} components",
                                                                field.bits, components.size())},
                                  .secondary = {{whole, fmt::format("{} bits", width)}}};
            const int share = width / static_cast<int>(components.size());
            if (share * static_cast<int>(components.size()) == width &&
                share >= (field.is_signed ? 2 : 1) && share <= most_bits)
                diagnostic.fix = Fix{clause_.storage.span,
                                     fmt::format("{} {}", clause_.storage.kind.text, share),
                                     "use all bits of the slots"};
            diagnostics_.report(std::move(diagnostic));
            return {};
        }
        std::vector<PlacedField> result;
        std::size_t next = 0;
        for (const int component : components) {
            PlacedField placed{field, component_name(*parameter_, component), {}};
            placed.field.component = component;
            int bits = 0;
            while (bits < field.bits && next < slots.size()) {
                bits += slots[next].slot.bits;
                placed.field.slots.push_back(slots[next].slot);
                placed.places.push_back(slots[next++].place);
            }
            if (bits > field.bits) {
                refuse_storage(
                    fmt::format("the bits of `{}` do not end where a slot ends", placed.name),
                    placed.places.back(), "", {"write a line for each component"});
                return {};
            }
            result.push_back(std::move(placed));
        }
        return result;
    }

    Program& program_;
    const Subject& subject_;
    const ir::Gbuffer& gbuffer_;
    const ir::Configurations& supported_;
    const syntax::FieldClause& clause_;
    Diagnostics& diagnostics_;
    const ir::Parameter* parameter_ = nullptr;
};

}  // namespace

std::string component_name(const ir::Parameter& parameter, int component)
{
    if (ir::components(parameter.type) == 1) return parameter.name;
    const bool color = parameter.quantity == ir::Quantity::color;
    return fmt::format(
        "{}.{}", parameter.name,
        std::string_view{color ? "rgba" : "xyzw"}[static_cast<std::size_t>(component)]);
}

std::vector<PlacedField> read_field(Program& program, const Subject& subject,
                                    const ir::Configurations& supported,
                                    const syntax::FieldClause& clause, Diagnostics& diagnostics)
{
    return FieldReader{program, subject, supported, clause, diagnostics}.read();
}

}  // namespace lobe::check
