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

int width_at(const Character& character, int column)
{
    if (character.code == '\t') return tab_stop - column % tab_stop;
    return is_printable(character) ? display_width(character.code) : 1;
}

}  // namespace

SourceView::SourceView(std::string_view line) : line_(line)
{
    columns_.reserve(line.size() + 1);
    int column = 0;
    for (std::size_t at = 0; at < line.size();) {
        const Character character = first_character(line.substr(at));
        columns_.insert(columns_.end(), character.size, column);
        column += width_at(character, column);
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
    for (std::size_t at = 0; at < line_.size() && columns_[at] < last;) {
        const Character character = first_character(line_.substr(at));
        const int column = columns_[at];
        if (column >= first && character.code == '\t')
            result.append(static_cast<std::size_t>(width_at(character, column)), ' ');
        else if (column >= first)
            result +=
                is_printable(character) ? line_.substr(at, character.size) : replacement_character;
        at += character.size;
    }
    if (last < width()) result += "...";
    return result;
}

}  // namespace lobe
