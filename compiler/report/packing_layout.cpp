#include "report/packing_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

using ir::any;
using ir::both;
using ir::except;

constexpr int nobody = -1;

/// Who has each bit of a channel.
struct Bits {
    std::vector<int> field;  ///< index into Packing::fields, or nobody
    std::vector<int> slot;   ///< index into that field's slots
    std::vector<bool> room;
};

Bits bits_of(const Packed& packed, std::size_t channel, int count)
{
    const auto size = static_cast<std::size_t>(count);
    Bits out{std::vector<int>(size, nobody), std::vector<int>(size, 0), std::vector<bool>(size)};
    const auto inside = [&](const ir::Slot& slot, const auto& visit) {
        if (slot.channel != channel) return;
        for (int bit = std::max(slot.low, 0); bit < std::min(slot.low + slot.bits, count); ++bit)
            visit(static_cast<std::size_t>(bit));
    };
    for (const ir::Slot& slot : packed.room)
        inside(slot, [&](std::size_t bit) { out.room[bit] = true; });
    for (std::size_t i = 0; i < packed.packing->fields.size(); ++i) {
        const std::vector<ir::Slot>& slots = packed.packing->fields[i].slots;
        for (std::size_t k = 0; k < slots.size(); ++k)
            inside(slots[k], [&](std::size_t bit) {
                out.field[bit] = static_cast<int>(i);
                out.slot[bit] = static_cast<int>(k);
            });
    }
    return out;
}

std::string join(const std::string& a, const std::string& b)
{
    return a.empty() || b.empty() ? a + b : a + "; " + b;
}

/// Consumers and changes that act in some supported configuration.
std::string remarks(const ir::Channel& channel, const ir::Configurations& supported)
{
    std::string out;
    for (const auto& consumer : channel.consumers)
        if (any(both(consumer.when, supported))) out = join(out, "read by " + consumer.text);
    for (const auto& change : channel.changes)
        if (any(both(change.when, supported))) out = join(out, "changed by " + change.text);
    return out;
}

/// What the engine keeps in a channel, under the shown configuration or any other supported one;
/// null if the packing goes without it.
const ir::Channel::Holder* holder_of(const Packed& packed, const ir::Channel& channel,
                                     std::size_t shown)
{
    const ir::Configurations everywhere(packed.gbuffer().configurations(), true);
    const std::vector<std::string>& without = packed.packing->without;
    for (const bool elsewhere : {false, true})
        for (const ir::Channel::Holder& holder : channel.holders) {
            const bool there =
                elsewhere ? any(both(holder.when, packed.packing->supported)) : holder.when[shown];
            if (!there || std::ranges::find(without, holder.name) != without.end()) continue;
            // Nothing lives in a channel that is not there, unless that is what keeps shaders
            // from it: content of this configuration in particular.
            if (!channel.exists[shown] && (elsewhere || holder.when == everywhere)) continue;
            return &holder;
        }
    return nullptr;
}

/// What stands in bits that no field uses.
Piece unused(const Packed& packed, const ir::Channel& channel, std::size_t shown, bool is_room)
{
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    const ir::Configurations& supported = packed.packing->supported;
    const ir::Configurations missing = except(supported, channel.exists);
    Piece piece;
    piece.detail = is_room ? "" : remarks(channel, supported);
    if (is_room) {
        piece.holds = Piece::Holds::nothing;
        piece.label = "free";
    } else if (const ir::Channel::Holder* holder = holder_of(packed, channel, shown)) {
        piece.holds = Piece::Holds::engine;
        piece.label = holder->name;
        piece.detail = join(holder->text, piece.detail);
        if (holder->lent) piece.detail += "; lent: `without " + holder->name + "` takes it";
    } else if (!channel.exists[shown]) {
        piece.label = "not there";
        piece.detail = "not there under " + gbuffer.describe(shown, missing);
    } else if (const auto example = nearest_to_default(gbuffer, missing)) {
        piece.label = "not always there";
        piece.detail = "not there under " + gbuffer.describe(*example, missing);
    } else if (channel.field.empty()) {
        piece.label = "out of reach";
        piece.detail = "no shader of a model can reach it";
    } else if (channel.formats[shown].storage != ir::Storage::unorm) {
        piece.label = describe(channel.formats[shown]);
        piece.detail = "not a channel of whole codes";
    } else {
        piece.label = "not used";
        if (piece.detail.empty()) piece.detail = "not among the bits that were offered";
    }
    return piece;
}

