// What the blocks of lines have in common: where a line starts, how a misspelt one is understood,
// and how one that cannot be read costs that line only.
#include "syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lobe::syntax {
namespace {

/// Bits are counted in an int, and no channel comes near this.
constexpr unsigned most_bits = 64;

bool contains(const std::vector<std::string>& words, std::string_view word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

/// Whether a line follows, rather than what ends the block.
bool Parser::at_line(const LineWords& words) const
{
    return !at(TokenKind::right_brace) && !at(TokenKind::end) && !at_item() &&
           !at_outer_line(words);
}

bool Parser::at_outer_line(const LineWords& words) const
{
    return at(TokenKind::identifier) && current().first_on_line &&
           contains(words.outer, text(current()));
}

/// Whether what stands here is a line of the block or of one around it, and does not continue an
/// expression: there, two names never stand side by side.
bool Parser::starts_line(const LineWords& words) const
{
    if (!at(TokenKind::identifier) || !current().first_on_line) return false;
    const std::string_view word = text(current());
    if (contains(words.own, word) || contains(words.outer, word)) return true;
    const Token& next = ahead(1);
    if (next.first_on_line) return false;
    if (words.fields && next.kind == TokenKind::dot) return true;
    return (next.kind == TokenKind::identifier || next.kind == TokenKind::string) &&
           nearest(word, words.own).has_value();
}

/// Whether a line of the block begins here, where something is missing from the one before it.
bool Parser::at_block_line() const
{
    if (block_ == nullptr || !at(TokenKind::identifier) || !current().first_on_line) return false;
    const Token& next = ahead(1);
    const bool beside = next.kind == TokenKind::identifier || next.kind == TokenKind::string;
    return beside && !next.first_on_line &&
           (contains(block_->own, text(current())) || at_outer_line(*block_));
}

Parser::LineStart Parser::open_line(const LineWords& words)
{
    block_ = &words;
    LineStart start;
    start.position = position_;
    start.comments = take_comments();
    start.blank_before = current().blank_before;
    start.begin = current().begin;
    return start;
}

/// One of the words, read; a misspelt one is reported and read as what it should be. Empty after
/// a failure.
std::string Parser::expect_one_of(const std::vector<std::string>& words, std::string_view what)
{
    if (at(TokenKind::identifier)) {
        const std::string word{text(current())};
        const auto meant = contains(words, word) ? std::optional{word} : nearest(word, words);
        if (meant && *meant != word) {
            Diagnostic misspelt;
            misspelt.code = Code::unexpected_token;
            misspelt.message = fmt::format("unknown word `{}`; did you mean `{}`?", word, *meant);
            misspelt.primary = {span(current()), ""};
            misspelt.fix = Fix{span(current()), *meant, fmt::format("write `{}`", *meant)};
            report(std::move(misspelt));
        }
        if (meant) {
            advance();
            return *meant;
        }
    }
    fail_expected(what);
    return {};
}

/// The word that a line starts with.
std::string Parser::line_word(const LineWords& words)
{
    const bool begins = current().first_on_line || previous().kind == TokenKind::left_brace;
    const std::string_view word = at(TokenKind::identifier) ? text(current()) : "";
    const bool misspelt = begins && !contains(words.outer, word) && nearest(word, words.own);
    const bool known = contains(words.own, word) || misspelt;
    if (known) return expect_one_of(words.own, words.expected);
    Diagnostic result;
    result.code = Code::unexpected_token;
    result.message =
        fmt::format("expected {}, found {}", begins ? words.expected : "the end of the line",
                    this->words(current()));
    result.primary = {span(current()), ""};
    fail(std::move(result));
    return {};
}

/// Whether the word goes on with the line, as it is or misspelt.
bool Parser::at_near_word(std::string_view word) const
{
    const bool misspelt = at(TokenKind::identifier) && !current().first_on_line &&
                          nearest(text(current()), {std::string{word}}).has_value();
    return at_word(word) || misspelt;
}

/// For lines that stand for themselves: what they say is not documented.
void Parser::refuse_docs(const LineStart& start)
{
    for (const Comment& comment : start.comments)
        if (comment.doc) report_dangling(comment, "the line below it has no documentation");
}

/// Skips to the next line of the block, or to what ends it. Comments inside what is skipped go.
void Parser::recover_line(const LineWords& words, const LineStart& start)
{
    failed_ = false;
    in_then_ = false;
    int open = 0;
    for (; !at(TokenKind::end) && !at_item(); advance()) {
        const bool moved = position_ != start.position;
        if (open == 0 && (at(TokenKind::right_brace) || (moved && starts_line(words)))) break;
        if (at(TokenKind::left_brace)) ++open;
        if (at(TokenKind::right_brace)) --open;
    }
    for (; next_comment_ < tokens_.comments.size(); ++next_comment_) {
        const PlacedComment& placed = tokens_.comments[next_comment_];
        const bool behind = !placed.own_line && placed.comment.span.begin < current().begin;
        if (placed.comment.span.begin >= previous().end && !behind) break;
    }
}

/// The brace that closes a block. Comments before it join those of the last line.
void Parser::close_block(const Token& open, const LineWords& words, std::vector<Comment>& last)
{
    for (Comment& comment : take_comments()) {
        if (comment.doc) report_dangling(comment);
        last.push_back(std::move(comment));
    }
    if (at_outer_line(words))
        fail_unclosed(open, words.expected);
    else
        expect_closing(TokenKind::right_brace, open, words.expected);
}

void Parser::report_misplaced(const Span& span, std::string message, Label earlier)
{
    Diagnostic result;
    result.code = Code::misplaced_item;
    result.message = std::move(message);
    result.primary = {span, ""};
    result.secondary = {std::move(earlier)};
    report(std::move(result));
}

/// A number of bits, or of one.
int Parser::parse_whole(std::string_view what)
{
    unsigned value = most_bits;
    if (at(TokenKind::number)) {
        const std::string_view digits = text(current());
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size()) value = most_bits;
    }
    if (value >= most_bits) {
        fail_expected(what, at(TokenKind::number)
                                ? fmt::format("bits are whole numbers below {}", most_bits)
                                : "");
        return 0;
    }
    advance();
    return static_cast<int>(value);
}

/// name { "," name }
std::vector<Identifier> Parser::parse_names(std::string_view what)
{
    std::vector<Identifier> result;
    do {
        Identifier name = expect_identifier(what);
        if (!name.text.empty()) result.push_back(std::move(name));
    } while (accept(TokenKind::comma));
    return result;
}

/// storage = name number
StorageClause Parser::parse_storage()
{
    StorageClause result;
    const std::uint32_t begin = current().begin;
    result.kind = expect_identifier("a storage such as `unorm 8`");
    result.bits = parse_whole("the number of bits");
    result.span = span_from(begin);
    return result;
}

}  // namespace lobe::syntax
