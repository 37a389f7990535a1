// The rules for `gbuffer` items: settings, targets with their channels and facts, pins.
#include "syntax/parser.h"

#include <array>

namespace lobe::syntax {
namespace {

const LineWords& gbuffer_words()
{
    static const LineWords words{
        {"setting", "target", "pin"}, {}, "`setting`, `target`, `pin` or `}`", false};
    return words;
}

const LineWords& target_words()
{
    static const LineWords words{
        {"format", "exists", "field", "holds", "also", "changes", "channel"},
        {"setting", "target", "pin"},
        "`channel`, a fact about the target, or `}`",
        false};
    return words;
}

const LineWords& channel_words()
{
    static const LineWords words{{"format", "exists", "field", "holds", "also", "changes"},
                                 {"setting", "target", "pin", "channel"},
                                 "a fact about the channel, or `}`",
                                 false};
    return words;
}

template <class Lines>
std::vector<Comment>* comments_of_last(Lines& lines)
{
    return lines.empty() ? nullptr : &lines.back().comments;
}

}  // namespace

/// gbuffer = "gbuffer" name "{" { setting } { target } { pin } "}"
GbufferItem Parser::parse_gbuffer(Item& item)
{
    GbufferItem result;
    result.name = expect_identifier("the name of the gbuffer");
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{` and what the gbuffer has")) return result;
    take_interior(item.comments);

    while (at_line(gbuffer_words())) {
        const LineStart start = open_line(gbuffer_words());
        const Span first = span(current());
        const std::string word = line_word(gbuffer_words());
        if (word == "setting") {
            if (!result.targets.empty() || !result.pins.empty())
                report_misplaced(first, "settings stand before the targets and pins",
                                 {result.targets.empty() ? result.pins.front().span
                                                         : result.targets.front().name.span,
                                  "the first of them"});
            result.settings.push_back(parse_setting(start));
        } else if (word == "target") {
            if (!result.pins.empty())
                report_misplaced(first, "targets stand before the pins",
                                 {result.pins.front().name.span, "the first pin"});
            result.targets.push_back(parse_target(start));
        } else if (word == "pin") {
            result.pins.push_back(parse_pin(start));
        }
        if (failed_) recover_line(gbuffer_words(), start);
    }
    std::vector<Comment>* last = comments_of_last(result.pins);
    if (last == nullptr) last = comments_of_last(result.targets);
    if (last == nullptr) last = comments_of_last(result.settings);
    close_block(open, gbuffer_words(), last != nullptr ? *last : item.comments);
    return result;
}

/// setting = "setting" name text ":" name { "," name } "=" name
SettingItem Parser::parse_setting(LineStart start)
{
    SettingItem result;
    result.name = expect_identifier("the name of the setting");
    result.label = parse_string("what the engine calls it, in double quotes");
    expect(TokenKind::colon, "`:` and the values in their order");
    result.values = parse_names("the name of a value");
    expect(TokenKind::assign, "`,` or `=` and the default value");
    result.default_value = expect_identifier("the default value");
    close_line(result, std::move(start));
    return result;
}

/// target = "target" name text "{" { fact } { channel } "}"
TargetClause Parser::parse_target(LineStart start)
{
    TargetClause result;
    result.name = expect_identifier("the name of the target");
    result.label = parse_string("what the engine calls it, in double quotes");
    const Token open = current();
    if (expect(TokenKind::left_brace, "`{` and the channels of the target")) {
        take_interior(start.comments);
        while (at_line(target_words())) {
            const LineStart inner = open_line(target_words());
            const Span first = span(current());
            const std::string word = line_word(target_words());
            if (word == "channel") {
                result.channels.push_back(parse_channel(inner));
            } else if (!failed_) {
                if (!result.channels.empty())
                    report_misplaced(first, "what holds for a target stands before its channels",
                                     {result.channels.front().name.span, "the first channel"});
                result.facts.push_back(parse_fact(word, inner));
            }
            if (failed_) recover_line(target_words(), inner);
        }
        std::vector<Comment>* last = comments_of_last(result.channels);
        if (last == nullptr) last = comments_of_last(result.facts);
        close_block(open, target_words(), last != nullptr ? *last : start.comments);
    }
    close_line(result, std::move(start));
    return result;
}

/// channel = "channel" name text [ "{" { fact } "}" ]
ChannelClause Parser::parse_channel(LineStart start)
{
    ChannelClause result;
    result.name = expect_identifier("the name of the channel");
    result.label = parse_string("what the engine calls it, in double quotes");
    const Token open = current();
    if (accept(TokenKind::left_brace)) {
        take_interior(start.comments);
        while (at_line(channel_words())) {
            const LineStart inner = open_line(channel_words());
            const std::string word = line_word(channel_words());
            if (!failed_) result.facts.push_back(parse_fact(word, inner));
            if (failed_) recover_line(channel_words(), inner);
        }
        std::vector<Comment>* last = comments_of_last(result.facts);
        close_block(open, channel_words(), last != nullptr ? *last : start.comments);
    }
    close_line(result, std::move(start));
    return result;
}

/// fact = "format" storage [ when ] | "exists" when [ "else" expression ] | "field" text
///      | "holds" name text [ "lent" ] [ when ] | "also" text [ when ] | "changes" text [ when ]
FactClause Parser::parse_fact(const std::string& word, LineStart start)
{
    refuse_docs(start);
    FactClause result;
    if (word == "format") {
        result.kind = FactClause::Kind::format;
        result.storage = parse_storage();
        result.condition = parse_condition();
    } else if (word == "exists") {
        result.kind = FactClause::Kind::exists;
        expect_word("when", "`when` and a condition");
        result.condition = parse_before_else();
        refuse_assign();
        if (accept(TokenKind::word_else)) result.otherwise = parse_expression();
    } else if (word == "field") {
        result.kind = FactClause::Kind::field;
        result.text = parse_string("what shaders call it, in double quotes");
    } else if (word == "holds") {
        result.kind = FactClause::Kind::holds;
        result.name = expect_identifier("a name for the content");
        result.text = parse_string("what it holds, in double quotes");
        if (at_near_word("lent")) result.lent = expect_word("lent", "`lent` or `when`");
        result.condition = parse_condition();
    } else {
        const bool also = word == "also";
        result.kind = also ? FactClause::Kind::also : FactClause::Kind::changes;
        result.text = parse_string(also ? "who else reads it, in double quotes"
                                        : "who changes it, in double quotes");
        result.condition = parse_condition();
    }
    close_line(result, std::move(start));
    return result;
}

/// when = "when" expression
ExpressionId Parser::parse_condition()
{
    if (!at_near_word("when")) return {};
    expect_word("when", "`when` and a condition");
    const ExpressionId result = parse_expression();
    refuse_assign();
    return result;
}

/// pin = "pin" name text [ "in" range ] "=" expression
PinClause Parser::parse_pin(LineStart start)
{
    PinClause result;
    result.name = expect_identifier("the name of the pin");
    result.label = parse_string("what the editor calls it, in double quotes");
    if (at_word("in")) {
        advance();
        result.range = parse_range();
    }
    expect(TokenKind::assign, result.range ? "`=` and what it is when nothing is connected"
                                           : "`in` and a range, or `=` and a number");
    result.default_value = parse_expression();
    close_line(result, std::move(start));
    return result;
}

}  // namespace lobe::syntax
