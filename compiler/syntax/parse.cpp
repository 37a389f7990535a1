#include "syntax/parse.h"

#include "base/utf8.h"
#include "syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lobe::syntax {
namespace {

constexpr std::size_t largest_file = std::size_t{8} << 20;

/// The words that start an item.
constexpr std::array<std::string_view, 13> item_words{
    "module", "import", "source",  "tier", "param",   "term",   "form",
    "effect", "model",  "gbuffer", "code", "packing", "engine",
};

bool closes(TokenKind kind)
{
    return kind == TokenKind::right_parenthesis || kind == TokenKind::right_bracket ||
           kind == TokenKind::right_brace;
}

Diagnostic not_utf8_error(std::uint32_t index, std::string_view text, std::size_t offset)
{
    Diagnostic result;
    result.code = Code::not_utf8;
    const auto byte = static_cast<unsigned>(static_cast<unsigned char>(text[offset]));
    result.message =
        fmt::format("this file is not UTF-8: byte 0x{:02X} at offset {}", byte, offset);
    const auto begin = static_cast<std::uint32_t>(offset);
    result.primary = {{index, begin, begin + 1}, "starts no character"};
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        result.helps.emplace_back("the file starts like UTF-16; save it as UTF-8");
    else
        result.helps.emplace_back("save the file as UTF-8");
    return result;
}

/// What makes a text unfit for parsing as a whole.
std::optional<Diagnostic> unfit(const Source& source, std::uint32_t index)
{
    const std::string& text = source.text();
    if (text.size() > largest_file) {
        Diagnostic result;
        result.code = Code::file_too_large;
        result.message = fmt::format("this file has {} bytes; at most {} are accepted", text.size(),
                                     largest_file);
        result.primary = {{index, 0, 0}, ""};
        result.helps.emplace_back("split it into modules that import each other's terms");
        return result;
    }
    if (const std::size_t offset = first_not_utf8(text); offset < text.size())
        return not_utf8_error(index, text, offset);
    return std::nullopt;
}

}  // namespace

Tree parse(const Sources& sources, std::uint32_t source, Diagnostics& diagnostics)
{
    if (auto refusal = unfit(sources[source], source)) {
        diagnostics.report(*std::move(refusal));
        Tree tree;
        tree.source = source;
        return tree;
    }
    return Parser{sources[source], source, diagnostics}.run();
}

Parser::Parser(const Source& source, std::uint32_t index, Diagnostics& diagnostics)
    : source_(source), index_(index), diagnostics_(diagnostics), tokens_(lex(source.text(), index))
{
    tree_.source = index;
    // Each expression takes a token at least; growing in steps would need up to three times the
    // memory for a moment. What is not used is never touched.
    tree_.expressions.reserve(tokens_.all.size());
    heights_.reserve(tokens_.all.size());
    outer_.reserve(tokens_.all.size());
}

Tree Parser::run()
{
    const std::uint32_t end = tokens_.all.back().end;
    parse_module();
    while (!at(TokenKind::end) && errors_ < most_errors) parse_item();

    if (errors_ < most_errors) report_problems(end + 1);
    tree_.footer = take_comments();
    for (const Comment& comment : tree_.footer)
        if (comment.doc) report_dangling(comment);

    if (tree_.items.empty() && errors_ == 0) {
        Diagnostic nothing;
        nothing.code = Code::empty_file;
        nothing.message = tokens_.all.size() > 1 ? "this module declares nothing"
                          : tokens_.comments.empty()
                              ? "this file is empty"
                              : "this file has comments, but declares nothing";
        nothing.primary = {tree_.module ? tree_.module->span : Span{index_, 0, 0}, ""};
        nothing.helps.emplace_back("a file is `module name`, then terms, parameters and models");
        report(std::move(nothing));
    }
    return std::move(tree_);
}

// ---- errors

void Parser::report(Diagnostic diagnostic)
{
    if (errors_ >= most_errors) return;
    if (++errors_ == most_errors)
        diagnostic.notes.push_back(fmt::format(
            "this is error {} of this file; what comes after it was not checked", most_errors));
    diagnostics_.report(std::move(diagnostic));
}

void Parser::report_problems(std::uint32_t before)
{
    for (; next_problem_ < tokens_.problems.size(); ++next_problem_) {
        const Problem& problem = tokens_.problems[next_problem_];
        if (problem.begin >= before) return;
        if (errors_ < most_errors) report(describe(problem, source_.text(), index_));
    }
}

