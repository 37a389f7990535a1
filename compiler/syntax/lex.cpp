#include "syntax/lex.h"

#include "base/utf8.h"
#include "syntax/characters.h"

#include <array>
#include <charconv>
#include <cmath>

namespace lobe::syntax {
namespace {

/// U+FEFF, which some editors put before the text.
constexpr std::string_view signature = "\xEF\xBB\xBF";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name(char c) { return is_letter(c) || is_digit(c); }

struct Word {
    std::string_view text;
    TokenKind kind;
};

constexpr std::array words{
    Word{"if", TokenKind::word_if},     Word{"then", TokenKind::word_then},
    Word{"else", TokenKind::word_else}, Word{"let", TokenKind::word_let},
    Word{"and", TokenKind::word_and},   Word{"or", TokenKind::word_or},
    Word{"not", TokenKind::word_not},
};

/// Longer spellings stand before their prefixes.
constexpr std::array symbols{
    Word{"..", TokenKind::dot_dot},
    Word{"->", TokenKind::arrow},
    Word{"<=", TokenKind::less_equal},
    Word{">=", TokenKind::greater_equal},
    Word{"==", TokenKind::equal},
    Word{"!=", TokenKind::not_equal},
    Word{"(", TokenKind::left_parenthesis},
    Word{")", TokenKind::right_parenthesis},
    Word{"{", TokenKind::left_brace},
    Word{"}", TokenKind::right_brace},
    Word{"[", TokenKind::left_bracket},
    Word{"]", TokenKind::right_bracket},
    Word{",", TokenKind::comma},
    Word{":", TokenKind::colon},
    Word{".", TokenKind::dot},
    Word{"=", TokenKind::assign},
    Word{"+", TokenKind::plus},
    Word{"-", TokenKind::minus},
    Word{"*", TokenKind::star},
    Word{"/", TokenKind::slash},
    Word{"^", TokenKind::caret},
    Word{"%", TokenKind::percent},
    Word{"<", TokenKind::less},
    Word{">", TokenKind::greater},
};

/// What people write who come from other languages, and what it stands for here: the message
/// names the right spelling and parsing goes on as if it had been used. `end` stands for nothing.
struct Foreign {
    std::string_view text;
    Trouble trouble;
    TokenKind kind;
};

constexpr std::array foreigners{
    Foreign{"**", Trouble::double_star, TokenKind::caret},
    Foreign{"&&", Trouble::ampersands, TokenKind::word_and},
    Foreign{"||", Trouble::bars, TokenKind::word_or},
    Foreign{"!", Trouble::exclamation, TokenKind::word_not},
    Foreign{";", Trouble::semicolon, TokenKind::end},
    Foreign{"?", Trouble::question_mark, TokenKind::unknown},
    Foreign{"'", Trouble::apostrophe, TokenKind::unknown},
    Foreign{"#", Trouble::hash, TokenKind::unknown},
};

class Lexer {
public:
    Lexer(std::string_view text, std::uint32_t source) : text_(text), source_(source) {}

    Tokens run()
    {
        if (text_.starts_with(signature)) at_ = signature.size();
        while (at_ < text_.size()) step();
        push(TokenKind::end, at_, at_);
        return std::move(out_);
    }

private:
    bool starts(std::string_view prefix) const { return text_.substr(at_).starts_with(prefix); }
    char peek(std::size_t ahead = 0) const
    {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }

    void push(TokenKind kind, std::size_t begin, std::size_t end)
    {
        out_.all.push_back({kind, line_is_empty_, newlines_ > 1, static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(end)});
        seen();
    }

    /// Something other than space stands on this line now.
    void seen()
    {
        line_is_empty_ = false;
        newlines_ = 0;
    }