std::string detail_of(const ir::Field& field)
{
    return fmt::format("{} {}, {}, carries [{:g}, {:g}]", field.is_signed ? "snorm" : "unorm",
                       field.bits, describe(field.code, field.bits), field.range.low,
                       field.range.high);
}

/// A field over several slots says which bits of its code are where.
std::string label_of(const Packed& packed, const ir::Field& field, std::size_t slot)
{
    std::string name = field_name(*packed.module, field);
    if (field.slots.size() == 1) return name;
    int low = field.bits;
    for (std::size_t i = 0; i <= slot; ++i) low -= field.slots[i].bits;
    const int high = low + field.slots[slot].bits - 1;
    return high == low ? fmt::format("{} bit {}", name, low)
                       : fmt::format("{} bits {}-{}", name, low, high);
}

ChannelLayout channel_layout(const Packed& packed, std::size_t index, std::size_t shown)
{
    const ir::Channel& channel = packed.gbuffer().channels[index];
    ChannelLayout out{index, channel.formats[shown], {}};
    const Bits bits = bits_of(packed, index, out.format.bits);
    for (int bit = out.format.bits - 1; bit >= 0;) {
        const auto at = static_cast<std::size_t>(bit);
        int low = bit;
        const auto same = [&](std::size_t other) {
            return bits.field[other] == bits.field[at] && bits.room[other] == bits.room[at] &&
                   bits.slot[other] == bits.slot[at];
        };
        while (low > 0 && same(static_cast<std::size_t>(low - 1))) --low;
        Piece piece;
        if (bits.field[at] == nobody) {
            piece = unused(packed, channel, shown, bits.room[at]);
        } else {
            piece.holds = Piece::Holds::field;
            piece.field = static_cast<std::size_t>(bits.field[at]);
            const ir::Field& field = packed.packing->fields[piece.field];
            piece.label = label_of(packed, field, static_cast<std::size_t>(bits.slot[at]));
            piece.detail = join(detail_of(field), remarks(channel, packed.packing->supported));
        }
        piece.low = low;
        piece.bits = bit - low + 1;
        out.pieces.push_back(std::move(piece));
        bit = low - 1;
    }
    return out;
}

/// One character, so that it fits a single bit. There are fewer bits in a gbuffer's free channels
/// than keys in all but made-up cases, which share the last.
std::string key(std::size_t index)
{
    constexpr std::string_view keys =
        "123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    return std::string(1, keys[std::min(index, keys.size() - 1)]);
}

bool joins_words(char c) { return c == '_' || c == ' '; }

/// The words of a name with what joins them: `diffuse_`, `fresnel`.
std::vector<std::string> words_of(std::string_view name)
{
    std::vector<std::string> words{""};
    for (const char c : name) {
        words.back() += c;
        if (joins_words(c)) words.emplace_back();
    }
    return words;
}

}  // namespace

bool ChannelLayout::is_open() const
{
    return std::ranges::any_of(pieces, [](const Piece& piece) {
        return piece.holds == Piece::Holds::field || piece.holds == Piece::Holds::nothing;
    });
}

