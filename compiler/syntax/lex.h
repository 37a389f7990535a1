// Text to tokens. Comments are set aside with their places; what starts no token becomes a
// `Problem`, so that the parser can report it in source order.
#pragma once

#include "base/diagnostic.h"
#include "syntax/tree.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::syntax {

enum class TokenKind : std::uint8_t {
    end,         ///< of the text
    unknown,     ///< a `Problem` stands here
    bad_number,  ///< likewise; takes the place of a number
    identifier,
    number,
    string,
    word_if,
    word_then,
    word_else,
    word_let,
    word_and,
    word_or,
    word_not,
    left_parenthesis,
    right_parenthesis,
    left_brace,
    right_brace,
    left_bracket,
    right_bracket,
    comma,
    colon,
    dot,
    dot_dot,
    arrow,
    assign,
    plus,
    minus,
    star,
    slash,
    caret,
    percent,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
};

struct Token {
    TokenKind kind = TokenKind::end;
    bool first_on_line = false;
    bool blank_before = false;  ///< an empty line between it and the token or comment before it
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// A comment and whether something else stands before it on its line.
struct PlacedComment {
    Comment comment;
    bool own_line = false;
};

/// Why some characters form no token. One entry per wording; see `describe`.
enum class Trouble : std::uint8_t {
    stray,
    control,
    byte_order_mark,
    text_direction,
    look_alike,
    not_ascii,
    carriage_return,
    semicolon,
    ampersands,
    bars,
    exclamation,
    double_star,
    question_mark,
    apostrophe,
    hash,
    block_comment,
    unterminated_string,
    unknown_escape,
    number_suffix,
    number_no_integer_part,
    number_no_fraction,
    number_no_exponent,
    number_two_dots,
    number_hexadecimal,
    number_out_of_range,
};

struct Problem {
    Trouble trouble{};
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

struct Tokens {
    std::vector<Token> all;  ///< the last one is `end`
    std::vector<PlacedComment> comments;
    std::vector<Problem> problems;  ///< in source order
};

/// The tokens of a text that is UTF-8. Total: every text has tokens.
Tokens lex(std::string_view text, std::uint32_t source);

/// The message for a problem.
Diagnostic describe(const Problem& problem, std::string_view text, std::uint32_t source);

/// The content of a string token: without its quotes, escapes resolved.
std::string unquote(std::string_view token);

/// `text` as a string token.
std::string quote(std::string_view text);

}  // namespace lobe::syntax
