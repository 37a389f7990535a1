#include "emit/wrap.h"

namespace lobe::emit {
namespace {

constexpr std::size_t page = 100;

bool is_operator(std::string_view line, std::size_t at)
{
    return at + 2 < line.size() &&
           std::string_view{"+-*/?:&|<>="}.find(line[at]) != std::string_view::npos &&
           (line[at + 1] == ' ' || line[at + 2] == ' ');
}

/// Where to break, or npos: the index of the space that the break replaces. The fewest open
/// parentheses win, then the last place; a place in the first half only where there is no other.
/// The first piece of a line is not broken before its first parenthesis or `=`; where it has no
/// other place, it is broken behind the `=`.
std::size_t break_before(std::string_view line, std::size_t room, bool first)
{
    std::size_t best = std::string_view::npos;
    std::size_t assignment = std::string_view::npos;
    int best_depth = 0;
    int depth = 0;
    bool inside = !first;
    for (std::size_t i = 0; i < line.size() && i <= room; ++i) {
        const char c = line[i];
        if (c == '(') ++depth;
        if (c == ')') --depth;
        if (c != ' ' || i == 0) {
            inside = inside || c == '(' || c == '=';
            continue;
        }
        if (first && depth == 0 && i >= 2 && line.substr(i - 2, 2) == " =") assignment = i;
        if (!inside || (line[i - 1] != ',' && !is_operator(line, i + 1))) continue;
        const bool early = best != std::string_view::npos && best < room / 2;
        if (best == std::string_view::npos || depth <= best_depth || early) {
            best = i;
            best_depth = depth;
        }
    }
    return best != std::string_view::npos ? best : assignment;
}

/// The index of the next blank or line end, or npos. (find_first_of searches its set per letter.)
std::size_t word_end(std::string_view prose, std::size_t from)
{
    for (std::size_t i = from; i < prose.size(); ++i)
        if (prose[i] == ' ' || prose[i] == '\n') return i;
    return std::string_view::npos;
}

}  // namespace

std::string wrap(std::string_view line, std::size_t column, std::string_view indent)
{
    std::string text;
    // A tab takes the room of four columns.
    std::size_t margin = 0;
    for (const char c : indent) margin += c == '\t' ? 4 : 1;

    std::size_t start = column;
    while (start + line.size() > page) {
        const std::size_t at = break_before(line, page - start, start == column);
        if (at == std::string_view::npos) break;
        text += line.substr(0, at);
        text += '\n';
        text += indent;
        line.remove_prefix(at + 1);
        start = column + margin;
    }
    text += line;
    return text;
}

std::vector<std::string> fill(std::string_view prose, std::size_t width)
{
    std::vector<std::string> lines;
    std::string line;
    while (!prose.empty()) {
        auto end = word_end(prose, 0);
        // A range stays whole: `[0, 1]`.
        if (prose.substr(0, end).find('[') != std::string_view::npos) {
            const auto close = prose.find_first_of("])\n");
            if (close != std::string_view::npos && (end == std::string_view::npos || close > end) &&
                close - prose.find('[') < 24)
                end = word_end(prose, close);
        }
        const std::string_view word = prose.substr(0, end);
        prose.remove_prefix(end == std::string_view::npos ? prose.size() : end + 1);
        if (word.empty()) continue;
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            lines.push_back(std::move(line));
            line.clear();
        }
        if (!line.empty()) line += ' ';
        line += word;
    }
    if (!line.empty()) lines.push_back(std::move(line));
    // A backslash at the end would join the next line of code to a comment.
    for (std::string& filled : lines)
        if (filled.ends_with('\\')) filled += '.';
    return lines;
}

std::vector<std::string> paragraphs(std::string_view prose, std::size_t width)
{
    std::vector<std::string> lines;
    while (!prose.empty()) {
        const auto end = prose.find("\n\n");
        const std::vector<std::string> filled = fill(prose.substr(0, end), width);
        if (!lines.empty() && !filled.empty()) lines.emplace_back();
        lines.insert(lines.end(), filled.begin(), filled.end());
        prose.remove_prefix(end == std::string_view::npos ? prose.size() : end + 2);
    }
    return lines;
}

}  // namespace lobe::emit
