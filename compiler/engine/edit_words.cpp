#include "engine/edit_words.h"

#include "engine/lines.h"
#include "engine/pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace lobe::engine {
std::string_view trimmed(std::string_view text)
{
    text.remove_prefix(indentation(text).size());
    const auto last = text.find_last_not_of(" \t\r");
    return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::string_view take_word(std::string_view& rest)
{
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest = trimmed(rest.substr(word.size()));
    return word;
}

bool is_name(std::string_view text)
{
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_';
    };
    return !text.empty() && std::ranges::all_of(text, fits);
}

bool starts_as_number(std::string_view text)
{
    return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

bool read_int(std::string_view text, int& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && value >= 0;
}

std::optional<std::string> take_quoted(std::string_view& rest)
{
    const auto end = rest.find('"', 1);
    if (!rest.starts_with('"') || end == std::string_view::npos || end == 1) return std::nullopt;
    const std::string words{rest.substr(1, end - 1)};
    rest = trimmed(rest.substr(end + 1));
    return words;
}

bool read_hits(std::string_view text, int& least, int& most)
{
    const auto dots = text.find("..");
    const bool range = dots != std::string_view::npos;
    return read_int(text.substr(0, dots), least) &&
           read_int(range ? text.substr(dots + 2) : text, most) && most >= std::max(least, 1);
}

std::optional<Query::Kind> query_kind(std::string_view word)
{
    using enum Query::Kind;
    static constexpr std::pair<std::string_view, Query::Kind> kinds[] = {
        {"version", version}, {"probe", probe},   {"read", read},       {"count", count},
        {"assert", demand},   {"unique", unique}, {"at_most", at_most}, {"equal", equal}};
    for (const auto& [name, kind] : kinds)
        if (name == word) return kind;
    return std::nullopt;
}

std::optional<Action> action_of(std::string_view word)
{
    static constexpr std::pair<std::string_view, Action> actions[] = {{"before", Action::before},
                                                                      {"after", Action::after},
                                                                      {"replace", Action::replace},
                                                                      {"append", Action::append},
                                                                      {"clone", Action::clone}};
    for (const auto& [name, action] : actions)
        if (name == word) return action;
    return std::nullopt;
}

PatternCheck check_pattern_text(std::string_view text)
{
    if (text.empty()) return {-1, "a regular expression is missing"};
    const Substituted with_values = substitute_quoted(text, [](std::string_view) { return "x"; });
    if (!with_values.error.empty()) return {-1, with_values.error};
    const Pattern pattern{with_values.text};
    if (!pattern.error().empty())
        return {-1, fmt::format("regular expression: {}", pattern.error())};
    if (pattern.matches_nothing())
        return {-1, "this regular expression matches nothing at all, everywhere"};
    return {pattern.groups(), {}};
}

std::optional<Version> parse_version(std::string_view text)
{
    const auto dot = text.find('.');
    if (dot == std::string_view::npos) return std::nullopt;
    const std::string_view minor = text.substr(dot + 1);
    Version version;
    if (!read_int(text.substr(0, dot), version.major) ||
        !read_int(minor.substr(0, minor.find('.')), version.minor))
        return std::nullopt;
    return version;
}

}  // namespace lobe::engine
