// The wording of everything that forms no token: what was seen, and what to write instead.
#include "base/utf8.h"
#include "syntax/characters.h"
#include "syntax/lex.h"

#include <fmt/format.h>

#include <array>

namespace lobe::syntax {
namespace {

/// `{}` in `message` and `label` is the text of the problem.
struct Wording {
    Trouble trouble;
    Code code;
    std::string_view message;
    std::string_view label;
    std::string_view help;
    const char* replacement;  ///< of the whole text; null if there is no confident edit
};

constexpr std::array wordings{
    Wording{Trouble::stray, Code::unexpected_character, "`{}` is not part of the language", "", "",
            nullptr},
    Wording{Trouble::control, Code::unexpected_character, "a control character stands in the text",
            "this does not print", "remove it", nullptr},
    Wording{Trouble::byte_order_mark, Code::unexpected_character,
            "a byte order mark stands inside the text", "does not print",
            "it may only be the first character of a file; remove it here", nullptr},
    Wording{Trouble::text_direction, Code::unexpected_character,
            "a character that reorders text stands here",
            "what follows reads differently from what it says", "remove it", nullptr},
    Wording{Trouble::look_alike, Code::unexpected_character, "`{}` is not part of the language", "",
            "", nullptr},
    Wording{Trouble::not_ascii, Code::unexpected_character, "`{}` is not part of the language", "",
            "names are made of the letters a-z, A-Z, digits and `_`; other letters may stand in "
            "comments and strings",
            nullptr},
    Wording{Trouble::carriage_return, Code::unexpected_character,
            "a carriage return without a line feed", "ends no line", "end lines with LF or CR LF",
            nullptr},
    Wording{Trouble::semicolon, Code::unexpected_character, "`;` is not part of the language",
            "a declaration ends where the next one starts", "", ""},
    Wording{Trouble::ampersands, Code::unexpected_character, "`&&` is not an operator", "", "",
            "and"},
    Wording{Trouble::bars, Code::unexpected_character, "`||` is not an operator", "", "", "or"},
    Wording{Trouble::exclamation, Code::unexpected_character, "`!` is not an operator", "", "",
            "not "},
    Wording{Trouble::double_star, Code::unexpected_character, "`**` is not an operator",
            "powers are written `^`", "", "^"},
    Wording{Trouble::question_mark, Code::unexpected_character, "`?` is not an operator", "",
            "write `if condition then a else b`", nullptr},
    Wording{Trouble::apostrophe, Code::unexpected_character, "`'` does not start a string", "",
            "texts stand in double quotes: \"...\"", nullptr},
    Wording{Trouble::hash, Code::unexpected_character, "`#` is not part of the language", "",
            "comments start with `//`, and doc comments with `///`", nullptr},
    Wording{Trouble::block_comment, Code::unexpected_character, "`/*` does not start a comment",
            "skipped up to `*/`", "start each line of the comment with `//`", nullptr},
    Wording{Trouble::unterminated_string, Code::unterminated_string,
            "this text has no closing quote", "the line ends before it does", "", nullptr},
    Wording{Trouble::unknown_escape, Code::unknown_escape, "`{}` is not an escape", "",
            "a backslash may stand before `\"` and before another backslash; everything else is "
            "written as it is",
            nullptr},
    Wording{Trouble::number_suffix, Code::malformed_number, "`{}` is not a number", "",
            "numbers have no suffix, and names start with a letter", nullptr},
    Wording{Trouble::number_no_integer_part, Code::malformed_number, "`{}` is not a number",
            "a digit is missing before the point", "", nullptr},
    Wording{Trouble::number_no_fraction, Code::malformed_number, "`{}` is not a number",
            "a digit is missing after the point", "", nullptr},
    Wording{Trouble::number_no_exponent, Code::malformed_number, "`{}` is not a number",
            "the exponent has no digits", "", nullptr},
    Wording{Trouble::number_two_dots, Code::malformed_number, "`{}` is not a number",
            "a number has one decimal point", "", nullptr},
    Wording{Trouble::number_hexadecimal, Code::malformed_number, "`{}` is not a number", "",
            "numbers are decimal", nullptr},
    Wording{Trouble::number_out_of_range, Code::malformed_number,
            "the number `{}` is beyond what the compiler can hold", "",
            "magnitudes from 2^-1074 to 2^1024 are accepted, and 0", nullptr},
};

const Wording& wording_of(Trouble trouble)
{
    for (const Wording& wording : wordings)
        if (wording.trouble == trouble) return wording;
    return wordings.front();
}

/// Long runs are quoted by their start, cut between characters.
std::string excerpt(std::string_view text)
{
    constexpr std::size_t longest = 40;
    if (text.size() <= longest) return std::string{text};
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return std::string{text.substr(0, end)} + "...";
}

/// Characters that do not show, or not as what they are, are named by their number.
std::string label(const Problem& problem, const Wording& wording, std::string_view text)
{
    switch (problem.trouble) {
    case Trouble::control:
    case Trouble::byte_order_mark:
    case Trouble::text_direction:
    case Trouble::look_alike:
    case Trouble::not_ascii: break;
    default: return std::string{wording.label};
    }
    const auto code = static_cast<unsigned>(first_character(text.substr(problem.begin)).code);
    return fmt::format("U+{:04X}{}{}", code, wording.label.empty() ? "" : " ", wording.label);
}

/// `0.5f` is a number of another language, `2x` a product of mathematics.
std::optional<std::string> without_suffix(std::string_view written)
{
    const std::size_t end = written.find_first_not_of("0123456789.");
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view suffix = written.substr(end);
    if (suffix.find_first_not_of("fFhHuUlL") == std::string_view::npos && suffix.size() <= 2)
        return std::string{written.substr(0, end)};
    if (suffix.find('.') != std::string_view::npos) return std::nullopt;
    return fmt::format("{} * {}", written.substr(0, end), suffix);
}

std::optional<std::string> replacement(const Problem& problem, const Wording& wording,
                                       std::string_view text)
{
    if (wording.replacement != nullptr) return wording.replacement;
    const std::string_view written = text.substr(problem.begin, problem.end - problem.begin);
    switch (problem.trouble) {
    case Trouble::number_suffix: return without_suffix(written);
    case Trouble::number_no_integer_part: return fmt::format("0{}", written);
    case Trouble::number_no_fraction:
        return written.back() == '.' ? std::optional{fmt::format("{}0", written)} : std::nullopt;
    case Trouble::look_alike: return std::string{look_alike(written)->ascii};
    case Trouble::unterminated_string:
        // A comment at the end of the line is most likely not meant to be part of the text.
        return written.find("//") == std::string_view::npos
                   ? std::optional{fmt::format("{}\"", written)}
                   : std::nullopt;
    default: return std::nullopt;
    }
}

}  // namespace

Diagnostic describe(const Problem& problem, std::string_view text, std::uint32_t source)
{
    const Wording& wording = wording_of(problem.trouble);
    const Span span{source, problem.begin, problem.end};
    const std::string written = excerpt(text.substr(problem.begin, problem.end - problem.begin));

    Diagnostic result;
    result.code = wording.code;
    result.message = fmt::format(fmt::runtime(wording.message), written);
    result.primary = {span, label(problem, wording, text)};
    if (!wording.help.empty()) result.helps.emplace_back(wording.help);
    if (auto edit = replacement(problem, wording, text)) {
        const std::string_view word{edit->data(), edit->size() - (edit->ends_with(' ') ? 1 : 0)};
        const std::string what = word.empty() ? "remove it" : fmt::format("write `{}`", word);
        result.fix = Fix{span, *edit,
                         problem.trouble == Trouble::unterminated_string ? "close the text" : what};
    }
    return result;
}

}  // namespace lobe::syntax
