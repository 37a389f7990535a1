#include "check/channels.h"

#include "check/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace lobe::check {
namespace {

using ir::any;
using ir::both;
using ir::Channel;
using ir::Configurations;

bool is_unorm(const ir::Format& format) { return format.storage == ir::Storage::unorm; }

/// `bit 3`, `bits 4..7`
std::string describe_bits(int low, int bits)
{
    return bits == 1 ? fmt::format("bit {}", low) : fmt::format("bits {}..{}", low, low + bits - 1);
}

class Checking {
public:
    Checking(const ir::Gbuffer& gbuffer, const ir::Packing& packing,
             const std::vector<PlacedField>& fields, Diagnostics& diagnostics)
        : gbuffer_(gbuffer), packing_(packing), fields_(fields), diagnostics_(diagnostics)
    {
    }

    void run()
    {
        report_overlaps();
        for (std::size_t channel = 0; channel < gbuffer_.channels.size(); ++channel) {
            const Use use = use_of(channel);
            if (use.bits == 0) continue;
            const bool passable = report_taken(gbuffer_.channels[channel], use);
            report_unfit(gbuffer_.channels[channel], use, passable);
        }
        report_budget();
    }

private:
    /// The first place where a channel is used, and how many of its low bits have to be there.
    struct Use {
        Span place;
        int bits = 0;
    };

    Use use_of(std::size_t channel) const
    {
        Use use;
        for (const PlacedField& placed : fields_)
            for (std::size_t i = 0; i < placed.field.slots.size(); ++i) {
                const ir::Slot& slot = placed.field.slots[i];
                if (slot.channel != channel) continue;
                if (use.bits == 0) use.place = placed.places[i];
                use.bits = std::max(use.bits, slot.low + slot.bits);
            }
        return use;
    }

    void report_overlaps()
    {
        struct Owner {
            const PlacedField* field = nullptr;
            Span place;
        };
        std::map<std::pair<std::size_t, int>, Owner> owners;  // by channel and bit
        for (const PlacedField& placed : fields_)
            for (std::size_t i = 0; i < placed.field.slots.size(); ++i) {
                const ir::Slot& slot = placed.field.slots[i];
                const Owner* other = nullptr;
                int first = 0;
                int shared = 0;
                for (int bit = slot.low; bit < slot.low + slot.bits; ++bit) {
                    const auto [found, added] =
                        owners.try_emplace({slot.channel, bit}, Owner{&placed, placed.places[i]});
                    if (added || (other != nullptr && !(found->second.place == other->place)))
                        continue;
                    if (other == nullptr) first = bit;
                    other = &found->second;
                    ++shared;
                }
                if (other == nullptr) continue;
                diagnostics_.report(
                    {.code = Code::overlapping_fields,
                     .message =
                         other->field == &placed
                             ? fmt::format("`{}` takes a bit twice", placed.name)
                             : fmt::format("`{}` and `{}` share {} of `{}`", other->field->name,
                                           placed.name, shared == 1 ? "a bit" : "bits",
                                           name_of(slot.channel)),
                     .primary = {placed.places[i], describe_bits(first, shared) +
                                                       (shared == 1 ? " is taken" : " are taken")},
                     .secondary = {{other->place, fmt::format("by `{}`", other->field->name)}}});
            }
    }

    std::string name_of(std::size_t channel) const
    {
        return gbuffer_.name_of(gbuffer_.channels[channel]);
    }

    /// Ways to have only configurations that are good, and where the channel is there.
    std::vector<std::string> ways_out(const Channel& channel, const Configurations& good) const
    {
        const auto clauses = narrowing(gbuffer_, packing_.supported, both(good, channel.exists));
        std::string text;
        for (const std::string& clause : clauses)
            text += fmt::format("{}`{}`", text.empty() ? "" : " and ", clause);
        if (text.empty()) return {"store it in another channel"};
        return {fmt::format("where that is all you need, say so: {}", text),
                "or store it in another channel"};
    }

    /// Where the channel is not there, and where it is there but holds no codes. `passable`: it can
    /// be had at all.
    void report_unfit(const Channel& channel, const Use& use, bool passable)
    {
        Configurations wrong(packing_.supported.size());
        for (std::size_t i = 0; i < wrong.size(); ++i)
            wrong[i] = channel.exists[i] && passable &&
                       (!is_unorm(channel.formats[i]) || channel.formats[i].bits < use.bits);
        std::vector<std::string> reasons;
        const Configurations absent = complement(channel.exists);
        if (const auto there = nearest_to_default(gbuffer_, both(absent, packing_.supported)))
            reasons.push_back(fmt::format(
                "{} it reads {}", describe_where(gbuffer_, *there, absent), channel.absent_value));
        if (const auto there = nearest_to_default(gbuffer_, both(wrong, packing_.supported))) {
            const ir::Format format = channel.formats[*there];
            reasons.push_back(fmt::format(
                "{} it is {}, {}", describe_where(gbuffer_, *there, wrong), describe(format),
                is_unorm(format) ? fmt::format("and bit {} is used", use.bits - 1)
                                 : "which holds no codes"));
        }
        if (reasons.empty()) return;
        Diagnostic diagnostic{
            .code = Code::channel_absent,
            .message = fmt::format(
                "`{}` {} wherever this packing has to work", gbuffer_.name_of(channel),
                any(both(absent, packing_.supported)) ? "is not there" : "does not hold codes"),
            .primary = {use.place, reasons[0]},
            .secondary = {{channel.span, fmt::format("this is {}", channel.label)}},
            .helps = {"store it in another channel"}};
        diagnostic.notes.assign(reasons.begin() + 1, reasons.end());
        if (passable) diagnostic.helps = ways_out(channel, complement(wrong));
        diagnostics_.report(std::move(diagnostic));
    }

