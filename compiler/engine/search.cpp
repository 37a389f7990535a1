#include "engine/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace lobe::engine {
namespace {

Obstacle obstacle_in(const Searched& file, std::size_t line, const std::string& pattern,
                     std::string what, std::string help)
{
    return {file.path,
            line == file.lines.lines.size() ? 0 : file.shown_line(line),
            {},
            pattern,
            std::move(what),
            std::move(help)};
}

}  // namespace

std::size_t Searched::line_at(std::size_t offset) const
{
    const auto behind = std::ranges::upper_bound(starts, offset);
    return static_cast<std::size_t>(behind - starts.begin()) - 1;
}

int Searched::shown_line(std::size_t line) const
{
    return line < origins.size() ? static_cast<int>(origins[line]) + 1 : 0;
}

std::string_view Searched::at(Stretch where) const
{
    return std::string_view{text}.substr(where.begin, where.end - where.begin);
}

Searched make_searched(std::string path, Lines lines, std::vector<std::size_t> origins,
                       std::vector<bool> marks)
{
    Searched result{
        std::move(path), std::move(lines), std::move(origins), std::move(marks), {}, {}, {}};
    std::size_t size = 0;
    for (const Line& line : result.lines.lines) size += line.text.size() + 1;
    result.text.reserve(size);
    result.starts.reserve(result.lines.lines.size());
    for (std::size_t i = 0; i < result.lines.lines.size(); ++i) {
        const Line& line = result.lines.lines[i];
        result.starts.push_back(result.text.size());
        if (result.marks[i])
            result.text.append(line.text.size(), ' ');
        else
            result.text += line.text;
        if (line.end != LineEnd::none) result.text += '\n';
    }
    result.parts = parts_of(result.text);
    return result;
}

Search search(const Searched& file, const Anchor& anchor, const ValueOf& value_of)
{
    Search result;
    result.where = {0, file.text.size()};
    const auto fail = [&](std::size_t line, const std::string& pattern, std::string what,
                          std::string help) {
        result.obstacle = obstacle_in(file, line, pattern, std::move(what), std::move(help));
        return result;
    };
    const std::size_t nowhere = file.lines.lines.size();

    if (!anchor.scope.empty()) {
        const Substituted scope = substitute_quoted(anchor.scope, value_of);
        if (!scope.error.empty())
            return fail(nowhere, anchor.scope, fmt::format("the scope has {}", scope.error),
                        "give that value, or change the list");
        std::vector<Hit> definitions;
        std::vector<Stretch> stretches;
        const Pattern pattern{scope.text};
        for (Hit& hit : pattern.find_all(file.text, file.parts, result.where)) {
            const std::size_t first = lines_of(file, *hit[0]).first;
            const auto end = end_of_definition(file.text, file.parts,
                                               std::max(hit[0]->begin, file.starts[first]));
            if (!end) continue;
            stretches.push_back({file.starts[first], *end});
            definitions.push_back(std::move(hit));
        }
        result.is_absent = definitions.empty();
        if (definitions.empty())
            return fail(nowhere, scope.text, "the definition that the edit looks in is not there",
                        "look for it under another name, and change the `scope` in the list");
        if (definitions.size() > 1)
            return fail(file.line_at(stretches[0].begin), scope.text,
                        fmt::format("{} definitions fit the `scope`, in lines {}",
                                    definitions.size(), shown_lines(file, definitions)),
                        "narrow the `scope` in the list down to one of them");
        result.where = stretches[0];
    }

    const Substituted pattern = substitute_quoted(anchor.pattern, value_of);
    if (!pattern.error.empty())
        return fail(nowhere, anchor.pattern, fmt::format("the anchor has {}", pattern.error),
                    "give that value, or change the list");
    result.hits = Pattern{pattern.text}.find_all(file.text, file.parts, result.where);
    return result;
}

LineRange lines_of(const Searched& file, Stretch hit)
{
    constexpr std::string_view blanks = " \t\r\n\f\v";
    const std::string_view matched = file.at(hit);
    const auto first = matched.find_first_not_of(blanks);
    if (first == std::string_view::npos) {
        const std::size_t line = file.line_at(hit.begin);
        return {line, line};
    }
    return {file.line_at(hit.begin + first),
            file.line_at(hit.begin + matched.find_last_not_of(blanks))};
}

std::string shown_hits(const Searched& file, const std::vector<Hit>& hits)
{
    const std::string lines = shown_lines(file, hits);
    return hits.size() == 1 ? fmt::format("once, in line {}", lines)
                            : fmt::format("{} times, in lines {}", hits.size(), lines);
}

std::string shown_lines(const Searched& file, const std::vector<Hit>& hits)
{
    std::string list;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (i > 0) list += i + 1 == hits.size() ? " and " : ", ";
        list += fmt::format("{}", file.shown_line(lines_of(file, *hits[i][0]).first));
    }
    return list;
}

}  // namespace lobe::engine
