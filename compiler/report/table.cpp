#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

constexpr std::string_view gap = "  ";
constexpr int least_last_column = 12;  ///< below this a column says nothing

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// The first `width` characters; the last of them a dot-dot when something was left out.
std::string cut(std::string_view text, int width)
{
    if (length(text) <= width) return std::string{text};
    std::size_t end = 0;
    for (int taken = 0; end < text.size(); ++end) {
        if (!continues_character(text[end]) && taken++ == width - 2) break;
    }
    return std::string{text.substr(0, end)} + "..";
}

std::string_view code(Style style)
{
    switch (style) {
    case Style::plain: return "";
    case Style::strong: return "\x1b[1m";
    case Style::good: return "\x1b[32m";
    case Style::bad: return "\x1b[1;31m";
    case Style::faint: return "\x1b[2m";
    }
    return "";
}

}  // namespace

int length(std::string_view text)
{
    return static_cast<int>(
        std::ranges::count_if(text, [](char c) { return !continues_character(c); }));
}

std::string styled(std::string_view text, Style style, bool color)
{
    if (!color || style == Style::plain || text.empty()) return std::string{text};
    return fmt::format("{}{}\x1b[0m", code(style), text);
}

std::string grouped(std::uint64_t number)
{
    std::string digits = fmt::format("{}", number);
    for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

std::string render(const Table& table, const Look& look)
{
    std::vector<int> widths;
    for (const Column& column : table.columns) widths.push_back(length(column.title));
    for (const auto& row : table.rows)
        for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i)
            widths[i] = std::max(widths[i], length(row[i].text));
    if (look.width > 0 && !widths.empty()) {
        int others = 0;
        for (std::size_t i = 0; i + 1 < widths.size(); ++i)
            others += widths[i] + static_cast<int>(gap.size());
        widths.back() = std::min(widths.back(), std::max(least_last_column, look.width - others));
    }

    std::string out;
    const auto write_line = [&](const std::vector<Cell>& cells) {
        std::string line;
        int pending = 0;  // spaces that are written only if more text follows
        for (std::size_t i = 0; i < widths.size(); ++i) {
            const Cell empty;
            const Cell& cell = i < cells.size() ? cells[i] : empty;
            const std::string text = cut(cell.text, widths[i]);
            const int padding = widths[i] - length(text);
            if (table.columns[i].numeric) pending += padding;
            if (!text.empty()) {
                line.append(static_cast<std::size_t>(pending), ' ');
                line += styled(text, cell.style, look.color);
                pending = 0;
            }
            if (!table.columns[i].numeric) pending += padding;
            pending += static_cast<int>(gap.size());
        }
        out += line + "\n";
    };
    std::vector<Cell> titles;
    for (const Column& column : table.columns) titles.push_back({column.title, Style::strong});
    write_line(titles);
    for (const auto& row : table.rows) write_line(row);
    return out;
}

}  // namespace lobe::report