    /// Everyone else who writes, reads or alters a channel where the packing has to work. False if
    /// there is no way around them.
    bool report_taken(const Channel& channel, const Use& use)
    {
        std::vector<Label> reasons;
        std::vector<std::string> lent;
        Configurations taken(packing_.supported.size());
        const auto add = [&](std::string_view what, const std::string& text,
                             const Configurations& when, const Span& span) {
            // What is not there can neither be in the way nor be altered.
            const Configurations there = both(when, channel.exists);
            const auto witness = nearest_to_default(gbuffer_, both(there, packing_.supported));
            if (!witness) return false;
            for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = taken[i] || there[i];
            reasons.push_back(
                {span, fmt::format("{} it {} {}", describe_where(gbuffer_, *witness, there), what,
                                   text)});
            return true;
        };
        for (const Channel::Holder& holder : channel.holders) {
            const bool given_up =
                std::ranges::find(packing_.without, holder.name) != packing_.without.end();
            if (holder.lent && given_up) continue;
            if (add("holds", holder.text, holder.when, holder.span) && holder.lent)
                lent.push_back(holder.name);
        }
        for (const Channel::Remark& reader : channel.consumers)
            add("is also read by", reader.text, reader.when, reader.span);
        for (const Channel::Remark& change : channel.changes)
            add("is changed by", change.text, change.when, change.span);
        if (channel.field.empty() && reasons.empty()) {
            report_unreachable(channel, use);
            return false;
        }
        if (reasons.empty()) return true;

        Diagnostic diagnostic{
            .code = Code::channel_taken,
            .message = fmt::format("`{}` is not the model's alone", gbuffer_.name_of(channel)),
            .primary = {use.place, reasons[0].text},
            .secondary = {{reasons[0].span, ""}}};
        diagnostic.secondary.insert(diagnostic.secondary.end(), reasons.begin() + 1, reasons.end());
        if (lent.size() == reasons.size())
            diagnostic.helps = {fmt::format("a model that does without it may take the channel: "
                                            "`without {}`",
                                            fmt::join(lent, ", ")),
                                "or store it in another channel"};
        else
            diagnostic.helps = ways_out(channel, complement(taken));
        const bool passable = lent.size() == reasons.size() || diagnostic.helps.size() > 1;
        diagnostics_.report(std::move(diagnostic));
        return passable;
    }

    void report_unreachable(const Channel& channel, const Use& use)
    {
        diagnostics_.report(
            {.code = Code::channel_taken,
             .message = fmt::format("no model can write `{}`", gbuffer_.name_of(channel)),
             .primary = {use.place, ""},
             .secondary = {{channel.span, "it names no `field` of the engine's shaders"}},
             .helps = {"store it in another channel"}});
    }

    void report_budget()
    {
        int needed = 0;
        for (const PlacedField& placed : fields_) needed += placed.field.bits;
        int there = 0;
        std::string list;
        for (const ir::Room& room : free_channels(gbuffer_, packing_.supported, packing_.without)) {
            there += room.bits;
            list += fmt::format("{}{} with {}", list.empty() ? "" : ", ", name_of(room.channel),
                                room.bits);
        }
        if (needed <= there) return;
        diagnostics_.report(
            {.code = Code::budget_exceeded,
             .message = fmt::format("these fields need {} bits, and `{}` has {} for them", needed,
                                    gbuffer_.name, there),
             .primary = {packing_.span, ""},
             .notes = {list.empty()
                           ? "no channel is free wherever this packing has to work"
                           : fmt::format("free wherever this packing has to work: {}", list)},
             .helps = budget_helps()});
    }

    std::vector<std::string> budget_helps() const
    {
        std::vector<std::string> helps{"give fields fewer bits"};
        std::vector<std::string> lent;
        for (const Channel& channel : gbuffer_.channels)
            for (const Channel::Holder& holder : channel.holders) {
                const bool known =
                    std::ranges::find(lent, holder.name) != lent.end() ||
                    std::ranges::find(packing_.without, holder.name) != packing_.without.end();
                if (!holder.lent || known) continue;
                std::vector<std::string> without = packing_.without;
                without.push_back(holder.name);
                if (free_channels(gbuffer_, packing_.supported, without).size() >
                    free_channels(gbuffer_, packing_.supported, packing_.without).size())
                    lent.push_back(holder.name);
            }
        if (!lent.empty())
            helps.push_back(fmt::format("or do without what the engine lends: `without {}`",
                                        fmt::join(lent, ", ")));
        return helps;
    }

    const ir::Gbuffer& gbuffer_;
    const ir::Packing& packing_;
    const std::vector<PlacedField>& fields_;
    Diagnostics& diagnostics_;
};

}  // namespace

int whole_width(const Channel& channel, const Configurations& supported)
{
    int bits = 0;
    for (std::size_t i = 0; i < supported.size(); ++i)
        if (supported[i] && channel.exists[i] && is_unorm(channel.formats[i]))
            bits = bits == 0 ? channel.formats[i].bits : std::min(bits, channel.formats[i].bits);
    // It never holds codes, which is reported; any width lets the rest be looked at.
    for (const ir::Format& format : channel.formats)
        if (bits == 0) bits = format.bits;
    return std::max(bits, 1);
}

void check_channels(const ir::Gbuffer& gbuffer, const ir::Packing& packing,
                    const std::vector<PlacedField>& fields, Diagnostics& diagnostics)
{
    Checking{gbuffer, packing, fields, diagnostics}.run();
}

}  // namespace lobe::check
