#include "analyze/agreement/tokens.h"

#include <algorithm>
#include <array>

namespace lobe::analyze {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Where the number that starts at `at` ends: digits, a point, an exponent, a suffix.
std::size_t end_of_number(std::string_view text, std::size_t at)
{
    while (at < text.size()) {
        const char c = text[at];
        const bool sign_of_exponent =
            (c == '+' || c == '-') && (text[at - 1] == 'e' || text[at - 1] == 'E');
        if (!is_digit(c) && !is_letter(c) && c != '.' && !sign_of_exponent) break;
        ++at;
    }
    return at;
}

bool opens(std::string_view symbol) { return symbol == "(" || symbol == "[" || symbol == "{"; }
bool closes(std::string_view symbol) { return symbol == ")" || symbol == "]" || symbol == "}"; }

}  // namespace

std::vector<Token> tokenize(std::string_view text)
{
    constexpr std::array<std::string_view, 12> pairs{"<=", ">=", "==", "!=", "&&", "||",
                                                     "+=", "-=", "*=", "/=", "++", "--"};
    std::vector<Token> tokens;
    int line = 1;
    bool line_is_blank = true;  // so far
    std::size_t at = 0;
    const auto skip_to = [&](std::size_t end) {
        end = std::min(end, text.size());
        line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                            text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        at = end;
    };
    while (at < text.size()) {
        const char c = text[at];
        const std::string_view two = text.substr(at, 2);
        if (c == '\n') {
            skip_to(at + 1);
            line_is_blank = true;
        } else if (c == ' ' || c == '\t' || c == '\r') {
            ++at;
        } else if (two == "//" || (c == '#' && line_is_blank)) {
            skip_to(text.find('\n', at));
        } else if (two == "/*") {
            const std::size_t end = text.find("*/", at + 2);
            skip_to(end == std::string_view::npos ? end : end + 2);
        } else {
            line_is_blank = false;
            Token token{Token::Kind::symbol, at, at + 1, line, {}};
            if (is_letter(c)) {
                token.kind = Token::Kind::name;
                while (token.end < text.size() &&
                       (is_letter(text[token.end]) || is_digit(text[token.end])))
                    ++token.end;
            } else if (is_digit(c) ||
                       (c == '.' && at + 1 < text.size() && is_digit(text[at + 1]))) {
                token.kind = Token::Kind::number;
                token.end = end_of_number(text, at + 1);
            } else if (std::ranges::find(pairs, two) != pairs.end()) {
                token.end = at + 2;
            }
            token.text = text.substr(token.begin, token.end - token.begin);
            tokens.push_back(token);
            at = token.end;
        }
    }
    return tokens;
}

std::size_t closing(const std::vector<Token>& tokens, std::size_t open)
{
    int depth = 0;
    for (std::size_t i = open; i < tokens.size(); ++i) {
        if (opens(tokens[i].text)) ++depth;
        if (closes(tokens[i].text) && --depth == 0) return i;
    }
    return tokens.size();
}

std::vector<TokenRange> arguments(const std::vector<Token>& tokens, std::size_t open)
{
    const std::size_t close = closing(tokens, open);
    std::vector<TokenRange> result;
    if (close == tokens.size() || close == open + 1) return result;
    int depth = 0;
    std::size_t first = open + 1;
    for (std::size_t i = open + 1; i <= close; ++i) {
        if (i == close || (depth == 0 && tokens[i].text == ",")) {
            result.push_back({first, i});
            first = i + 1;
        }
        if (opens(tokens[i].text)) ++depth;
        if (closes(tokens[i].text)) --depth;
    }
    return result;
}

}  // namespace lobe::analyze
