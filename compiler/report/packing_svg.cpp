// The layout as SVG: the same rows of boxes as in the terminal, one color per field, with what
// there is to say about a box in its tooltip.
#include "report/packing_svg.h"

#include "emit/template.h"
#include "report/markup.h"
#include "report/packing_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

// In pixels. A bit is wide enough for two letters, a box for four lines.
constexpr double gutter = 92;
constexpr double bit_width = 26;
constexpr double letter_width = 6.7;
constexpr double line_height = 13;
constexpr double box_height = 4 * line_height + 4;
constexpr double target_gap = 14;
constexpr int closed_bits = 8;
constexpr int row_bits = 32;

class Drawing {
public:
    explicit Drawing(const Packed& packed) : packed_(packed), layout_(layout_of(packed)) {}

    SvgBody draw()
    {
        for (const TargetLayout& target : layout_.targets)
            if (!target.channels.empty()) draw_target(target);
        for (const std::string& line : legend_.lines()) {
            top_ += line_height + 2;
            out_ += fmt::format("<text x=\"{}\" y=\"{:.0f}\">{}</text>\n", gutter, top_,
                                escaped_xml(line));
        }
        top_ += line_height + 6;
        out_ += fmt::format("<text x=\"{}\" y=\"{:.0f}\">{}</text>\n", gutter, top_,
                            escaped_xml(room_left(packed_)));
        return {std::move(out_), gutter + row_bits * bit_width + 1, top_ + 8};
    }

private:
    void draw_target(const TargetLayout& target)
    {
        const ir::RenderTarget& about = packed_.gbuffer().targets[target.target];
        const bool numbered =
            std::ranges::any_of(target.channels, [](const auto& c) { return c.is_open(); });
        const double head = line_height + (numbered ? line_height - 2 : 0) + 2;
        out_ += fmt::format("<text class=\"name\" y=\"{:.0f}\">{}</text>"
                            "<text class=\"soft\" y=\"{:.0f}\">{}</text>\n",
                            top_ + head + 16, escaped_xml(about.name), top_ + head + 32,
                            escaped_xml(about.label));
        int used = 0;
        for (const ChannelLayout& channel : target.channels) {
            const int bits = channel.is_open() ? channel.format.bits : closed_bits;
            if (used > 0 && used + bits > row_bits) {
                top_ += head + box_height + 6;
                used = 0;
            }
            draw_channel(channel, gutter + used * bit_width, head);
            used += bits;
        }
        top_ += head + box_height + target_gap;
    }

    void draw_channel(const ChannelLayout& channel, double left, double head)
    {
        const ir::Channel& about = packed_.gbuffer().channels[channel.channel];
        const int bits = channel.is_open() ? channel.format.bits : closed_bits;
        std::string title =
            fmt::format("{} {}, {}", about.name, describe(channel.format), about.label);
        const auto letters = static_cast<std::size_t>((bits * bit_width - 6) / letter_width);
        if (title.size() > letters) title = title.substr(0, letters - 2) + "..";
        out_ += fmt::format("<text class=\"soft\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n", left + 3,
                            top_ + line_height - 3, escaped_xml(title));
        if (!channel.is_open()) {
            draw_piece(channel.pieces.front(), left, closed_bits, head);
            return;
        }
        for (const Piece& piece : channel.pieces) {
            const int high = piece.low + piece.bits - 1;
            const double at = left + (channel.format.bits - 1 - high) * bit_width;
            for (int bit = high; bit >= piece.low; --bit)
                out_ += fmt::format("<text class=\"bit\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>",
                                    at + (high - bit + 0.5) * bit_width, top_ + head - 4, bit);
            out_ += "\n";
            draw_piece(piece, at, piece.bits, head);
        }
    }

    /// One per parameter, in the order of the fields, so that neighbors differ.
    std::size_t hue_of(std::size_t field) const
    {
        constexpr std::size_t hues = 8;
        const std::vector<ir::Field>& fields = packed_.packing->fields;
        std::vector<std::uint32_t> parameters;
        for (std::size_t i = 0; i <= field; ++i)
            if (std::ranges::find(parameters, fields[i].parameter) == parameters.end())
                parameters.push_back(fields[i].parameter);
        const auto at = std::ranges::find(parameters, fields[field].parameter);
        return static_cast<std::size_t>(at - parameters.begin()) % hues;
    }

    std::string box_class(const Piece& piece) const
    {
        switch (piece.holds) {
        case Piece::Holds::field: return fmt::format("field c{}", hue_of(piece.field));
        case Piece::Holds::nothing: return "free";
        case Piece::Holds::engine:
        case Piece::Holds::closed: return "closed";
        }
        return {};
    }

    void draw_piece(const Piece& piece, double left, int bits, double head)
    {
        const double width = bits * bit_width, top = top_ + head;
        std::string title = piece.label;
        if (!piece.detail.empty()) title += ": " + piece.detail;
        out_ += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.0f}\" "
                            "height=\"{:.0f}\"><title>{}</title></rect>\n",
                            box_class(piece), left + 0.5, top + 0.5, width, box_height,
                            escaped_xml(title));
        std::vector<std::string> lines =
            on_lines(piece.label, static_cast<int>((width - 6) / letter_width), 4);
        // A free bit shows by its frame, even where the word has no room.
        if (lines.empty() && piece.holds != Piece::Holds::nothing)
            lines = {legend_.key_of(piece.label)};
        double y =
            top + box_height / 2 - line_height * (static_cast<double>(lines.size()) / 2 - 0.8);
        const bool is_soft =
            piece.holds == Piece::Holds::engine || piece.holds == Piece::Holds::closed;
        for (const std::string& line : lines) {
            out_ += fmt::format("<text class=\"in{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                                is_soft ? " soft" : "", left + width / 2, y, escaped_xml(line));
            y += line_height;
        }
    }

    const Packed& packed_;
    Layout layout_;
    Legend legend_;
    double top_ = 0;
    std::string out_;
};

}  // namespace

std::string title_of(const Packed& packed)
{
    return fmt::format("{} on {}{}", packed.packing->model.name, packed.packing->gbuffer,
                       packed.suggestion != nullptr ? ", suggested" : "");
}

SvgBody layout_body(const Packed& packed) { return Drawing{packed}.draw(); }

std::string to_svg(std::span<const Packed> packings)
{
    constexpr double margin = 20, title = 24, gap = 30;
    emit::Record record;
    double top = margin, width = 0;
    std::vector<emit::Record>& records = record.lists["packings"];
    for (const Packed& packed : packings) {
        SvgBody body = layout_body(packed);
        emit::Record& one = records.emplace_back();
        one.texts["top"] = fmt::format("{:.0f}", top);
        one.texts["title"] = escaped_xml(title_of(packed));
        one.texts["body"] = std::move(body.text);
        top += title + body.height + gap;
        width = std::max(width, body.width);
    }
    record.texts["width"] = fmt::format("{:.0f}", width + 2 * margin);
    record.texts["height"] = fmt::format("{:.0f}", top - gap + margin);
    return emit::render_embedded("report/packing.svg", record).text;
}

}  // namespace lobe::report
