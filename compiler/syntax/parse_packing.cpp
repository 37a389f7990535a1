// The rules for how parameters are stored and fed: `code`, `packing` and `engine` items.
#include "syntax/parser.h"

#include <utility>

namespace lobe::syntax {
namespace {

const LineWords& code_words()
{
    static const LineWords words{{"encode", "decode"}, {}, "`encode`, `decode` or `}`", false};
    return words;
}

const LineWords& packing_words()
{
    static const LineWords words{{"require", "supports", "over", "without"},
                                 {},
                                 "a field `target.channel = parameter : unorm 8`, a clause or `}`",
                                 true};
    return words;
}

const LineWords& engine_words()
{
    static const LineWords words{{"shading_model", "pin", "node", "color"},
                                 {},
                                 "`shading_model`, `pin`, `node`, `color` or `}`",
                                 false};
    return words;
}

}  // namespace

// ---- codes

/// code = "code" name "(" name ":" type ")" "{" encode decode "}"
CodeItem Parser::parse_code(Item& item)
{
    CodeItem result;
    result.name = expect_identifier("the name of the code");
    const Token open = current();
    expect(TokenKind::left_parenthesis, "`(` and what the code stores");
    result.value.name = expect_identifier("a name for what the code stores");
    expect(TokenKind::colon, "`:` and a type");
    result.value.type = parse_type();
    if (at(TokenKind::comma)) fail_expected("`)`", "a code stores one number");
    expect_closing(TokenKind::right_parenthesis, open, "`)`");
    parse_code_lines(result, item);
    if (!result.encode.valid()) result.encode = poison();
    if (!result.decode.valid()) result.decode = poison();
    return result;
}

/// encode = "encode" "=" expression        decode = "decode" "(" name ")" "=" expression
void Parser::parse_code_lines(CodeItem& code, Item& item)
{
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{`, `encode` and `decode`")) return;
    take_interior(item.comments);

    bool broken = false;
    Span decode_span;
    while (at_line(code_words())) {
        LineStart start = open_line(code_words());
        refuse_docs(start);
        const Span first = span(current());
        const std::string word = line_word(code_words());
        if (word == "encode") {
            if (code.encode.valid())
                report_misplaced(first, "a code has one `encode`",
                                 {outer(code.encode), "this one"});
            else if (code.decode.valid())
                report_misplaced(first, "`encode` stands before `decode`",
                                 {decode_span, "`decode`"});
            expect(TokenKind::assign, "`=` and what is stored");
            code.encode = parse_expression();
            take_interior(start.comments);
            code.encode_trailing = take_trailing();
            code.encode_comments = start.comments;
        } else if (word == "decode") {
            if (code.decode.valid())
                report_misplaced(first, "a code has one `decode`", {decode_span, "this one"});
            decode_span = first;
            const Token parenthesis = current();
            expect(TokenKind::left_parenthesis, "`(` and a name for what was stored");
            code.stored = expect_identifier("a name for what was stored");
            expect_closing(TokenKind::right_parenthesis, parenthesis, "`)`");
            expect(TokenKind::assign, "`=` and the value");
            code.decode = parse_expression();
            take_interior(start.comments);
            code.decode_trailing = take_trailing();
            code.decode_comments = start.comments;
        }
        if (!failed_) continue;
        broken = true;
        recover_line(code_words(), start);
    }
    const bool whole = broken || (code.encode.valid() && code.decode.valid());
    if (!whole && at(TokenKind::right_brace)) {
        Diagnostic missing;
        missing.code = Code::unexpected_token;
        missing.message =
            code.encode.valid() ? "this code has no `decode`" : "this code has no `encode`";
        missing.primary = {span(current()), "expected it before this"};
        missing.helps.emplace_back(
            "`encode = ...` says what is stored, `decode(u) = ...` what that means");
        report(std::move(missing));
    }
    close_block(open, code_words(), code.decode.valid() ? code.decode_comments : item.comments);
}

// ---- packings

/// packing = "packing" name "on" name "{" { field | clause } "}"
PackingItem Parser::parse_packing(Item& item)
{
    PackingItem result;
    result.model = expect_identifier("the name of a model");
    expect_word("on", "`on` and the name of a gbuffer");
    result.gbuffer = expect_identifier("the name of a gbuffer");
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{` and the fields")) return result;
    take_interior(item.comments);

    while (at_line(packing_words())) {
        const LineStart start = open_line(packing_words());
        const TokenKind next = ahead(1).kind;
        const bool field = at(TokenKind::identifier) &&
                           (next == TokenKind::dot || next == TokenKind::left_bracket ||
                            next == TokenKind::comma || next == TokenKind::assign);
        if (field) {
            result.lines.emplace_back(parse_field(start));
        } else if (const std::string word = line_word(packing_words()); !failed_) {
            result.lines.emplace_back(parse_clause(word, start));
        }
        if (!failed_) continue;
        recover_line(packing_words(), start);
    }
    std::vector<Comment>* last = &item.comments;
    if (!result.lines.empty())
        last = std::visit([](auto& line) { return &line.comments; }, result.lines.back());
    close_block(open, packing_words(), *last);
    return result;
}

/// field = slot { "," slot } "=" name [ "." name ] ":" storage [ "in" range ] [ code-clause ]
FieldClause Parser::parse_field(LineStart start)
{
    FieldClause result;
    do result.slots.push_back(parse_slot());
    while (accept(TokenKind::comma));
    expect(TokenKind::assign, "`=` and the name of a parameter");
    result.parameter = expect_identifier("the name of a parameter");
    if (accept(TokenKind::dot)) result.component = expect_identifier("`r`, `g` or `b`");
    expect(TokenKind::colon, "`:` and a storage such as `unorm 8`");
    result.storage = parse_storage();
    // Targets may have these names.
    if (at_word("in") && ahead(1).kind != TokenKind::dot) {
        advance();
        result.range = parse_range();
    }
    if (at_code_clause()) result.code = parse_code_clause();
    if (at_word("in") && ahead(1).kind == TokenKind::left_bracket && !result.range) {
        report_misplaced(span(current()), "the range stands before the code",
                         {result.code->span, "the code"});
        advance();
        result.range = parse_range();
    }
    close_line(result, std::move(start));
    return result;
}

/// slot = name "." name [ "[" number [ ".." number ] "]" ]
SlotClause Parser::parse_slot()
{
    SlotClause result;
    const std::uint32_t begin = current().begin;
    result.target = expect_identifier("the name of a target");
    expect(TokenKind::dot, "`.` and a channel");
    result.channels = expect_identifier("the name of a channel");
    const Token open = current();
    if (accept(TokenKind::left_bracket)) {
        result.low = parse_whole("the number of a bit");
        result.high = result.low;
        const bool habit = at(TokenKind::colon) || at(TokenKind::minus) || at(TokenKind::comma);
        if (habit)
            report_mended("the bits of a channel are written `[low..high]`", span(current()), "..");
        if (habit || at(TokenKind::dot_dot)) {
            advance();
            result.high = parse_whole("the number of the last bit");
        }
        expect_closing(TokenKind::right_bracket, open, "`..` or `]`");
        if (!failed_ && *result.low > *result.high) {
            std::swap(*result.low, *result.high);
            report_mended(
                "bits are written from the least to the most significant", span_from(open.begin),
                "[" + std::to_string(*result.low) + ".." + std::to_string(*result.high) + "]");
        }
    }
    result.span = span_from(begin);
    return result;
}

/// Whether `code` goes on with a field, rather than start an item or a line about a target.
bool Parser::at_code_clause() const
{
    if (!at_word("code") || ahead(1).kind == TokenKind::dot) return false;
    const bool item = current().first_on_line && ahead(2).kind == TokenKind::left_parenthesis &&
                      ahead(3).kind == TokenKind::identifier && ahead(4).kind == TokenKind::colon;
    return !item;
}

/// code-clause = "code" name [ "(" expression { "," expression } ")" ]
CodeClause Parser::parse_code_clause()
{
    CodeClause result;
    const std::uint32_t begin = advance().begin;
    result.name = expect_identifier("the name of a code");
    const Token open = current();
    if (accept(TokenKind::left_parenthesis)) {
        do result.arguments.push_back(parse_expression());
        while (accept(TokenKind::comma));
        expect_closing(TokenKind::right_parenthesis, open, "`,` or `)`");
    }
    result.span = span_from(begin);
    return result;
}

/// clause = "require" requirement | "supports" name "==" name { "," name } | "over" name "in" range
///        | "without" name { "," name }
PackingClause Parser::parse_clause(const std::string& word, LineStart start)
{
    refuse_docs(start);
    PackingClause result;
    if (word == "require") {
        parse_requirement(result);
    } else if (word == "supports") {
        result.kind = PackingClause::Kind::supports;
        result.name = expect_identifier("the name of a setting");
        refuse_assign();
        expect(TokenKind::equal, "`==` and the values that have to work");
        result.names = parse_names("a value of the setting");
    } else if (word == "over") {
        result.kind = PackingClause::Kind::over;
        result.name = expect_identifier("a field of the surface, or a parameter");
        expect_word("in", "`in` and a range");
        result.range = parse_range();
    } else {
        result.kind = PackingClause::Kind::without;
        result.names = parse_names("what a channel of the gbuffer holds");
    }
    close_line(result, std::move(start));
    return result;
}

/// requirement = "exact" name "==" sum { "," name "==" sum } | "radiance" "error" "<" number "%"
void Parser::parse_requirement(PackingClause& clause)
{
    if (expect_one_of({"exact", "radiance"}, "`exact` or `radiance error`") == "exact") {
        clause.kind = PackingClause::Kind::exact;
        do {
            PackingClause::Exact exact;
            exact.parameter = expect_identifier("the name of a parameter");
            refuse_assign();
            expect(TokenKind::equal, "`==` and a value");
            exact.value = parse_sum();
            clause.exact.push_back(std::move(exact));
        } while (accept(TokenKind::comma));
        return;
    }
    clause.kind = PackingClause::Kind::radiance;
    expect_word("error", "`error <` and a number in percent");
    expect(TokenKind::less, "`<` and a number in percent");
    const bool number = at(TokenKind::number) || at(TokenKind::bad_number);
    if (!number) fail_expected("a number in percent");
    clause.limit = number ? parse_primary() : poison();
    expect(TokenKind::percent, "`%`");
}

// ---- engines

/// engine = "engine" name "for" name "{" { line } "}"
EngineItem Parser::parse_engine(Item& item)
{
    EngineItem result;
    result.gbuffer = expect_identifier("the name of a gbuffer");
    expect_word("for", "`for` and the name of a model");
    result.model = expect_identifier("the name of a model");
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{` and what the editor shows")) return result;
    take_interior(item.comments);

    while (at_line(engine_words())) {
        const LineStart start = open_line(engine_words());
        const std::string word = line_word(engine_words());
        if (!failed_) result.lines.push_back(parse_engine_line(word, start));
        if (failed_) recover_line(engine_words(), start);
    }
    close_block(open, engine_words(),
                result.lines.empty() ? item.comments : result.lines.back().comments);
    return result;
}

/// line = "shading_model" text | "pin" name "=" name [ text ] | "node" text "{" names "}"
///      | "color" "(" expression "," expression "," expression ")"
EngineClause Parser::parse_engine_line(const std::string& word, LineStart start)
{
    refuse_docs(start);
    EngineClause result;
    if (word == "shading_model") {
        result.kind = EngineClause::Kind::shading_model;
        result.text = parse_string("what the editor calls it, in double quotes");
    } else if (word == "pin") {
        result.kind = EngineClause::Kind::pin;
        result.name = expect_identifier("the name of a pin");
        expect(TokenKind::assign, "`=` and the parameter that it feeds");
        result.parameter = expect_identifier("the name of a parameter");
        if (at(TokenKind::string)) result.text = parse_string("a label");
    } else if (word == "node") {
        result.kind = EngineClause::Kind::node;
        result.text = parse_string("the name of the node in double quotes");
        parse_node_inputs(result, start);
    } else {
        result.kind = EngineClause::Kind::color;
        parse_color(result);
    }
    close_line(result, std::move(start));
    return result;
}

void Parser::parse_node_inputs(EngineClause& node, const LineStart& start)
{
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{` and the parameters that it feeds")) return;
    node.names = parse_names("the name of a parameter");
    expect_closing(TokenKind::right_brace, open, "`,` or `}`");
    if (!failed_) return;
    recover_line(engine_words(), start);
    accept(TokenKind::right_brace);
}

void Parser::parse_color(EngineClause& color)
{
    const Token open = current();
    expect(TokenKind::left_parenthesis, "`(` and red, green and blue");
    color.color.push_back(parse_expression());
    expect(TokenKind::comma, "`,` and green");
    color.color.push_back(parse_expression());
    expect(TokenKind::comma, "`,` and blue");
    color.color.push_back(parse_expression());
    expect_closing(TokenKind::right_parenthesis, open, "`)`");
}

}  // namespace lobe::syntax
