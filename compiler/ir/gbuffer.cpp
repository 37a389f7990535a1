#include "ir/gbuffer.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::ir {

std::string describe(Format format)
{
    switch (format.storage) {
    case Storage::unorm: return fmt::format("unorm {}", format.bits);
    case Storage::snorm: return fmt::format("snorm {}", format.bits);
    case Storage::floating: return fmt::format("float {}", format.bits);
    case Storage::srgb: return fmt::format("srgb {}", format.bits);
    }
    return {};
}

std::size_t Gbuffer::configurations() const
{
    std::size_t count = 1;
    for (const Setting& setting : settings) count *= setting.values.size();
    return count;
}

std::vector<std::size_t> Gbuffer::values(std::size_t configuration) const
{
    std::vector<std::size_t> result(settings.size());
    for (std::size_t i = settings.size(); i-- > 0;) {
        result[i] = configuration % settings[i].values.size();
        configuration /= settings[i].values.size();
    }
    return result;
}

std::size_t Gbuffer::configuration(const std::vector<std::size_t>& values) const
{
    std::size_t result = 0;
    for (std::size_t i = 0; i < settings.size(); ++i)
        result = result * settings[i].values.size() + values[i];
    return result;
}

std::size_t Gbuffer::default_configuration() const
{
    std::vector<std::size_t> defaults;
    for (const Setting& setting : settings) defaults.push_back(setting.default_value);
    return configuration(defaults);
}

Configurations Gbuffer::where(std::size_t setting, const std::vector<std::size_t>& wanted) const
{
    Configurations result(configurations());
    std::size_t stride = 1;
    for (std::size_t i = setting + 1; i < settings.size(); ++i) stride *= settings[i].values.size();
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] =
            std::ranges::find(wanted, i / stride % settings[setting].values.size()) != wanted.end();
    return result;
}

std::string Gbuffer::describe(std::size_t configuration, const Configurations& of) const
{
    // A setting matters when some other value of it, the rest unchanged, leaves the set.
    const std::vector<std::size_t> chosen = values(configuration);
    std::string text;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        std::vector<std::size_t> changed = chosen;
        bool matters = false;
        for (std::size_t value = 0; value < settings[i].values.size(); ++value) {
            changed[i] = value;
            matters |= !of[this->configuration(changed)];
        }
        if (!matters) continue;
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", settings[i].label,
                            settings[i].values[chosen[i]]);
    }
    return text.empty() ? "every setting" : text;
}

std::string Gbuffer::name_of(const Channel& channel) const
{
    return fmt::format("{}.{}", targets[channel.target].name, channel.name);
}

std::optional<std::size_t> Gbuffer::find_channel(std::string_view target,
                                                 std::string_view channel_name) const
{
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (targets[channels[i].target].name == target && channels[i].name == channel_name)
            return i;
    return std::nullopt;
}

std::optional<std::size_t> Gbuffer::find_pin(std::string_view pin_name) const
{
    for (std::size_t i = 0; i < pins.size(); ++i)
        if (pins[i].name == pin_name) return i;
    return std::nullopt;
}

std::optional<std::size_t> nearest_to_default(const Gbuffer& gbuffer, const Configurations& set)
{
    std::optional<std::size_t> nearest;
    std::size_t least = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (!set[i]) continue;
        const std::vector<std::size_t> values = gbuffer.values(i);
        std::size_t differences = 0;
        for (std::size_t k = 0; k < values.size(); ++k)
            differences += values[k] != gbuffer.settings[k].default_value ? 1 : 0;
        if (nearest && differences >= least) continue;
        nearest = i;
        least = differences;
    }
    return nearest;
}

namespace {

/// The fewest bits of a channel that is a unorm everywhere here; 0 if it is not.
int unorm_bits(const Channel& channel, const Configurations& supported)
{
    int bits = 0;
    for (std::size_t i = 0; i < supported.size(); ++i) {
        if (!supported[i]) continue;
        const Format format = channel.formats[i];
        if (!channel.exists[i] || format.storage != Storage::unorm) return 0;
        bits = bits == 0 ? format.bits : std::min(bits, format.bits);
    }
    return bits;
}

}  // namespace

std::vector<Room> free_channels(const Gbuffer& gbuffer, const Configurations& supported,
                                const std::vector<std::string>& without)
{
    const auto acts = [&](const auto& fact) { return any(both(fact.when, supported)); };
    std::vector<Room> result;
    for (std::size_t i = 0; i < gbuffer.channels.size(); ++i) {
        const Channel& channel = gbuffer.channels[i];
        const int bits = unorm_bits(channel, supported);
        const bool held = std::ranges::any_of(channel.holders, [&](const Channel::Holder& holder) {
            const bool given_up =
                holder.lent && std::ranges::find(without, holder.name) != without.end();
            return acts(holder) && !given_up;
        });
        if (bits == 0 || channel.field.empty() || held ||
            std::ranges::any_of(channel.consumers, acts) ||
            std::ranges::any_of(channel.changes, acts))
            continue;
        result.push_back({i, bits});
    }
    return result;
}

Configurations both(const Configurations& a, const Configurations& b)
{
    Configurations result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] && b[i];
    return result;
}

Configurations except(const Configurations& a, const Configurations& b)
{
    Configurations result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] && !b[i];
    return result;
}

bool any(const Configurations& set) { return std::ranges::find(set, true) != set.end(); }

}  // namespace lobe::ir