    void trouble(Trouble what, std::size_t begin, std::size_t end)
    {
        out_.problems.push_back(
            {what, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    }

    void step()
    {
        const char c = peek();
        if (c == '\n') {
            ++at_;
            ++newlines_;
            line_is_empty_ = true;
        } else if (c == ' ' || c == '\t' || (c == '\r' && peek(1) == '\n')) {
            ++at_;
        } else if (starts("//")) {
            comment();
        } else if (starts("/*")) {
            block_comment();
        } else if (is_letter(c)) {
            name();
        } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
            number();
        } else if (c == '"') {
            string();
        } else if (!symbol() && !foreign()) {
            other();
        }
    }

    void comment()
    {
        const std::size_t begin = at_;
        // Three slashes document; four or more are a ruler.
        const bool doc = starts("///") && peek(3) != '/';
        std::size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos) end = text_.size();
        if (end > begin && text_[end - 1] == '\r' && end < text_.size()) --end;
        at_ = begin + (doc ? 3 : 2);
        const std::size_t content = at_ < end && text_[at_] == ' ' ? at_ + 1 : at_;
        // Comments reach generated code, where a control character could end them early.
        while (at_ < end)
            if (!hostile()) ++at_;
        std::size_t last = end;
        while (last > content && (text_[last - 1] == ' ' || text_[last - 1] == '\t')) --last;

        Comment comment;
        comment.text = std::string{text_.substr(content, last - content)};
        comment.span = {source_, static_cast<std::uint32_t>(begin),
                        static_cast<std::uint32_t>(end)};
        comment.doc = doc;
        comment.blank_before = newlines_ > 1;
        out_.comments.push_back({std::move(comment), line_is_empty_});
        seen();
    }

    void block_comment()
    {
        const std::size_t begin = at_;
        const std::size_t close = text_.find("*/", at_ + 2);
        at_ = close == std::string_view::npos ? text_.size() : close + 2;
        trouble(Trouble::block_comment, begin, begin + 2);
    }

    void name()
    {
        const std::size_t begin = at_;
        while (is_name(peek())) ++at_;
        const std::string_view text = text_.substr(begin, at_ - begin);
        TokenKind kind = TokenKind::identifier;
        if (text.size() <= 4)
            for (const Word& word : words)
                if (text == word.text) kind = word.kind;
        push(kind, begin, at_);
    }

    void number()
    {
        const std::size_t begin = at_;
        while (is_digit(peek())) ++at_;
        const bool integer = at_ > begin;
        bool fraction = true;
        bool exponent = true;
        if (peek() == '.' && peek(1) != '.') {
            ++at_;
            fraction = is_digit(peek());
            while (is_digit(peek())) ++at_;
        }
        if (fraction && (peek() == 'e' || peek() == 'E')) {
            const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
            exponent = is_digit(peek(1 + sign));
            at_ += 1 + sign;
            while (is_digit(peek())) ++at_;
        }
        const std::size_t good = at_;
        while (is_name(peek()) || (peek() == '.' && is_name(peek(1)))) ++at_;

        const std::string_view text = text_.substr(begin, at_ - begin);
        const auto malformed = [&](Trouble what) {
            trouble(what, begin, at_);
            push(TokenKind::bad_number, begin, at_);
        };
        if (text.starts_with("0x") || text.starts_with("0X"))
            malformed(Trouble::number_hexadecimal);
        else if (at_ > good && text[good - begin] == '.')
            malformed(Trouble::number_two_dots);
        else if (!fraction)
            malformed(Trouble::number_no_fraction);
        else if (!exponent)
            malformed(Trouble::number_no_exponent);
        else if (at_ > good)
            malformed(Trouble::number_suffix);
        else if (!integer)
            malformed(Trouble::number_no_integer_part);
        else if (!is_representable(text))
            malformed(Trouble::number_out_of_range);
        else
            push(TokenKind::number, begin, at_);
    }

    /// Literals are real numbers, but every evaluator starts from a double near them: one that
    /// overflows, or vanishes without being 0, would be another number.
    static bool is_representable(std::string_view text)
    {
        double value = 0;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        return result.ec == std::errc{} && std::isfinite(value);
    }

