// The rules for items: what stands between two declarations, and each kind of declaration.
#include "syntax/parser.h"

#include <fmt/format.h>

namespace lobe::syntax {
namespace {

const std::vector<std::string>& item_keywords()
{
    static const std::vector<std::string> words{"import",  "source", "tier",  "param",   "term",
                                                "effect",  "model",  "light", "gbuffer", "code",
                                                "packing", "engine", "form",  "module"};
    return words;
}

Diagnostic misplaced(const Span& span, std::string message)
{
    Diagnostic result;
    result.code = Code::misplaced_item;
    result.message = std::move(message);
    result.primary = {span, ""};
    return result;
}

}  // namespace

/// module-line = "module" name
void Parser::parse_module()
{
    tree_.header = take_comments();
    tree_.module_blank_before = current().blank_before && !tree_.header.empty();
    if (at(TokenKind::end)) {
        tree_.footer = std::move(tree_.header);
        tree_.header.clear();
        return;
    }
    if (at_word("module")) {
        advance();
        const Identifier name = expect_identifier("the name of the module");
        if (!name.text.empty()) tree_.module = name;
        if (failed_) recover();
        return;
    }
    if (at(TokenKind::unknown)) {
        recover();
        return;
    }
    // A misspelt `module` is one mistake, not two.
    const bool misspelt =
        at(TokenKind::identifier) && !at_item() && nearest(text(current()), {"module"}).has_value();
    Diagnostic result = misplaced(span(current()), "a file starts with `module` and its name");
    result.primary.text = "`module` stands before this";
    if (misspelt) result.fix = Fix{span(current()), "module", "write `module`"};
    report(std::move(result));
    if (!misspelt) return;
    advance();
    tree_.module = expect_identifier("the name of the module");
    if (failed_) recover();
}

void Parser::parse_item()
{
    const std::size_t start = position_;
    block_ = nullptr;
    Item item;
    item.comments = take_comments();
    item.blank_lines_before = current().blank_before ? 1 : 0;
    const std::uint32_t begin = current().begin;

    std::string keyword = at(TokenKind::identifier) ? std::string{text(current())} : "";
    if (!keyword.empty() && !starts_item(position_) && current().first_on_line) {
        const auto meant = nearest(keyword, item_keywords());
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.primary = {span(current()), ""};
        if (meant && *meant != keyword) {
            // Taken for what was meant, so that its name is known to the rest of the program.
            result.message = fmt::format("unknown item `{}`; did you mean `{}`?", keyword, *meant);
            result.fix = Fix{span(current()), *meant, fmt::format("write `{}`", *meant)};
            report(std::move(result));
            keyword = *meant;
        } else if (!meant) {
            result.message = fmt::format("expected a declaration, found {}", words(current()));
            result.helps.emplace_back(
                "declarations start with `import`, `source`, `tier`, `param`, `term`, `effect`, "
                "`model`, `light`, `gbuffer`, `code`, `packing` or `engine`");
            fail(std::move(result));
        }
    } else if (keyword.empty() || !current().first_on_line) {
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.message =
            position_ > 0 && !current().first_on_line
                ? fmt::format("expected the end of the declaration, found {}", words(current()))
                : fmt::format("expected a declaration, found {}", words(current()));
        result.primary = {span(current()), ""};
        if (at(TokenKind::word_let))
            result.helps.emplace_back(
                "a value that terms share is a `param`, or a `term` without parameters");
        fail(std::move(result));
    }

    auto node = failed_ ? std::nullopt : parse_item_node(keyword, item);
    take_interior(item.comments);
    item.trailing = take_trailing();
    if (failed_) {
        failed_ = false;
        if (position_ == start) advance();
        recover();
    }
    if (!node) return;
    item.span = span_from(begin);
    item.node = *std::move(node);
    tree_.items.push_back(std::move(item));
}

/// The item behind a keyword, or nothing if not even its name could be read.
std::optional<Parser::ItemNode> Parser::parse_item_node(std::string_view keyword, Item& item)
{
    const auto named = [](auto node) {
        return node.name.text.empty() ? std::nullopt : std::optional<ItemNode>{std::move(node)};
    };
    const Token word = advance();
    if (keyword != "import" && !first_not_import_) first_not_import_ = span(word);

    if (keyword == "import") {
        if (first_not_import_) {
            Diagnostic result = misplaced(span(word), "imports stand before other declarations");
            result.secondary = {{*first_not_import_, "the first declaration"}};
            report(std::move(result));
        }
        Import import = parse_import();
        if (import.module.text.empty()) return std::nullopt;
        return import;
    }
    if (keyword == "source") return named(parse_source());
    if (keyword == "tier") return parse_tier();
    if (keyword == "param") return named(parse_param());
    if (keyword == "term") return named(parse_term(item));
    if (keyword == "effect") return parse_effect();
    if (keyword == "model" || keyword == "light")
        return named(parse_model(item, keyword == "light"));
    if (keyword == "gbuffer") return named(parse_gbuffer(item));
    if (keyword == "code") return named(parse_code(item));
    const auto joined = [](auto node) {
        const bool whole = !node.model.text.empty() && !node.gbuffer.text.empty();
        return whole ? std::optional<ItemNode>{std::move(node)} : std::nullopt;
    };
    if (keyword == "packing") return joined(parse_packing(item));
    if (keyword == "engine") return joined(parse_engine(item));

    if (keyword == "form") {
        Diagnostic result = misplaced(span(word), "this form belongs to no term");
        result.helps.emplace_back("forms stand directly after the term that they compute");
        fail(std::move(result));
    } else {
        Diagnostic result = misplaced(span(word), "a file has one `module` line");
        if (tree_.module) result.secondary = {{tree_.module->span, "the module has this name"}};
        fail(std::move(result));
    }
    return std::nullopt;
}

/// import = "import" name "{" name { "," name } "}"
Import Parser::parse_import()
{
    Import result;
    result.module = expect_identifier("the name of a module");
    const Token open = current();
    if (!expect(TokenKind::left_brace, "`{` and the names to import")) return result;
    do result.names.push_back(expect_identifier("a name to import"));
    while (accept(TokenKind::comma));
    expect_closing(TokenKind::right_brace, open, "`,` or `}`");
    if (failed_) std::erase_if(result.names, [](const auto& name) { return name.text.empty(); });
    return result;
}

std::string Parser::parse_string(std::string_view what)
{
    if (!at(TokenKind::string)) {
        fail_expected(what);
        return {};
    }
    return unquote(text(advance()));
}

/// source = "source" name "=" text
SourceItem Parser::parse_source()
{
    SourceItem result;
    result.name = expect_identifier("the name of the source");
    expect(TokenKind::assign, "`=` and the title in double quotes");
    result.text = parse_string("the title in double quotes");
    return result;
}

/// tier = "tier" name { "," name }
TierItem Parser::parse_tier()
{
    TierItem result;
    do {
        Identifier name = expect_identifier("the name of a tier");
        if (!name.text.empty()) result.names.push_back(std::move(name));
    } while (accept(TokenKind::comma));
    if (at(TokenKind::identifier) && !current().first_on_line) fail_expected("`,` between tiers");
    return result;
}

/// param = "param" name ":" type [ "=" default ] [ tier ] [ text ]
/// The tier stands on the line on which the default ends: a word on the next line starts an item.
ParamItem Parser::parse_param()
{
    ParamItem result;
    result.name = expect_identifier("the name of the parameter");
    expect(TokenKind::colon, "`:` and a type");
    result.type = parse_type();
    expect(TokenKind::assign, "`=` and the default");
    parse_default(result);
    if (at(TokenKind::identifier) && !current().first_on_line)
        result.tier = expect_identifier("a tier");
    if (at(TokenKind::string)) result.label = parse_string("a label");
    if (result.label && !result.tier && at(TokenKind::identifier) && !current().first_on_line) {
        Diagnostic late = misplaced(span(current()), "the tier stands before the label");
        report(std::move(late));
        result.tier = expect_identifier("a tier");
    }
    return result;
}

/// default = expression | "(" expression "," expression { "," expression } ")"
void Parser::parse_default(ParamItem& param)
{
    const Token first = current();
    // A list if a comma stands directly inside the first parentheses.
    bool list = false;
    int depth = 0;
    for (std::size_t i = position_; at(TokenKind::left_parenthesis); ++i) {
        const TokenKind kind = tokens_.all[i].kind;
        if (kind == TokenKind::left_parenthesis) ++depth;
        if (kind == TokenKind::right_parenthesis) --depth;
        list = kind == TokenKind::comma && depth == 1;
        if (list || depth == 0 || kind == TokenKind::end) break;
    }
    if (list) {
        advance();
        do param.default_value.push_back(parse_expression());
        while (accept(TokenKind::comma));
        expect_closing(TokenKind::right_parenthesis, first, "`,` or `)`");
    } else {
        param.default_value.push_back(parse_expression());
    }
    param.default_span = span_from(first.begin);
}

/// term = "term" name parameters [ "->" type ] body { form }
TermItem Parser::parse_term(Item& item)
{
    TermItem result;
    result.name = expect_identifier("the name of the term");
    result.parameters = parse_parameters();
    const bool double_arrow = at(TokenKind::assign) && ahead(1).kind == TokenKind::greater &&
                              ahead(1).begin == current().end;
    if (at(TokenKind::colon) || double_arrow) {
        const bool colon = at(TokenKind::colon);
        const Span arrow = join(span(current()), span(colon ? current() : ahead(1)));
        report_mended("the type of a result stands behind `->`", arrow, colon ? " ->" : "->");
        advance();
        if (!colon) advance();
        result.result = parse_type();
    } else if (accept(TokenKind::arrow)) {
        result.result = parse_type();
    }
    result.body = parse_body();
    take_interior(item.comments);
    result.body.trailing = take_trailing();
    if (failed_) {
        recover();
        if (!at_word("form")) return result;
    }
    while (at_word("form") && ahead(1).kind == TokenKind::identifier) {
        result.forms.push_back(parse_form());
        if (failed_) recover();
    }
    return result;
}

/// form = "form" name body
Form Parser::parse_form()
{
    Form result;
    result.comments = take_comments();
    const Token keyword = advance();
    result.name = expect_identifier("the name of the form");
    result.body = parse_body();
    take_interior(result.comments);
    result.body.trailing = take_trailing();
    result.span = span_from(keyword.begin);
    return result;
}

/// effect = "effect" text "off" "when" expression
EffectItem Parser::parse_effect()
{
    EffectItem result;
    result.name_span = span(current());
    result.name = parse_string("the name of the effect in double quotes");
    expect_word("off", "`off when` and a condition");
    expect_word("when", "`when` and a condition");
    result.off_when = parse_expression();
    refuse_assign();
    return result;
}

/// model = ( "model" | "light" ) name parameters "{" { let } { name "=" expression } "}"
ModelItem Parser::parse_model(Item& item, bool is_light)
{
    const std::string_view what = is_light ? "light" : "model";
    ModelItem result;
    result.is_light = is_light;
    result.name = expect_identifier(fmt::format("the name of the {}", what));
    result.parameters = parse_parameters();
    const Token open = current();
    if (!expect(TokenKind::left_brace, fmt::format("`{{` and the outputs of the {}", what)))
        return result;

    while (!at(TokenKind::right_brace) && !at(TokenKind::end) && !at_item()) {
        if (at(TokenKind::word_let)) {
            if (!result.outputs.empty()) {
                Diagnostic late = misplaced(span(current()), "`let` stands before the outputs");
                late.secondary = {{result.outputs.front().name.span, "the first output"}};
                report(std::move(late));
            }
            result.lets.push_back(parse_let());
        } else if (at(TokenKind::identifier)) {
            result.outputs.push_back(parse_output());
        } else {
            fail_expected("an output `name = value`, or `}`");
        }
        if (failed_) recover_in_block(true);
    }
    std::vector<Comment> late = take_comments();
    auto& last = !result.outputs.empty() ? result.outputs.back().comments
                 : !result.lets.empty()  ? result.lets.back().comments
                                         : item.comments;
    for (Comment& comment : late) {
        if (comment.doc) report_dangling(comment);
        last.push_back(std::move(comment));
    }
    expect_closing(TokenKind::right_brace, open, "an output `name = value`, or `}`");
    return result;
}

}  // namespace lobe::syntax