void Parser::fail(Diagnostic diagnostic)
{
    if (failed_) return;
    const Token token = current();
    report_problems(token.begin);
    // What forms no token has its own message.
    const bool has_problem =
        token.kind == TokenKind::unknown || (next_problem_ < tokens_.problems.size() &&
                                             tokens_.problems[next_problem_].begin < token.end);
    if (has_problem)
        report_problems(token.end);
    else
        report(std::move(diagnostic));
    failed_ = true;
    stop_ = {TokenKind::end, false, false, token.begin, token.begin};
}

void Parser::fail_expected(std::string_view what, std::string help)
{
    Diagnostic result;
    result.code = Code::unexpected_token;
    if (position_ > 0 && (current().first_on_line || at(TokenKind::end))) {
        // The next line is not to blame: something is missing where the last one ends.
        result.message = fmt::format("expected {} after {}", what, words(previous()));
        result.primary = {{index_, previous().end, previous().end}, ""};
    } else {
        result.message = fmt::format("expected {}, found {}", what, words(current()));
        result.primary = {span(current()), ""};
    }
    if (help.empty() && at(TokenKind::dot_dot))
        help =
            "a range is written `[low, high]`; `..` stands between the bits of a channel and the "
            "ends of a sum";
    if (!help.empty()) result.helps.push_back(std::move(help));
    fail(std::move(result));
}

/// For what can only mean one thing: reports it with the edit, and parsing goes on as if the edit
/// had been made.
void Parser::report_mended(std::string message, const Span& span, std::string replacement)
{
    if (failed_) return;
    Diagnostic result;
    result.code = Code::unexpected_token;
    result.message = std::move(message);
    result.primary = {span, ""};
    const std::size_t begin = replacement.find_first_not_of(' ');
    const std::string what = begin == std::string::npos
                                 ? std::string{"leave it out"}
                                 : fmt::format("write `{}`", replacement.substr(begin));
    result.fix = Fix{span, std::move(replacement), what};
    report(std::move(result));
}

// ---- tokens

const Token& Parser::current() const { return failed_ ? stop_ : tokens_.all[position_]; }

const Token& Parser::ahead(std::size_t distance) const
{
    if (failed_) return stop_;
    return tokens_.all[std::min(position_ + distance, tokens_.all.size() - 1)];
}

Token Parser::advance()
{
    const Token token = current();
    if (failed_ || token.kind == TokenKind::end) return token;
    report_problems(token.end);
    ++position_;
    return token;
}

std::string_view Parser::text(const Token& token) const
{
    return std::string_view{source_.text()}.substr(token.begin, token.end - token.begin);
}

bool Parser::at_word(std::string_view word) const
{
    return at(TokenKind::identifier) && text(current()) == word;
}

bool Parser::starts_item(std::size_t position) const
{
    const Token& token = tokens_.all[position];
    if (token.kind != TokenKind::identifier || !token.first_on_line) return false;
    // Its name stands beside it; a word on a line of its own may be the value of a term.
    const Token& next = tokens_.all[position + 1];
    return !next.first_on_line &&
           (next.kind == TokenKind::identifier || next.kind == TokenKind::string) &&
           std::find(item_words.begin(), item_words.end(), text(token)) != item_words.end();
}

bool Parser::at_likely_item() const
{
    const Token& token = current();
    if (token.kind != TokenKind::identifier || !token.first_on_line) return false;
    const bool unindented = token.begin == 0 || source_.text()[token.begin - 1] == '\n';
    const TokenKind after = ahead(2).kind;
    const bool joins = text(ahead(2)) == "on" || text(ahead(2)) == "for";
    return unindented && ahead(1).kind == TokenKind::identifier &&
           (after == TokenKind::left_parenthesis || after == TokenKind::left_brace ||
            after == TokenKind::colon || after == TokenKind::assign || joins);
}

bool Parser::accept(TokenKind kind)
{
    if (!at(kind)) return false;
    advance();
    return true;
}

bool Parser::expect(TokenKind kind, std::string_view what)
{
    if (accept(kind)) return true;
    fail_expected(what);
    return false;
}

bool Parser::expect_word(std::string_view word, std::string_view what)
{
    if (at_word(word)) {
        advance();
        return true;
    }
    // A misspelt word is taken for the one that it should be.
    if (at(TokenKind::identifier) && nearest(text(current()), {std::string{word}})) {
        Diagnostic misspelt;
        misspelt.code = Code::unexpected_token;
        misspelt.message = fmt::format("expected {}, found {}", what, words(current()));
        misspelt.primary = {span(current()), ""};
        misspelt.fix = Fix{span(current()), std::string{word}, fmt::format("write `{}`", word)};
        report(std::move(misspelt));
        advance();
        return true;
    }
    fail_expected(what);
    return false;
}

