// `code`, `packing` and `engine` items to canonical text. The `=` and `:` of fields that follow
// each other stand below each other.
#include "syntax/format_items.h"
#include "syntax/lex.h"

#include <fmt/format.h>

namespace lobe::syntax {
namespace {

constexpr std::size_t step = LineWriter::step;

std::string text_of(const SlotClause& slot)
{
    const std::string name = fmt::format("{}.{}", slot.target.text, slot.channels.text);
    if (!slot.low) return name;
    if (*slot.low == *slot.high) return fmt::format("{}[{}]", name, *slot.low);
    return fmt::format("{}[{}..{}]", name, *slot.low, *slot.high);
}

Cell pieces(const LineWriter& writer, const CodeClause& code)
{
    if (code.arguments.empty()) return {{"code " + code.name.text}};
    std::vector<std::string> arguments;
    for (const ExpressionId id : code.arguments) arguments.push_back(writer.expressions().flat(id));
    Cell result = list(fmt::format("code {}(", code.name.text), arguments);
    result.back().text += ')';
    return result;
}

Line line(const LineWriter& writer, const FieldClause& field)
{
    std::vector<std::string> slots;
    for (const SlotClause& slot : field.slots) slots.push_back(text_of(slot));
    const std::string component = field.component ? "." + field.component->text : "";
    Cell stored{{fmt::format(": {} {}", field.storage.kind.text, field.storage.bits)}};
    if (field.range) stored.push_back({"in " + writer.range(*field.range)});
    if (field.code)
        for (Piece& piece : pieces(writer, *field.code)) stored.push_back(std::move(piece));
    return line_of(field,
                   {list("", slots),
                    {{fmt::format("= {}{}", field.parameter.text, component)}},
                    std::move(stored)},
                   true);
}

Cell pieces(const LineWriter& writer, const PackingClause& clause)
{
    switch (clause.kind) {
    case PackingClause::Kind::exact: {
        std::vector<std::string> items;
        for (const PackingClause::Exact& exact : clause.exact) {
            const std::string value = writer.expressions().flat(exact.value);
            const bool parentheses = writer.expressions().parenthesize_as_sum(exact.value);
            items.push_back(fmt::format("{} == {}", exact.parameter.text,
                                        parentheses ? fmt::format("({})", value) : value));
        }
        return list("require exact ", items);
    }
    case PackingClause::Kind::radiance:
        return {
            {fmt::format("require radiance error < {}%", writer.expressions().flat(clause.limit))}};
    case PackingClause::Kind::supports:
        return list(fmt::format("supports {} == ", clause.name.text), clause.names);
    case PackingClause::Kind::over:
        return {{fmt::format("over {}", clause.name.text)}, {"in " + writer.range(*clause.range)}};
    case PackingClause::Kind::without: break;
    }
    return list("without ", clause.names);
}

Line line(const LineWriter& writer, const PackingClause& clause)
{
    return line_of(clause, {pieces(writer, clause)}, false);
}

Line line(const LineWriter& writer, const EngineClause& clause)
{
    const std::string text = quote(clause.text.value_or(""));
    switch (clause.kind) {
    case EngineClause::Kind::shading_model:
        return line_of(clause, {{{"shading_model"}, {text}}}, false);
    case EngineClause::Kind::pin: {
        std::vector<Cell> cells{{{fmt::format("pin {}", clause.name.text)}},
                                {{fmt::format("= {}", clause.parameter.text)}}};
        if (clause.text) cells.push_back({{text}});
        return line_of(clause, std::move(cells), true);
    }
    case EngineClause::Kind::node: {
        std::vector<Cell> cells{{{"node"}, {text + " {"}}, list("", clause.names), {{"}"}}};
        return line_of(clause, std::move(cells), false);
    }
    case EngineClause::Kind::color: break;
    }
    std::vector<std::string> components;
    for (const ExpressionId id : clause.color) components.push_back(writer.expressions().flat(id));
    Cell color = list("(", components);
    color.back().text += ')';
    return line_of(clause, {{{"color"}}, std::move(color)}, false);
}

}  // namespace

void write_code(LineWriter& writer, const CodeItem& code)
{
    writer.put(fmt::format("code {}({}: {}) {{\n", code.name.text, code.value.name.text,
                           writer.type(code.value.type)));
    writer.write_comments(code.encode_comments, step);
    writer.indent(step);
    writer.put("encode =");
    writer.write_value(code.encode, step);
    writer.end_line(code.encode_trailing);
    writer.write_comments(code.decode_comments, step);
    writer.indent(step);
    writer.put(fmt::format("decode({}) =", code.stored.text));
    writer.write_value(code.decode, step);
    writer.end_line(code.decode_trailing);
    writer.put("}");
}

void write_packing(LineWriter& writer, const PackingItem& packing)
{
    writer.put(fmt::format("packing {} on {} {{\n", packing.model.text, packing.gbuffer.text));
    std::vector<Line> lines;
    for (const auto& any : packing.lines)
        lines.push_back(std::visit([&](const auto& clause) { return line(writer, clause); }, any));
    writer.write_lines(lines, step);
    writer.put("}");
}

void write_engine(LineWriter& writer, const EngineItem& engine)
{
    writer.put(fmt::format("engine {} for {} {{\n", engine.gbuffer.text, engine.model.text));
    std::vector<Line> lines;
    for (const EngineClause& clause : engine.lines) lines.push_back(line(writer, clause));
    writer.write_lines(lines, step);
    writer.put("}");
}

}  // namespace lobe::syntax
