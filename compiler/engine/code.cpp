#include "engine/code.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lobe::engine {
namespace {

/// One pass from left to right; every byte gets its part once.
class Partition {
public:
    explicit Partition(std::string_view text) : text_(text), parts_(text.size(), Part::code) {}

    std::vector<Part> run()
    {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '/' && next(1) == '/')
                fill(Part::line_comment, end_of_line(at_));
            else if (c == '/' && next(1) == '*')
                fill(Part::block_comment, behind("*/", at_ + 2));
            else if (c == '"' && is_raw())
                fill(Part::literal, end_of_raw());
            else if (c == '"')
                fill(Part::literal, end_of_string());
            else if (c == '\'')
                fill(Part::literal, end_of_character());
            else
                ++at_;
        }
        return std::move(parts_);
    }

private:
    char next(std::size_t distance) const
    {
        return at_ + distance < text_.size() ? text_[at_ + distance] : '\0';
    }

    /// From behind the current byte, which stays code, up to `end`.
    void fill(Part part, std::size_t end)
    {
        end = std::max(end, at_ + 1);
        std::fill(parts_.begin() + static_cast<std::ptrdiff_t>(at_ + 1),
                  parts_.begin() + static_cast<std::ptrdiff_t>(end), part);
        at_ = end;
    }

    std::size_t behind(std::string_view what, std::size_t from) const
    {
        const auto found = text_.find(what, from);
        return found == std::string_view::npos ? text_.size() : found + what.size();
    }

    /// The line feed that a line ends in; not one behind a backslash.
    std::size_t end_of_line(std::size_t from) const
    {
        for (;;) {
            const auto end = text_.find('\n', from);
            if (end == std::string_view::npos) return text_.size();
            if (text_[end - 1] != '\\') return end;
            from = end + 1;
        }
    }

    /// Behind the closing quote, or at the end of the line: `#error don't "quote` is no string.
    std::size_t end_of_string() const
    {
        for (std::size_t end = at_ + 1; end < text_.size(); ++end) {
            if (text_[end] == '\\')
                ++end;
            else if (text_[end] == '"')
                return end + 1;
            else if (text_[end] == '\n')
                return end;
        }
        return text_.size();
    }

    /// Only 'x' and '\…': an apostrophe may also part digits, or stand in the words of an #error.
    std::size_t end_of_character() const
    {
        if (next(1) != '\\') return next(1) != '\n' && next(2) == '\'' ? at_ + 3 : at_ + 1;
        const auto end = text_.find_first_of("'\n", at_ + 3);
        return end != std::string_view::npos && text_[end] == '\'' ? end + 1 : at_ + 1;
    }

    bool is_raw() const { return at_ > 0 && text_[at_ - 1] == 'R'; }

    std::size_t end_of_raw() const
    {
        const auto open = text_.find_first_of("(\n", at_);
        if (open == std::string_view::npos || text_[open] == '\n') return end_of_string();
        std::string close = ")";
        close += text_.substr(at_ + 1, open - at_ - 1);
        close += '"';
        return behind(close, open);
    }

    std::string_view text_;
    std::vector<Part> parts_;
    std::size_t at_ = 0;
};

/// The word of a directive whose `#` is at `at`: `if`, `else` …
std::string_view directive(std::string_view text, std::size_t at)
{
    const auto begin = text.find_first_not_of(" \t", at + 1);
    if (begin == std::string_view::npos) return {};
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    std::size_t end = begin;
    while (end < text.size() && is_letter(text[end])) ++end;
    return text.substr(begin, end - begin);
}

}  // namespace

std::vector<Part> parts_of(std::string_view text) { return Partition{text}.run(); }

std::optional<std::size_t> end_of_definition(std::string_view text, const std::vector<Part>& parts,
                                             std::size_t from)
{
    int braces = 0;
    int parentheses = 0;
    std::vector<int> outside;  // of the open #ifs: the depth of braces before them
    bool line_is_blank = true;
    for (std::size_t at = from; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '\n') {
            line_is_blank = true;
            continue;
        }
        if (parts[at] != Part::code) continue;
        if (c == '#' && line_is_blank) {
            const std::string_view word = directive(text, at);
            if (word.starts_with("if"))
                outside.push_back(braces);
            else if (word.starts_with("el") && !outside.empty())
                braces = outside.back();
            else if (word == "endif" && !outside.empty())
                outside.pop_back();
        }
        if (c != ' ' && c != '\t') line_is_blank = false;
        if (c == '(') ++parentheses;
        if (c == ')') --parentheses;
        if (c == ';' && braces == 0 && parentheses <= 0) return std::nullopt;
        if (c == '{') ++braces;
        if (c == '}' && --braces == 0) return std::min(text.find('\n', at), text.size() - 1) + 1;
    }
    return std::nullopt;
}

}  // namespace lobe::engine
