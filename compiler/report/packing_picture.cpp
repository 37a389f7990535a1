// The layout for a terminal, in ASCII: a row of boxes per target, two columns a bit.
//
//    r unorm 8       g unorm 8
//    7 6 5 4 3 2 1 0 7 6 5 4 3 2 1 0
//   +---------------+-------+-------+
//   |    metalness  | tint  | free  |
//   +---------------+-------+-------+
//
// Channels that are the engine's alone are drawn as 8 bits wide, without numbers; neighbors with
// the same content share a box.
#include "report/packing_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

constexpr int default_width = 80;
constexpr int margin = 2;
constexpr int most_lines = 5;     ///< of a label
constexpr int closed_width = 15;  ///< of a channel that is not drawn by bits

int columns_of(int bits) { return 2 * bits - 1; }

struct Box {
    int width = 0;
    std::vector<std::string> lines;
    Style style = Style::plain;
};

/// One channel as drawn: what stands above its boxes, and the boxes.
struct Drawn {
    std::string title;
    std::string ruler;
    std::vector<Box> boxes;

    int width() const
    {
        int sum = static_cast<int>(boxes.size()) - 1;
        for (const Box& box : boxes) sum += box.width;
        return sum;
    }
};

Style style_of(Piece::Holds holds)
{
    switch (holds) {
    case Piece::Holds::field: return Style::strong;
    case Piece::Holds::nothing: return Style::good;
    case Piece::Holds::engine:
    case Piece::Holds::closed: return Style::faint;
    }
    return Style::plain;
}

/// The number of every bit above its column; only of the ends of pieces where numbers have two
/// digits.
std::string ruler(const ChannelLayout& channel)
{
    const int bits = channel.format.bits;
    std::string out(static_cast<std::size_t>(columns_of(bits)), ' ');
    const auto put = [&](int bit) {
        const std::string number = std::to_string(bit);
        const auto at = static_cast<std::size_t>(2 * (bits - 1 - bit));
        if (number.size() == 1) {
            out[at] = number[0];
        } else if (at + 1 < out.size() && (at == 0 || out[at - 1] == ' ')) {
            out[at] = number[0];
            out[at + 1] = number[1];
        }
    };
    for (const Piece& piece : channel.pieces) {
        const int high = piece.low + piece.bits - 1;
        if (bits > 10) {
            put(high);
            if (piece.bits > 2) put(piece.low);
            continue;
        }
        for (int bit = high; bit >= piece.low; --bit) put(bit);
    }
    return out;
}

Box box_of(const Piece& piece, int width, Legend& legend)
{
    Box box{width, on_lines(piece.label, width, most_lines), style_of(piece.holds)};
    if (!box.lines.empty()) return box;
    const bool is_free = piece.holds == Piece::Holds::nothing;
    box.lines = {is_free ? "." : legend.key_of(piece.label)};
    return box;
}

Drawn draw(const Packed& packed, const ChannelLayout& channel, Legend& legend)
{
    Drawn out;
    out.title = fmt::format("{} {}", packed.gbuffer().channels[channel.channel].name,
                            describe(channel.format));
    if (!channel.is_open()) {
        out.boxes.push_back(box_of(channel.pieces.front(), closed_width, legend));
        return out;
    }
    out.ruler = ruler(channel);
    for (const Piece& piece : channel.pieces)
        out.boxes.push_back(box_of(piece, columns_of(piece.bits), legend));
    return out;
}

void append_centered(std::string& line, const std::string& text, const Box& box, bool color)
{
    const int space = box.width - length(text);
    const int before = space / 2;
    line.append(static_cast<std::size_t>(before), ' ');
    line += styled(text, box.style, color);
    line.append(static_cast<std::size_t>(space - before), ' ');
}

std::string without_trailing_space(std::string line)
{
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

std::string draw_row(const std::vector<Drawn>& channels, bool color)
{
    std::vector<Box> boxes;
    for (const Drawn& channel : channels)
        boxes.insert(boxes.end(), channel.boxes.begin(), channel.boxes.end());
    for (std::size_t i = boxes.size() - 1; i > 0; --i)
        if (boxes[i].style == Style::faint && boxes[i].lines == boxes[i - 1].lines &&
            boxes[i - 1].style == Style::faint) {
            // One wide box, which starts where the first one did.
            boxes[i - 1].width += boxes[i].width + 1;
            boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
        }

    const std::string indent(margin, ' ');
    std::string titles = indent, rulers = indent, border = indent;
    bool numbered = false;
    for (const Drawn& channel : channels) {
        titles += fmt::format(" {:<{}}", channel.title, channel.width());
        rulers += fmt::format(" {:<{}}", channel.ruler, channel.width());
        numbered |= !channel.ruler.empty();
    }
    std::size_t height = 0;
    for (const Box& box : boxes) {
        border += "+" + std::string(static_cast<std::size_t>(box.width), '-');
        height = std::max(height, box.lines.size());
    }
    border += "+\n";

    std::string out = without_trailing_space(titles);
    if (numbered) out += without_trailing_space(rulers);
    out += border;
    for (std::size_t row = 0; row < height; ++row) {
        std::string line = indent;
        for (const Box& box : boxes) {
            // Short labels stand in the middle.
            const std::size_t above = (height - box.lines.size()) / 2;
            const bool is_text = row >= above && row - above < box.lines.size();
            line += "|";
            append_centered(line, is_text ? box.lines[row - above] : "", box, color);
        }
        out += line + "|\n";
    }
    return out + border;
}

}  // namespace

std::string layout_picture(const Packed& packed, const Look& look)
{
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    const Layout layout = layout_of(packed);
    const int width = look.width > 0 ? look.width : default_width;

    std::string out;
    Legend legend;
    for (const TargetLayout& target : layout.targets) {
        if (target.channels.empty()) continue;
        const ir::RenderTarget& about = gbuffer.targets[target.target];
        out += styled(about.name, Style::strong, look.color) + "  " + about.label + "\n";
        std::vector<Drawn> row;
        int used = margin + 1;
        for (const ChannelLayout& channel : target.channels) {
            Drawn drawn = draw(packed, channel, legend);
            if (!row.empty() && used + drawn.width() + 1 > width) {
                out += draw_row(row, look.color);
                row.clear();
                used = margin + 1;
            }
            used += drawn.width() + 1;
            row.push_back(std::move(drawn));
        }
        out += draw_row(row, look.color);
    }
    for (const std::string& line : legend.lines()) out += "  " + line + "\n";
    return out + folded(room_left(packed), margin, look);
}

}  // namespace lobe::report
