#include "base/source_view.h"

#include "base/utf8.h"

#include <algorithm>

namespace lobe {
namespace {

constexpr int tab_stop = 4;
constexpr std::string_view replacement_character = "\xEF\xBF\xBD";

bool is_printable(const Character& character)
{
    const bool control = character.code < 0x20 || (character.code >= 0x7F && character.code < 0xA0);
    return character.valid && !control && !changes_text_direction(character.code);
}

}  // namespace

SourceView::SourceView(std::string_view line)
{
    int column = 0;
    for (std::size_t at = 0; at < line.size();) {
        const Character character = first_character(line.substr(at));
        Cell cell{column, std::string{line.substr(at, character.size)}};
        int width = 1;
        if (character.code == '\t') {
            width = tab_stop - column % tab_stop;
            cell.text.assign(static_cast<std::size_t>(width), ' ');
        } else if (is_printable(character)) {
            width = display_width(character.code);
        } else {
            cell.text = replacement_character;
        }
        cells_.push_back(std::move(cell));
        columns_.insert(columns_.end(), character.size, column);
        column += width;
        at += character.size;
    }
    columns_.push_back(column);
}

int SourceView::column(std::size_t byte) const
{
    return columns_[std::min(byte, columns_.size() - 1)];
}

std::string SourceView::window(int first, int last) const
{
    std::string result;
    if (first > 0) result += "...";
    for (const Cell& cell : cells_)
        if (cell.column >= first && cell.column < last) result += cell.text;
    if (last < width()) result += "...";
    return result;
}

}  // namespace lobe
