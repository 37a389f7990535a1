#include "emit/layout.h"

#include "emit/listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lobe::emit {
namespace {

constexpr int cell = 4;  ///< columns of one bit, with the border at its left

/// A field's bits in one channel.
struct Piece {
    std::size_t field = 0;
    ir::Slot slot;
};

class Drawing {
public:
    Drawing(const ir::Module& module, const ir::Packing& packing, const ir::Gbuffer& gbuffer)
        : module_(module), packing_(packing), gbuffer_(gbuffer)
    {
        for (std::size_t field = 0; field < packing.fields.size(); ++field)
            for (const ir::Slot& slot : packing.fields[field].slots)
                pieces_.push_back({field, slot});
        for (const std::size_t channel : drawn_channels())
            label_width_ =
                std::max(label_width_, gbuffer_.name_of(gbuffer_.channels[channel]).size());
        for (const ir::RenderTarget& target : gbuffer_.targets)
            label_width_ = std::max(label_width_, target.label.size());
    }

    std::vector<std::string> draw()
    {
        for (std::size_t target = 0; target < gbuffer_.targets.size(); ++target)
            draw_target(target);
        draw_fields();
        return std::move(lines_);
    }

private:
    int bits_of(std::size_t channel) const
    {
        return ir::channel_bits(packing_, gbuffer_.channels[channel]);
    }

    /// Packed ones, and free ones beside them.
    std::vector<std::size_t> drawn_channels() const
    {
        std::set<std::size_t> targets;
        std::set<std::size_t> packed;
        for (const Piece& piece : pieces_) {
            packed.insert(piece.slot.channel);
            targets.insert(gbuffer_.channels[piece.slot.channel].target);
        }
        std::vector<std::size_t> result;
        for (std::size_t i = 0; i < gbuffer_.channels.size(); ++i) {
            const ir::Channel& channel = gbuffer_.channels[i];
            if (packed.contains(i) || (targets.contains(channel.target) && channel.holders.empty()))
                result.push_back(i);
        }
        return result;
    }

    void line(std::string text)
    {
        text.erase(text.find_last_not_of(' ') + 1);
        lines_.push_back(std::move(text));
    }

    void draw_target(std::size_t target)
    {
        std::vector<std::size_t> channels = drawn_channels();
        std::erase_if(channels, [&](std::size_t channel) {
            return gbuffer_.channels[channel].target != target;
        });
        if (channels.empty()) return;

        int most = 0;
        for (const std::size_t channel : channels) most = std::max(most, bits_of(channel));
        std::string numbers;
        for (int bit = most; bit-- > 0;) numbers += fmt::format(" {:>2} ", bit);
        line(fmt::format("{:<{}} {}", gbuffer_.targets[target].label, label_width_, numbers));

        std::string above(static_cast<std::size_t>(most * cell + 1), ' ');
        for (const std::size_t channel : channels) {
            const std::string row = box(channel, most);
            line(fmt::format("{:<{}} {}", "", label_width_, border(above, row)));
            const ir::Channel& known = gbuffer_.channels[channel];
            line(fmt::format("{:<{}} {}  {}", gbuffer_.name_of(known), label_width_, row,
                             known.label));
            above = row;
        }
        const std::string below(above.size(), ' ');
        line(fmt::format("{:<{}} {}", "", label_width_, border(above, below)));
        lines_.emplace_back();
    }

    /// `| 1 diffuse_fresnel               |`
    std::string box(std::size_t channel, int most) const
    {
        std::string row(static_cast<std::size_t>(most * cell + 1), ' ');
        const auto column = [most](int bit) {
            return static_cast<std::size_t>((most - bit) * cell);
        };
        row[column(bits_of(channel))] = '|';
        row[column(0)] = '|';
        for (const Piece& piece : pieces_) {
            if (piece.slot.channel != channel) continue;
            const std::size_t left = column(piece.slot.low + piece.slot.bits);
            const std::size_t right = column(piece.slot.low);
            row[left] = '|';
            row[right] = '|';
            const std::size_t room = right - left - 2;
            std::string text = std::to_string(piece.field + 1);
            const std::string name = ir::field_name(module_, packing_.fields[piece.field]);
            if (text.size() + 1 + name.size() < room) text += " " + name;
            row.replace(left + (text.size() < room ? 2 : 1), text.size(), text);
        }
        return row;
    }

    /// The line between two rows of boxes: closed where either has one.
    static std::string border(const std::string& above, const std::string& below)
    {
        const auto inside = [](const std::string& row, std::size_t at) {
            const auto first = row.find('|');
            return first != std::string::npos && first <= at && at <= row.rfind('|');
        };
        std::string result(above.size(), ' ');
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (!inside(above, i) && !inside(below, i)) continue;
            result[i] = above[i] == '|' || below[i] == '|' ? '+' : '-';
        }
        return result;
    }

    void draw_fields()
    {
        std::vector<std::array<std::string, 5>> rows{{"", "field", "bits", "code", "carries"}};
        for (std::size_t i = 0; i < packing_.fields.size(); ++i) {
            const ir::Field& field = packing_.fields[i];
            std::string slots;
            for (const ir::Slot& slot : field.slots)
                slots += (slots.empty() ? "" : ", ") + slot_text(gbuffer_, packing_, slot);
            rows.push_back({std::to_string(i + 1), ir::field_name(module_, field), slots,
                            fmt::format("{} {} {}", field.is_signed ? "snorm" : "unorm", field.bits,
                                        ir::describe(field.code, field.bits)),
                            range_text(field.range)});
        }
        std::array<std::size_t, 5> widths{};
        for (const auto& row : rows)
            for (std::size_t i = 0; i < row.size(); ++i)
                widths[i] = std::max(widths[i], row[i].size());
        for (const auto& row : rows)
            line(fmt::format("{:>{}} {:<{}}  {:<{}}  {:<{}}  {}", row[0], widths[0], row[1],
                             widths[1], row[2], widths[2], row[3], widths[3], row[4]));
    }

    const ir::Module& module_;
    const ir::Packing& packing_;
    const ir::Gbuffer& gbuffer_;
    std::vector<Piece> pieces_;
    std::size_t label_width_ = 0;
    std::vector<std::string> lines_;
};

}  // namespace

std::string slot_text(const ir::Gbuffer& gbuffer, const ir::Packing& packing, const ir::Slot& slot)
{
    const std::string name = gbuffer.name_of(gbuffer.channels[slot.channel]);
    if (slot.bits == ir::channel_bits(packing, gbuffer.channels[slot.channel])) return name;
    if (slot.bits == 1) return fmt::format("{}[{}]", name, slot.low);
    return fmt::format("{}[{}..{}]", name, slot.low, slot.low + slot.bits - 1);
}

std::vector<std::string> draw_layout(const ir::Module& module, const ir::Packing& packing)
{
    const ir::Gbuffer* gbuffer = module.find_gbuffer(packing.gbuffer);
    if (gbuffer == nullptr) return {};
    return Drawing{module, packing, *gbuffer}.draw();
}

}  // namespace lobe::emit
