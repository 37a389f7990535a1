#include "cli/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lobe::cli {
namespace {

std::string listed(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

/// `no tier `bse`; did you mean `base`?` with all that there are below.
std::string unknown(const std::string& what, const std::string& name,
                    const std::vector<std::string>& known)
{
    const auto near = nearest(name, known);
    std::string out = fmt::format("no {} `{}`", what, name);
    if (near) out += fmt::format("; did you mean `{}`?", *near);
    if (known.empty()) return out + "\n  = note: there is none";
    return out + "\n  = note: there are " + listed(known);
}

/// A gbuffer by its name: of the module itself, or of any other that was given.
const ir::Gbuffer* find_gbuffer(const Program& program, const ir::Module& module,
                                const std::string& name)
{
    if (const ir::Gbuffer* found = module.find_gbuffer(name)) return found;
    for (const ir::Module& other : program.modules)
        if (const ir::Gbuffer* found = other.find_gbuffer(name)) return found;
    return nullptr;
}

std::vector<std::string> gbuffer_names(const Program& program)
{
    std::vector<std::string> out;
    for (const ir::Module& module : program.modules)
        for (const ir::Gbuffer& gbuffer : module.gbuffers)
            if (std::ranges::find(out, gbuffer.name) == out.end()) out.push_back(gbuffer.name);
    return out;
}

struct Candidate {
    const ir::Module* module = nullptr;
    const ir::Model* model = nullptr;    ///< of one that is not packed
    std::optional<std::size_t> packing;  ///< index into the module's packings
    const std::string& name() const
    {
        return packing ? module->packings[*packing].model.name : model->name;
    }
};

/// Every packing, and every model of these modules that has none for this gbuffer.
std::vector<Candidate> candidates(const Program& program, const std::string& gbuffer)
{
    std::vector<Candidate> out;
    for (const ir::Module& module : program.modules) {
        std::vector<std::string> packed;
        for (std::size_t i = 0; i < module.packings.size(); ++i) {
            const ir::Packing& packing = module.packings[i];
            if (!gbuffer.empty() && packing.gbuffer != gbuffer) continue;
            out.push_back({&module, nullptr, i});
            packed.push_back(packing.model.name);
        }
        for (const ir::Model& model : module.models)
            if (std::ranges::find(packed, model.name) == packed.end())
                out.push_back({&module, &model, std::nullopt});
    }
    return out;
}

bool is_scalar(const ir::Parameter& parameter)
{
    return parameter.quantity == ir::Quantity::number && components(parameter.type) == 1;
}

std::vector<std::string> parameter_names(const ir::Module& module)
{
    std::vector<std::string> out;
    for (const ir::Parameter& parameter : module.parameters) out.push_back(parameter.name);
    return out;
}

std::string choose_parameters(const SearchRequest& request, Subject& subject,
                              std::vector<std::uint32_t>& chosen)
{
    const ir::Module& module = subject.module;
    const std::vector<std::string> names = parameter_names(module);
    const auto add = [&chosen](std::size_t index) {
        const auto id = static_cast<std::uint32_t>(index);
        if (std::ranges::find(chosen, id) == chosen.end()) chosen.push_back(id);
    };
    for (const std::string& name : request.parameters) {
        const auto at = std::ranges::find(names, name);
        if (at == names.end()) return unknown("parameter", name, names);
        add(static_cast<std::size_t>(at - names.begin()));
    }
    std::vector<std::string> colors;
    for (const std::string& tier : request.tiers) {
        if (std::ranges::find(module.tiers, tier) == module.tiers.end())
            return unknown("tier", tier, module.tiers);
        for (std::size_t i = 0; i < module.parameters.size(); ++i) {
            if (module.parameters[i].tier != tier) continue;
            if (is_scalar(module.parameters[i]))
                add(i);
            else
                colors.push_back(names[i]);
        }
    }
    if (!colors.empty())
        subject.notes.push_back("left out, since a tier stands for its scalars: " + listed(colors));
    if (request.parameters.empty() && request.tiers.empty()) {
        for (const ir::Field& field : module.packings[subject.packing].fields) add(field.parameter);
        if (chosen.empty())
            for (std::size_t i = 0; i < module.parameters.size(); ++i)
                if (is_scalar(module.parameters[i])) add(i);
    }
    return chosen.empty() ? "there is no parameter to place" : "";
}

std::string choose_content(const SearchRequest& request, const ir::Gbuffer& gbuffer,
                           ir::Packing& packing)
{
    std::vector<std::string> lent;
    for (const ir::Channel& channel : gbuffer.channels)
        for (const ir::Channel::Holder& holder : channel.holders)
            if (holder.lent && std::ranges::find(lent, holder.name) == lent.end())
                lent.push_back(holder.name);
    for (const std::string& name : request.without) {
        if (std::ranges::find(lent, name) == lent.end())
            return unknown("content that the engine lends is called", name, lent);
        if (std::ranges::find(packing.without, name) == packing.without.end())
            packing.without.push_back(name);
    }
    return {};
}

/// Why a channel has no room: what is there, in the words of the gbuffer.
std::string why_taken(const ir::Channel& channel)
{
    std::string out;
    for (const ir::Channel::Holder& holder : channel.holders)
        out += fmt::format("\n  = note: it holds {}{}", holder.text,
                           holder.lent ? fmt::format("; --without {} takes it", holder.name) : "");
    return out.empty() ? "\n  = note: it is not there, or has other readers, under a setting that "
                         "is supported"
                       : out;
}

std::string choose_room(const SearchRequest& request, const ir::Gbuffer& gbuffer,
                        const ir::Packing& packing, std::vector<ir::Slot>& room)
{
    room = analyze::room(gbuffer, packing);
    if (!request.channels.empty()) {
        std::vector<std::string> names;
        for (const ir::Channel& channel : gbuffer.channels)
            names.push_back(gbuffer.name_of(channel));
        std::vector<ir::Slot> chosen;
        for (const std::string& name : request.channels) {
            const auto at = std::ranges::find(names, name);
            if (at == names.end()) return unknown("channel", name, names);
            const auto channel = static_cast<std::size_t>(at - names.begin());
            const std::size_t before = chosen.size();
            for (const ir::Slot& slot : room)
                if (slot.channel == channel && std::ranges::find(chosen, slot) == chosen.end())
                    chosen.push_back(slot);
            if (chosen.size() == before && std::ranges::count(request.channels, name) == 1)
                return fmt::format("channel `{}` is not free{}", name,
                                   why_taken(gbuffer.channels[channel]));
        }
        room = std::move(chosen);
    }
    int bits = 0;
    for (const ir::Slot& slot : room) bits += slot.bits;
    if (bits == 0)
        return fmt::format("gbuffer `{}` has no free bit wherever this packing has to work",
                           gbuffer.name);
    if (!request.bits) return {};
    if (*request.bits > bits)
        return fmt::format("--bits {} is more than the {} there are", *request.bits, bits);
    // The first so many; of the last channel its upper bits.
    int left = *request.bits;
    std::vector<ir::Slot> chosen;
    for (const ir::Slot& slot : room) {
        if (left == 0) break;
        const int taken = std::min(left, slot.bits);
        chosen.push_back({slot.channel, slot.low + slot.bits - taken, taken});
        left -= taken;
    }
    room = std::move(chosen);
    return {};
}

/// `10%` or `10 %` as 0.1.
std::optional<double> fraction_of(std::string text)
{
    if (!text.ends_with('%')) return std::nullopt;
    text.pop_back();
    while (text.ends_with(' ')) text.pop_back();
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    if (!std::isfinite(number) || number <= 0) return std::nullopt;
    return number / 100;
}

}  // namespace

std::string SearchRequest::first_option() const
{
    if (!gbuffer.empty()) return "--on";
    if (!parameters.empty()) return "--parameters";
    if (!tiers.empty()) return "--tier";
    if (!channels.empty()) return "--channels";
    if (bits) return "--bits";
    if (!without.empty()) return "--without";
    return max_error.empty() ? "" : "--max-error";
}

std::string choose_subject(const Program& program, const std::string& model,
                           const std::string& gbuffer, Subject& subject)
{
    const std::vector<std::string> gbuffers = gbuffer_names(program);
    if (!gbuffer.empty() && std::ranges::find(gbuffers, gbuffer) == gbuffers.end())
        return unknown("gbuffer", gbuffer, gbuffers) +
               "\n  = help: name the file that declares it too";

    std::vector<Candidate> all = candidates(program, gbuffer);
    std::vector<std::string> names;
    for (const Candidate& candidate : all)
        if (std::ranges::find(names, candidate.name()) == names.end())
            names.push_back(candidate.name());
    if (names.empty()) return "there is no model to pack";
    if (!model.empty()) {
        if (std::ranges::find(names, model) == names.end()) return unknown("model", model, names);
        std::erase_if(all, [&](const Candidate& candidate) { return candidate.name() != model; });
    }
    // Packings before models that have none.
    const auto is_packed = [](const Candidate& candidate) { return candidate.packing.has_value(); };
    if (std::ranges::any_of(all, is_packed))
        std::erase_if(all, [&](const Candidate& candidate) { return !is_packed(candidate); });
    if (all.size() > 1) {
        std::vector<std::string> left;
        for (const Candidate& candidate : all)
            left.push_back(is_packed(candidate)
                               ? fmt::format("{} on {}", candidate.name(),
                                             candidate.module->packings[*candidate.packing].gbuffer)
                               : candidate.name());
        return fmt::format("--suggest takes one of {}\n  = help: choose with --packing MODEL{}",
                           listed(left), gbuffer.empty() ? " or --on GBUFFER" : "");
    }

    const Candidate& chosen = all.front();
    subject.original = chosen.module;
    subject.module = *chosen.module;
    if (chosen.packing) {
        subject.packing = *chosen.packing;
        subject.is_written = true;
        return {};
    }
    if (gbuffer.empty() && gbuffers.size() != 1)
        return fmt::format("model `{}` is not packed; say where with --on GBUFFER{}", chosen.name(),
                           gbuffers.empty() ? "\n  = help: name the file that declares it too"
                                            : "\n  = note: there are " + listed(gbuffers));
    const ir::Gbuffer* place =
        find_gbuffer(program, *chosen.module, gbuffer.empty() ? gbuffers.front() : gbuffer);
    if (subject.module.find_gbuffer(place->name) == nullptr)
        subject.module.gbuffers.push_back(*place);
    ir::Packing packing;
    packing.model = *chosen.model;
    packing.gbuffer = place->name;
    packing.module = subject.module.name;
    packing.supported.assign(place->configurations(), true);
    subject.packing = subject.module.packings.size();
    subject.module.packings.push_back(std::move(packing));
    return {};
}

std::string understand(const SearchRequest& request, Subject& subject,
                       analyze::SuggestOptions& options)
{
    ir::Packing& packing = subject.module.packings[subject.packing];
    const ir::Gbuffer& gbuffer = *subject.module.find_gbuffer(packing.gbuffer);
    if (std::string why = choose_parameters(request, subject, options.parameters); !why.empty())
        return why;
    if (std::string why = choose_content(request, gbuffer, packing); !why.empty()) return why;
    if (std::string why = choose_room(request, gbuffer, packing, options.room); !why.empty())
        return why;
    if (request.max_error.empty()) return {};
    options.error = fraction_of(request.max_error);
    return options.error ? ""
                         : fmt::format("--max-error takes a percentage above 0, such as 10%; "
                                       "got `{}`",
                                       request.max_error);
}

}  // namespace lobe::cli