    void string()
    {
        const std::size_t begin = at_++;
        while (at_ < text_.size() && peek() != '"' && peek() != '\n') {
            if (peek() == '\\') {
                if (peek(1) == '"' || peek(1) == '\\') {
                    at_ += 2;
                } else {
                    const std::size_t wide =
                        at_ + 1 < text_.size() ? first_character(text_.substr(at_ + 1)).size : 0;
                    if (peek(1) != '\n' && peek(1) != '\r' && wide > 0)
                        trouble(Trouble::unknown_escape, at_, at_ + 1 + wide);
                    ++at_;
                }
            } else if (!hostile()) {
                ++at_;
            }
        }
        if (peek() == '"') {
            push(TokenKind::string, begin, ++at_);
            return;
        }
        std::size_t end = at_;
        if (end > begin + 1 && text_[end - 1] == '\r') --end;
        while (end > begin + 1 && (text_[end - 1] == ' ' || text_[end - 1] == '\t')) --end;
        trouble(Trouble::unterminated_string, begin, end);
        push(TokenKind::string, begin, end);
    }

    bool symbol()
    {
        if (starts("**")) return false;
        for (const Word& word : symbols) {
            if (!starts(word.text)) continue;
            push(word.kind, at_, at_ + word.text.size());
            at_ += word.text.size();
            return true;
        }
        return false;
    }

    bool foreign()
    {
        for (const Foreign& foreigner : foreigners) {
            if (!starts(foreigner.text)) continue;
            const std::size_t begin = at_;
            at_ += foreigner.text.size();
            trouble(foreigner.trouble, begin, at_);
            if (foreigner.kind != TokenKind::end) push(foreigner.kind, begin, at_);
            return true;
        }
        return false;
    }

    /// Reports and skips a character that must not stand even in comments and strings: it could
    /// hide what the text says, or end a comment in generated code.
    bool hostile()
    {
        const std::size_t begin = at_;
        const char c = peek();
        const auto code = first_character(text_.substr(at_)).code;
        Trouble what{};
        if (c == '\r' && peek(1) != '\n')
            what = Trouble::carriage_return;
        else if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r') || c == 0x7F)
            what = Trouble::control;
        else if (changes_text_direction(code))
            what = Trouble::text_direction;
        else if (code == 0xFEFF)
            what = Trouble::byte_order_mark;
        else
            return false;
        const std::string_view one = text_.substr(begin, first_character(text_.substr(begin)).size);
        while (starts(one)) at_ += one.size();
        trouble(what, begin, at_);
        return true;
    }

    /// Whatever is left: hostile, a look-alike of an operator, or a run of something else.
    void other()
    {
        const std::size_t begin = at_;
        if (hostile()) {
            push(TokenKind::unknown, begin, at_);
            return;
        }
        if (const LookAlike* found = look_alike(text_.substr(at_))) {
            at_ += found->text.size();
            trouble(Trouble::look_alike, begin, at_);
            TokenKind kind = TokenKind::unknown;
            for (const Word& word : symbols)
                if (word.text == found->ascii) kind = word.kind;
            push(kind, begin, at_);
            return;
        }
        const bool ascii = static_cast<unsigned char>(peek()) < 0x80;
        do at_ += first_character(text_.substr(at_)).size;
        while (at_ < text_.size() &&
               (ascii ? peek() == text_[begin]
                      : static_cast<unsigned char>(peek()) >= 0x80 &&
                            look_alike(text_.substr(at_)) == nullptr &&
                            !changes_text_direction(first_character(text_.substr(at_)).code)));
        trouble(ascii ? Trouble::stray : Trouble::not_ascii, begin, at_);
        push(TokenKind::unknown, begin, at_);
    }

    std::string_view text_;
    std::uint32_t source_;
    std::size_t at_ = 0;
    Tokens out_;
    bool line_is_empty_ = true;
    int newlines_ = 0;  ///< since the last token or comment
};

}  // namespace

Tokens lex(std::string_view text, std::uint32_t source) { return Lexer{text, source}.run(); }

std::string unquote(std::string_view token)
{
    std::string result;
    if (token.starts_with('"')) token.remove_prefix(1);
    for (std::size_t i = 0; i < token.size(); ++i) {
        if (token[i] == '"') break;
        const bool escape = token[i] == '\\' && i + 1 < token.size() &&
                            (token[i + 1] == '"' || token[i + 1] == '\\');
        if (escape) ++i;
        result += token[i];
    }
    return result;
}

std::string quote(std::string_view text)
{
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

}  // namespace lobe::syntax
