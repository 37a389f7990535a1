// The rules for what items are made of: parameters, types, bodies, `let`s and outputs.
#include "syntax/parser.h"

namespace lobe::syntax {

/// parameters = "(" [ name ":" type { "," name ":" type } ] ")"
std::vector<ParameterClause> Parser::parse_parameters()
{
    std::vector<ParameterClause> result;
    const Token open = current();
    if (!expect(TokenKind::left_parenthesis, "`(` and the parameters")) return result;
    while (!failed_ && !at(TokenKind::right_parenthesis)) {
        ParameterClause parameter;
        parameter.name = expect_identifier("the name of a parameter");
        if (at(TokenKind::identifier))
            fail_expected("`:` and a type", "a parameter is written `name: type`");
        expect(TokenKind::colon, "`:` and a type");
        parameter.type = parse_type();
        if (at(TokenKind::assign))
            fail_expected("`,` or `)`", "terms have no defaults; a `param` has one");
        result.push_back(std::move(parameter));
        if (!accept(TokenKind::comma)) break;
        if (at(TokenKind::right_parenthesis)) fail_expected("a parameter");
    }
    expect_closing(TokenKind::right_parenthesis, open,
                   result.empty() ? "a parameter or `)`" : "`,` or `)`");
    return result;
}

/// type = name [ "in" range ]
TypeClause Parser::parse_type()
{
    TypeClause result;
    const std::uint32_t begin = current().begin;
    result.name = expect_identifier("a type");
    if (at_word("in")) {
        advance();
        result.range = parse_range();
    }
    result.span = span_from(begin);
    return result;
}

/// range = "[" expression "," expression "]"
RangeClause Parser::parse_range()
{
    RangeClause result;
    const Token open = current();
    if (at(TokenKind::left_parenthesis))
        fail_expected("`[`", "a range holds its ends and is written `[low, high]`");
    expect(TokenKind::left_bracket, "`[` and the ends of the range");
    result.low = parse_expression();
    expect(TokenKind::comma, "`,` and the upper end of the range");
    result.high = parse_expression();
    expect_closing(TokenKind::right_bracket, open, "`]`");
    result.span = span_from(open.begin);
    return result;
}

/// body = "=" expression | "{" { let } expression "}"
Body Parser::parse_body()
{
    Body result;
    const std::uint32_t begin = current().begin;
    if (at(TokenKind::assign) && ahead(1).kind == TokenKind::left_brace) {
        report_mended("a block stands without `=`", {index_, begin, ahead(1).begin}, "");
        advance();
    }
    if (at(TokenKind::left_brace)) {
        parse_block(result);
    } else {
        expect(TokenKind::assign, "`=` or `{` and the value");
        result.value = parse_expression();
    }
    result.span = span_from(begin);
    return result;
}

void Parser::parse_block(Body& body)
{
    body.block = true;
    const Token open = advance();
    bool lost = false;  // the value may be what was skipped
    while (at(TokenKind::word_let)) {
        body.lets.push_back(parse_let());
        lost = failed_;
        if (failed_) recover_in_block(false);
    }
    if (lost && at(TokenKind::right_brace)) {
        body.value = poison();
        advance();
        return;
    }
    body.value_comments = take_comments();
    body.value_blank_before = current().blank_before;
    if (at(TokenKind::right_brace)) {
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.message = "this block has no value";
        result.primary = {span(current()), "expected an expression before this"};
        if (!body.lets.empty())
            result.helps.emplace_back(
                "the last line of a block is its value; a line that starts with an operator "
                "continues the one before it, so put a negative value in parentheses");
        report(std::move(result));
        body.value = poison();
        advance();
        return;
    }
    if (at_word("return") && !ahead(1).first_on_line &&
        (ahead(1).kind == TokenKind::identifier || ahead(1).kind == TokenKind::number)) {
        report_mended("the last line of a block is its value",
                      {index_, current().begin, ahead(1).begin}, "");
        advance();
    }
    const Token first = current();
    body.value = parse_expression();
    if (at(TokenKind::assign) && std::holds_alternative<Name>(tree_[body.value].node)) {
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.message = "a name in a block is declared with `let`";
        result.primary = {span(first), ""};
        result.fix = Fix{{index_, first.begin, first.begin}, "let ", "declare it"};
        fail(std::move(result));
    } else if (at(TokenKind::word_let)) {
        Diagnostic result;
        result.code = Code::misplaced_item;
        result.message = "`let` stands before the value of a block";
        result.primary = {span(current()), ""};
        result.secondary = {{outer(body.value), "the value"}};
        fail(std::move(result));
    }
    if (failed_) {
        body.value = poison();
        for (recover_in_block(false); at(TokenKind::word_let); recover_in_block(false))
            body.lets.push_back(parse_let());
        accept(TokenKind::right_brace);
        return;
    }
    for (Comment& comment : take_comments()) {
        if (comment.doc) report_dangling(comment);
        body.value_comments.push_back(std::move(comment));
    }
    expect_closing(TokenKind::right_brace, open, "an operator or `}`");
}

/// let = "let" name "=" expression
Let Parser::parse_let()
{
    Let result;
    result.comments = take_comments();
    result.blank_before = current().blank_before;
    const Token keyword = advance();
    result.name = expect_identifier("a name");
    expect(TokenKind::assign, "`=` and a value");
    result.value = parse_expression();
    take_interior(result.comments);
    result.trailing = take_trailing();
    result.span = span_from(keyword.begin);
    return result;
}

Output Parser::parse_output()
{
    Output result;
    result.comments = take_comments();
    result.blank_before = current().blank_before;
    const std::uint32_t begin = current().begin;
    result.name = expect_identifier("the name of an output");
    if (at(TokenKind::identifier) && !current().first_on_line)
        fail_expected("`=` and the value of the output", "an output is written `name = value`");
    expect(TokenKind::assign, "`=` and the value of the output");
    result.value = parse_expression();
    take_interior(result.comments);
    result.trailing = take_trailing();
    result.span = span_from(begin);
    return result;
}

}  // namespace lobe::syntax
