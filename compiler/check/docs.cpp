#include "check/docs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lobe::check {
namespace {

constexpr std::array<std::string_view, 16> locator_words{
    "slide", "slides", "eq", "eqs", "eqn",   "section", "sections", "sec",
    "page",  "pages",  "p",  "pp",  "table", "figure",  "fig",      "chapter"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name(std::string_view word)
{
    const auto letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    return !word.empty() && letter(word[0]) &&
           std::ranges::all_of(word, [&](char c) { return letter(c) || is_digit(c); });
}

/// `85`, `85-90`, `4.1`, `(33)`, `12,`
bool is_number(std::string_view word)
{
    return std::ranges::any_of(word, is_digit) && std::ranges::all_of(word, [](char c) {
               return is_digit(c) || std::string_view{".,-()"}.find(c) != std::string_view::npos;
           });
}

std::vector<std::string_view> words_of(std::string_view line)
{
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) return words;
        line.remove_prefix(begin);
        const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

/// What follows the name of a source: `85`, `eq 33`, `D`; nothing for the source as a whole.
bool is_locator(const std::vector<std::string_view>& words)
{
    for (std::size_t i = 1; i < words.size(); ++i) {
        const bool known = std::ranges::find(locator_words, words[i]) != locator_words.end();
        const bool letter = words[i].size() == 1 && is_name(words[i]);
        if (!known && !letter && !is_number(words[i])) return false;
    }
    return true;
}

/// `Walter07`, `Karis2013b`: a name that ends in a year.
bool ends_in_year(std::string_view name)
{
    if (!is_digit(name.back())) name.remove_suffix(1);
    const std::size_t letters = name.find_last_not_of("0123456789") + 1;
    const std::size_t digits = name.size() - letters;
    return letters >= 3 && (digits == 2 || digits == 4);
}

/// A line that can only be meant as a citation, whether or not its source is declared: a name
/// and a number, with at most one word such as `eq` between, or a name that ends in a year.
bool looks_cited(const std::vector<std::string_view>& words)
{
    const auto is_word = [](std::string_view word) {
        std::string lower{word};
        if (!lower.empty() && lower[0] >= 'A' && lower[0] <= 'Z')
            lower[0] = static_cast<char>(lower[0] - 'A' + 'a');
        return std::ranges::find(locator_words, lower) != locator_words.end();
    };
    if (words.size() == 1) return ends_in_year(words[0]);
    const bool capital = words[0][0] >= 'A' && words[0][0] <= 'Z';
    if (capital && is_word(words[0])) return false;  // `Figure 3`
    return (words.size() == 2 && is_number(words[1])) ||
           (words.size() == 3 && is_word(words[1]) && is_number(words[2]));
}

}  // namespace

Documentation read_documentation(const File& file, const std::vector<syntax::Comment>& comments,
                                 Diagnostics& diagnostics)
{
    Documentation result;
    for (const syntax::Comment& comment : comments) {
        if (!comment.doc) continue;
        const auto words = words_of(comment.text);
        const bool named = !words.empty() && is_name(words[0]);
        if (named && file.sources.contains(words[0]) && is_locator(words)) {
            std::string locator;
            for (std::size_t i = 1; i < words.size(); ++i)
                locator += fmt::format("{}{}", i > 1 ? " " : "", words[i]);
            result.citations.push_back({std::string{words[0]}, std::move(locator)});
            continue;
        }
        if (!named || !looks_cited(words)) {
            result.text += comment.text + "\n";
            continue;
        }
        if (file.broken) continue;
        const std::string cited{words[0]};
        std::vector<std::string> known;
        for (const auto& [name, item] : file.sources) known.push_back(name);
        diagnostics.report(
            {.code = Code::unknown_source,
             .message =
                 fmt::format("no source is called `{}`{}", cited, did_you_mean(cited, known)),
             .primary = {comment.span, "read as a citation: a source and a place in it"},
             .helps = {fmt::format("declare it: `source {} = \"...\"`", cited)}});
    }
    while (!result.text.empty() && (result.text.back() == '\n' || result.text.back() == ' '))
        result.text.pop_back();
    result.text.erase(0, std::min(result.text.find_first_not_of('\n'), result.text.size()));
    return result;
}

std::string one_line(std::string_view text)
{
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text.substr(i, 2) == "//") i = std::min(text.find('\n', i), text.size());
        const char c = i < text.size() ? text[i] : ' ';
        const bool space = c == ' ' || c == '\t' || c == '\r' || c == '\n';
        const bool inside = result.empty() || result.back() == ' ' || result.back() == '(';
        // A line break after `(` or before `)` is layout, not text.
        if (c == ')' && !result.empty() && result.back() == ' ') result.pop_back();
        if (!space)
            result += c;
        else if (!inside)
            result += ' ';
    }
    if (!result.empty() && result.back() == ' ') result.pop_back();
    return result;
}

std::string formula(const Sources& sources, const syntax::Tree& tree, const syntax::Body& body)
{
    std::string result;
    for (const syntax::Let& let : body.lets)
        result += fmt::format("let {} = {}; ", let.name.text,
                              one_line(sources.text(tree[let.value].span)));
    if (body.value.valid()) result += one_line(sources.text(tree[body.value].span));
    return result;
}

}  // namespace lobe::check