Layout layout_of(const Packed& packed)
{
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    Layout out;
    out.configuration = nearest_to_default(gbuffer, packed.packing->supported)
                            .value_or(gbuffer.default_configuration());
    for (std::size_t i = 0; i < gbuffer.targets.size(); ++i) out.targets.push_back({i, {}});
    for (std::size_t i = 0; i < gbuffer.channels.size(); ++i) {
        ChannelLayout channel = channel_layout(packed, i, out.configuration);
        for (const Piece& piece : channel.pieces) {
            if (piece.holds == Piece::Holds::field || piece.holds == Piece::Holds::nothing)
                out.bits += piece.bits;
            if (piece.holds == Piece::Holds::nothing)
                out.left.push_back({i, piece.low, piece.bits});
        }
        out.targets[gbuffer.channels[i].target].channels.push_back(std::move(channel));
    }
    return out;
}

std::vector<std::string> on_lines(std::string_view name, int width, int most)
{
    // Below this a line holds too little of a word to be read.
    constexpr int least_width = 7;
    if (length(name) <= width) return {std::string{name}};
    if (width < least_width) return {};

    const auto fits = [&](const std::string& text) {
        // What joins words may fall off the end of a line: the break says the same.
        return length(text) - (!text.empty() && joins_words(text.back()) ? 1 : 0) <= width;
    };
    std::vector<std::string> lines{""};
    const auto add = [&](const std::string& word) {
        if (fits(lines.back() + word))
            lines.back() += word;
        else
            lines.push_back(word);
    };
    for (const std::string& word : words_of(name)) {
        if (fits(word)) {
            add(word);
            continue;
        }
        // In equal parts, each but the last with a hyphen.
        const std::size_t room = static_cast<std::size_t>(width) - 1;
        const std::size_t parts = (word.size() + room - 1) / room;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = word.size() * part / parts;
            const std::size_t end = word.size() * (part + 1) / parts;
            add(word.substr(begin, end - begin) + (part + 1 < parts ? "-" : ""));
        }
    }
    if (lines.front().empty()) lines.erase(lines.begin());
    if (static_cast<int>(lines.size()) > most) return {};
    for (std::string& line : lines)
        if (line.ends_with(' ') || length(line) > width) line.pop_back();
    return lines;
}

std::string Legend::key_of(const std::string& label)
{
    auto at = std::ranges::find(labels_, label);
    if (at == labels_.end()) at = labels_.insert(labels_.end(), label);
    return key(static_cast<std::size_t>(at - labels_.begin()));
}

std::vector<std::string> Legend::lines() const
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < labels_.size(); ++i) out.push_back(key(i) + " " + labels_[i]);
    return out;
}

std::string describe(const ir::Gbuffer& gbuffer, const ir::Slot& slot, int channel_bits)
{
    const std::string name = gbuffer.name_of(gbuffer.channels[slot.channel]);
    if (slot.low == 0 && slot.bits == channel_bits) return name;
    if (slot.bits == 1) return fmt::format("{}[{}]", name, slot.low);
    return fmt::format("{}[{}..{}]", name, slot.low, slot.low + slot.bits - 1);
}

std::string slots_of(const Packed& packed, const ir::Field& field)
{
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    const std::size_t shown = nearest_to_default(gbuffer, packed.packing->supported)
                                  .value_or(gbuffer.default_configuration());
    std::string out;
    for (const ir::Slot& slot : field.slots)
        out += (out.empty() ? "" : ", ") +
               describe(gbuffer, slot, gbuffer.channels[slot.channel].formats[shown].bits);
    return out;
}

std::string room_left(const Packed& packed)
{
    const Layout layout = layout_of(packed);
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    int left = 0;
    std::string places;
    for (const ir::Slot& slot : layout.left) {
        left += slot.bits;
        const int bits = gbuffer.channels[slot.channel].formats[layout.configuration].bits;
        places += (places.empty() ? ": " : ", ") + describe(gbuffer, slot, bits);
    }
    return fmt::format("{} of {} free bits left{}", left == 0 ? "none" : std::to_string(left),
                       layout.bits, places);
}

}  // namespace lobe::report