void Parser::expect_closing(TokenKind kind, const Token& open, std::string_view what)
{
    if (failed_ || accept(kind)) return;
    // `(` … at the end of a line, and then `name =`: that name is the next output, not an operand.
    const bool read_too_far = at(TokenKind::assign) && kind != TokenKind::right_brace &&
                              previous().kind == TokenKind::identifier && previous().first_on_line;
    if (read_too_far) --position_;
    const bool next_line =
        at(TokenKind::identifier) && current().first_on_line && ahead(1).kind == TokenKind::assign;
    const bool next_in_block =
        kind != TokenKind::right_brace && (read_too_far || next_line || at(TokenKind::word_let));
    const bool over = next_in_block || at(TokenKind::end) || at_item() || closes(current().kind);
    if (over) {
        fail_unclosed(open, what);
        return;
    }
    Diagnostic result;
    result.code = Code::unexpected_token;
    result.message = fmt::format("expected {}, found {}", what, words(current()));
    result.primary = {span(current()), ""};
    result.secondary = {{span(open), "opened here"}};
    fail(std::move(result));
}

void Parser::fail_unclosed(const Token& open, std::string_view what)
{
    Diagnostic result;
    result.code = Code::unclosed_bracket;
    result.message = fmt::format("this `{}` is not closed", text(open));
    result.primary = {span(open), ""};
    if (!at(TokenKind::end))
        result.secondary = {{span(current()), fmt::format("expected {} before this", what)}};
    else
        result.notes.push_back("the file ends before it is closed");
    fail(std::move(result));
}

Identifier Parser::expect_identifier(std::string_view what)
{
    if (!at(TokenKind::identifier) || at_item() || at_block_line()) {
        fail_expected(what);
        return {"", span(current())};
    }
    const Token token = advance();
    return {std::string{text(token)}, span(token)};
}

std::string Parser::words(const Token& token) const
{
    constexpr std::size_t longest = 40;
    if (token.kind == TokenKind::end) return "the end of the file";
    if (token.kind == TokenKind::string) return "a text";
    if (token.end - token.begin > longest) return "a long word";
    return fmt::format("`{}`", text(token));
}

Span Parser::span_from(std::uint32_t begin) const
{
    return {index_, begin, std::max(begin, previous().end)};
}

// ---- recovery

void Parser::recover()
{
    failed_ = false;
    in_then_ = false;
    while (!at(TokenKind::end) && !at_item() && !at_likely_item()) advance();
}

void Parser::recover_in_block(bool outputs)
{
    failed_ = false;
    in_then_ = false;
    int open = 0;
    while (!at(TokenKind::end) && !at_item()) {
        if (open == 0 && (at(TokenKind::word_let) || at(TokenKind::right_brace))) return;
        const bool output = at(TokenKind::identifier) && current().first_on_line &&
                            ahead(1).kind == TokenKind::assign;
        if (outputs && output && open == 0) return;
        if (at(TokenKind::left_brace)) ++open;
        if (at(TokenKind::right_brace)) --open;
        advance();
    }
}

// ---- comments

std::vector<Comment> Parser::take_comments()
{
    std::vector<Comment> result;
    for (; next_comment_ < tokens_.comments.size(); ++next_comment_) {
        PlacedComment& placed = tokens_.comments[next_comment_];
        if (placed.comment.span.begin >= tokens_.all[position_].begin) break;
        result.push_back(std::move(placed.comment));
    }
    return result;
}

void Parser::take_interior(std::vector<Comment>& into)
{
    if (failed_) return;
    for (; next_comment_ < tokens_.comments.size(); ++next_comment_) {
        PlacedComment& placed = tokens_.comments[next_comment_];
        if (placed.comment.span.begin >= previous().end) return;
        if (placed.comment.doc) report_dangling(placed.comment);
        into.push_back(std::move(placed.comment));
    }
}

std::vector<Comment> Parser::take_trailing()
{
    std::vector<Comment> result;
    if (failed_) return result;
    for (; next_comment_ < tokens_.comments.size(); ++next_comment_) {
        PlacedComment& placed = tokens_.comments[next_comment_];
        if (placed.own_line || placed.comment.span.begin >= current().begin) break;
        if (placed.comment.doc) report_dangling(placed.comment);
        result.push_back(std::move(placed.comment));
    }
    return result;
}

void Parser::report_dangling(const Comment& comment, std::string label)
{
    Diagnostic result;
    result.code = Code::dangling_doc;
    result.message = "this doc comment documents nothing";
    result.primary = {comment.span, std::move(label)};
    result.helps.emplace_back(
        "a doc comment stands on its own lines, before what it documents; other comments start "
        "with `//`");
    report(std::move(result));
}

}  // namespace lobe::syntax
