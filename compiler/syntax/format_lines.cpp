#include "syntax/format_lines.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::syntax {
namespace {

constexpr std::size_t widest_line = ExpressionWriter::widest_line;

/// Whether an empty line stands before the line or among its comments.
bool stands_apart(const Line& line)
{
    return line.blank_before ||
           std::any_of(line.comments->begin(), line.comments->end(),
                       [](const Comment& comment) { return comment.blank_before; });
}

}  // namespace

Cell list(std::string_view first, const std::vector<std::string>& items)
{
    Cell result;
    for (std::size_t i = 0; i < items.size(); ++i)
        result.push_back({fmt::format("{}{}{}", i == 0 ? first : "", items[i],
                                      i + 1 < items.size() ? "," : "")});
    return result;
}

Cell list(std::string_view first, const std::vector<Identifier>& names)
{
    std::vector<std::string> items;
    for (const Identifier& name : names) items.push_back(name.text);
    return list(first, items);
}

// ---- lines

void LineWriter::blank_line()
{
    if (out_.empty() || out_.ends_with("\n\n") || out_.ends_with("{\n")) return;
    out_ += '\n';
}

void LineWriter::end_line(const std::vector<Comment>& trailing)
{
    for (const Comment& comment : trailing) out_ += fmt::format("  {}", slashes(comment));
    if (!out_.ends_with('\n')) out_ += '\n';
}

void LineWriter::write_comments(const std::vector<Comment>& comments, std::size_t columns)
{
    for (const Comment& comment : comments) {
        if (comment.blank_before) blank_line();
        indent(columns);
        out_ += fmt::format("{}\n", slashes(comment));
    }
}

std::size_t LineWriter::column() const
{
    const std::size_t line = out_.rfind('\n') + 1;  // npos + 1 is 0
    return character_count(std::string_view{out_}.substr(line));
}

void LineWriter::write_value(ExpressionId value, std::size_t columns)
{
    if (column() + 1 + expressions_.width(value) <= widest_line) {
        out_ += fmt::format(" {}", expressions_.flat(value));
        return;
    }
    if (expressions_.is_block(value)) {
        out_ += ' ';
        out_ += expressions_.broken(value, column(), columns);
        return;
    }
    out_ += '\n';
    indent(columns + step);
    out_ += expressions_.broken(value, columns + step, columns + step);
}

// ---- rows

std::string LineWriter::flat(const Piece& piece) const
{
    if (!piece.value.valid()) return piece.text;
    const std::string value = expressions_.flat(piece.value);
    return piece.text + (piece.parentheses ? fmt::format(" ({})", value) : " " + value);
}

std::string LineWriter::flat(const std::vector<Cell>& cells,
                             const std::vector<std::size_t>& widths) const
{
    std::string result;
    std::size_t end = 0;  // where the cell before ends, as aligned
    std::size_t at = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::string text;
        for (const Piece& piece : cells[i]) text += (text.empty() ? "" : " ") + flat(piece);
        if (text.empty()) continue;
        const std::size_t begin = i == 0 ? 0 : std::max(at, end) + 1;
        result.append(begin - at, ' ');
        result += text;
        at = begin + character_count(text);
        end = begin + (i < widths.size() ? widths[i] : 0);
    }
    return result;
}

std::size_t LineWriter::width(const std::vector<Cell>& cells) const
{
    return character_count(flat(cells, {}));
}

/// The widths of the columns of a run; none where a line would be too wide with them.
std::vector<std::size_t> LineWriter::widths(const Line* begin, const Line* end,
                                            std::size_t columns) const
{
    std::vector<std::size_t> result;
    for (const Line* line = begin; line != end; ++line) {
        if (columns + width(line->cells) > widest_line) continue;
        result.resize(std::max(result.size(), line->cells.size()));
        for (std::size_t i = 0; i < line->cells.size(); ++i)
            result[i] = std::max(result[i], width({line->cells[i]}));
    }
    for (const Line* line = begin; line != end; ++line) {
        const bool alone = columns + width(line->cells) <= widest_line;
        const std::size_t aligned = character_count(flat(line->cells, result));
        if (alone && columns + aligned > widest_line) return {};
    }
    return result;
}

void LineWriter::write_lines(const std::vector<Line>& lines, std::size_t columns)
{
    const Line* const end = lines.data() + lines.size();
    for (const Line* begin = lines.data(); begin != end;) {
        const Line* behind = begin + 1;
        while (begin->aligned && behind != end && behind->aligned && !stands_apart(*behind))
            ++behind;
        std::vector<std::size_t> shared;
        if (begin->aligned) shared = widths(begin, behind, columns);
        for (; begin != behind; ++begin) {
            write_comments(*begin->comments, columns);
            if (begin->blank_before) blank_line();
            indent(columns);
            if (columns + width(begin->cells) <= widest_line)
                out_ += flat(begin->cells, shared);
            else
                write_broken(begin->cells, columns);
            end_line(*begin->trailing);
        }
    }
}

void LineWriter::write_broken(const std::vector<Cell>& cells, std::size_t columns)
{
    const std::size_t inner = columns + step;
    std::size_t indented = columns;  // of the line being written
    bool first = true;
    for (const Cell& cell : cells) {
        for (const Piece& piece : cell) {
            const std::string text = flat(piece);
            const std::size_t size = character_count(text);
            // What is broken anyway may as well start here.
            const bool breaks = piece.value.valid() && inner + size > widest_line;
            const bool here =
                breaks ? column() * 2 < widest_line : column() + 1 + size <= widest_line;
            if (!first && here) {
                out_ += ' ';
            } else if (!first) {
                out_ += '\n';
                indent(inner);
                indented = inner;
            }
            first = false;
            if (!breaks) {
                out_ += text;
                continue;
            }
            out_ += piece.text + (piece.parentheses ? " (" : " ");
            out_ += expressions_.broken(piece.value, column(), indented);
            if (piece.parentheses) out_ += ')';
        }
    }
}

// ---- pieces of items

std::string LineWriter::range(const RangeClause& clause) const
{
    return fmt::format("[{}, {}]", expressions_.flat(clause.low), expressions_.flat(clause.high));
}

std::string LineWriter::type(const TypeClause& clause) const
{
    if (!clause.range) return clause.name.text;
    return fmt::format("{} in {}", clause.name.text, range(*clause.range));
}

}  // namespace lobe::syntax
