#include "syntax/meaning.h"

#include "syntax/lex.h"

#include <fmt/format.h>

#include <array>

namespace lobe::tests {
namespace {

using namespace lobe::syntax;

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

constexpr std::array operators{
    "+", "-", "*", "/", "^", "<", "<=", ">", ">=", "==", "!=", "and", "or"};

class Reader {
public:
    explicit Reader(const Tree& tree) : tree_(tree) {}

    std::string read(ExpressionId id) const
    {
        return std::visit(
            Overloaded{
                [](const Number& number) { return number.text; },
                [](const Name& name) { return name.text; },
                [&](const Member& member) {
                    return fmt::format("(. {} {})", read(member.base), member.member.text);
                },
                [&](const Unary& unary) {
                    return fmt::format("({} {})", unary.op == UnaryOperator::negate ? "neg" : "not",
                                       read(unary.operand));
                },
                [&](const Binary& binary) {
                    const auto op = operators[static_cast<std::size_t>(binary.op)];
                    const std::string limit =
                        binary.limit.valid() ? fmt::format(" else {}", read(binary.limit)) : "";
                    return fmt::format("({} {} {}{})", op, read(binary.left), read(binary.right),
                                       limit);
                },
                [&](const Call& call) {
                    std::string text = fmt::format("(call {}", call.callee.text);
                    for (const ExpressionId argument : call.arguments)
                        text += fmt::format(" {}", read(argument));
                    return text + ")";
                },
                [&](const Conditional& node) {
                    return fmt::format("(if {} {} {})", read(node.condition), read(node.then_value),
                                       read(node.else_value));
                },
                [&](const Sum& sum) {
                    return fmt::format("(sum {} {} {} {})", sum.index.text, read(sum.first),
                                       read(sum.last), read(sum.body));
                },
                [](const Poison&) { return std::string{"poison"}; },
            },
            tree_[id].node);
    }

    std::string read(const TypeClause& type) const
    {
        if (!type.range) return type.name.text;
        return fmt::format("{}[{} {}]", type.name.text, read(type.range->low),
                           read(type.range->high));
    }

    std::string read(const std::vector<ParameterClause>& parameters) const
    {
        std::string text = "(";
        for (const ParameterClause& parameter : parameters)
            text += fmt::format("{}:{} ", parameter.name.text, read(parameter.type));
        return text + ")";
    }

    std::string read(const std::vector<Let>& lets) const
    {
        std::string text;
        for (const Let& let : lets)
            text += fmt::format("let {} {}; ", let.name.text, read(let.value));
        return text;
    }

    std::string read(const Body& body) const
    {
        const std::string inner = read(body.lets) + read(body.value);
        return body.block ? fmt::format("{{{}}}", inner) : inner;
    }

    std::string read(const Item& item) const
    {
        return doc_text(item.comments) +
               std::visit([&](const auto& node) { return read(node); }, item.node);
    }

    std::string read(const Import& node) const
    {
        return fmt::format("import {} {}", node.module.text, read(node.names));
    }
    std::string read(const std::vector<Identifier>& names) const
    {
        std::string text;
        for (const Identifier& name : names) text += name.text + ",";
        return text;
    }
    std::string read(const SourceItem& node) const
    {
        return fmt::format("source {} {}", node.name.text, quote(node.text));
    }
    std::string read(const TierItem& node) const { return "tier " + read(node.names); }
    std::string read(const ParamItem& node) const
    {
        std::string text = fmt::format("param {} {} =", node.name.text, read(node.type));
        for (const ExpressionId id : node.default_value) text += fmt::format(" {}", read(id));
        if (node.tier) text += fmt::format(" tier {}", node.tier->text);
        if (node.label) text += fmt::format(" label {}", quote(*node.label));
        return text;
    }
    std::string read(const TermItem& node) const
    {
        std::string text =
            fmt::format("term {} {} -> {} = {}", node.name.text, read(node.parameters),
                        node.result ? read(*node.result) : "?", read(node.body));
        for (const Form& form : node.forms)
            text += fmt::format(" form {} {} = {}", doc_text(form.comments), form.name.text,
                                read(form.body));
        return text;
    }
    std::string read(const EffectItem& node) const
    {
        return fmt::format("effect {} {}", quote(node.name), read(node.off_when));
    }
    std::string read(const ModelItem& node) const
    {
        std::string text = fmt::format("{} {} {} {}", node.is_light ? "light" : "model",
                                       node.name.text, read(node.parameters), read(node.lets));
        for (const Output& output : node.outputs)
            text += fmt::format("{} = {}; ", output.name.text, read(output.value));
        return text;
    }

    std::string read(const RangeClause& range) const
    {
        return fmt::format("[{} {}]", read(range.low), read(range.high));
    }
    std::string read(const StorageClause& storage) const
    {
        return fmt::format("{}:{}", storage.kind.text, storage.bits);
    }
    std::string read(const FactClause& fact) const
    {
        static constexpr std::array kinds{"format", "exists", "field", "holds", "also", "changes"};
        std::string text = kinds.at(static_cast<std::size_t>(fact.kind));
        if (fact.storage) text += " " + read(*fact.storage);
        if (!fact.name.text.empty()) text += " " + fact.name.text;
        if (fact.kind != FactClause::Kind::format && fact.kind != FactClause::Kind::exists)
            text += " " + quote(fact.text);
        if (fact.lent) text += " lent";
        if (fact.condition.valid()) text += " when " + read(fact.condition);
        if (fact.otherwise.valid()) text += " else " + read(fact.otherwise);
        return text + "; ";
    }
    template <class Lines>
    std::string read_all(const Lines& lines) const
    {
        std::string text;
        for (const auto& line : lines) text += read(line);
        return text;
    }
    std::string read(const ChannelClause& channel) const
    {
        return fmt::format("{}channel {} {} {{{}}}", doc_text(channel.comments), channel.name.text,
                           quote(channel.label), read_all(channel.facts));
    }
    std::string read(const TargetClause& target) const
    {
        return fmt::format("{}target {} {} {{{}{}}}", doc_text(target.comments), target.name.text,
                           quote(target.label), read_all(target.facts), read_all(target.channels));
    }
    std::string read(const SettingItem& setting) const
    {
        return fmt::format("{}setting {} {} {}= {}; ", doc_text(setting.comments),
                           setting.name.text, quote(setting.label), read(setting.values),
                           setting.default_value.text);
    }
    std::string read(const PinClause& pin) const
    {
        return fmt::format("{}pin {} {} {}= {}; ", doc_text(pin.comments), pin.name.text,
                           quote(pin.label), pin.range ? read(*pin.range) : "",
                           read(pin.default_value));
    }
    std::string read(const GbufferItem& node) const
    {
        return fmt::format("gbuffer {} {}{}{}", node.name.text, read_all(node.settings),
                           read_all(node.targets), read_all(node.pins));
    }
    std::string read(const CodeItem& node) const
    {
        return fmt::format("code {} {}:{} encode {} decode {} {}", node.name.text,
                           node.value.name.text, read(node.value.type), read(node.encode),
                           node.stored.text, read(node.decode));
    }
    std::string read(const FieldClause& field) const
    {
        std::string text = doc_text(field.comments);
        for (const SlotClause& slot : field.slots) {
            text += fmt::format("{}.{}", slot.target.text, slot.channels.text);
            if (slot.low) text += fmt::format("[{} {}]", *slot.low, *slot.high);
            text += ",";
        }
        text += " = " + field.parameter.text;
        if (field.component) text += "." + field.component->text;
        text += " " + read(field.storage);
        if (field.range) text += " " + read(*field.range);
        if (field.code) {
            text += " code " + field.code->name.text;
            for (const ExpressionId id : field.code->arguments) text += " " + read(id);
        }
        return text + "; ";
    }
    std::string read(const PackingClause& clause) const
    {
        static constexpr std::array kinds{"exact", "radiance", "supports", "over", "without"};
        std::string text = kinds.at(static_cast<std::size_t>(clause.kind));
        for (const auto& exact : clause.exact)
            text += fmt::format(" {} {},", exact.parameter.text, read(exact.value));
        if (clause.limit.valid()) text += " " + read(clause.limit);
        text += fmt::format(" {} {}", clause.name.text, read(clause.names));
        if (clause.range) text += " " + read(*clause.range);
        return text + "; ";
    }
    std::string read(const std::variant<FieldClause, PackingClause>& line) const
    {
        return std::visit([&](const auto& node) { return read(node); }, line);
    }
    std::string read(const PackingItem& node) const
    {
        return fmt::format("packing {} on {} {}", node.model.text, node.gbuffer.text,
                           read_all(node.lines));
    }
    std::string read(const EngineClause& clause) const
    {
        static constexpr std::array kinds{"shading_model", "pin", "node", "color"};
        std::string text = kinds.at(static_cast<std::size_t>(clause.kind));
        text += fmt::format(" {} {}", clause.name.text, clause.parameter.text);
        if (clause.text) text += " " + quote(*clause.text);
        text += read(clause.names);
        for (const ExpressionId id : clause.color) text += " " + read(id);
        return text + "; ";
    }
    std::string read(const EngineItem& node) const
    {
        return fmt::format("engine {} for {} {}", node.gbuffer.text, node.model.text,
                           read_all(node.lines));
    }

private:
    const Tree& tree_;
};

void collect(const std::vector<Comment>& from, std::vector<std::string>& into)
{
    for (const Comment& comment : from) into.push_back((comment.doc ? "/" : "") + comment.text);
}

void collect(const Body& body, std::vector<std::string>& into)
{
    for (const Let& let : body.lets) {
        collect(let.comments, into);
        collect(let.trailing, into);
    }
    collect(body.value_comments, into);
    collect(body.trailing, into);
}

/// The comments inside sums, wherever those stand.
void collect_sums(const Tree& tree, std::vector<std::string>& into)
{
    for (const Expression& expression : tree.expressions)
        if (const auto* sum = std::get_if<Sum>(&expression.node)) collect(sum->body, into);
}

/// The comments of lines that hold no others.
template <class Lines>
void collect_lines(const Lines& lines, std::vector<std::string>& into)
{
    for (const auto& line : lines) {
        collect(line.comments, into);
        collect(line.trailing, into);
    }
}

void collect(const GbufferItem& gbuffer, std::vector<std::string>& into)
{
    collect_lines(gbuffer.settings, into);
    for (const TargetClause& target : gbuffer.targets) {
        collect(target.comments, into);
        collect_lines(target.facts, into);
        for (const ChannelClause& channel : target.channels) {
            collect(channel.comments, into);
            collect_lines(channel.facts, into);
            collect(channel.trailing, into);
        }
        collect(target.trailing, into);
    }
    collect_lines(gbuffer.pins, into);
}

void collect(const CodeItem& code, std::vector<std::string>& into)
{
    collect(code.encode_comments, into);
    collect(code.encode_trailing, into);
    collect(code.decode_comments, into);
    collect(code.decode_trailing, into);
}

void collect(const PackingItem& packing, std::vector<std::string>& into)
{
    for (const auto& any : packing.lines)
        std::visit(
            [&](const auto& line) {
                collect(line.comments, into);
                collect(line.trailing, into);
            },
            any);
}

}  // namespace

std::string meaning(const Tree& tree, ExpressionId id) { return Reader{tree}.read(id); }

std::string meaning(const Tree& tree)
{
    std::string text = fmt::format("module {}\n", tree.module ? tree.module->text : "?");
    for (const Item& item : tree.items) text += Reader{tree}.read(item) + "\n";
    return text;
}

std::vector<std::string> comments(const Tree& tree)
{
    std::vector<std::string> result;
    collect(tree.header, result);
    for (const Item& item : tree.items) {
        collect(item.comments, result);
        if (const auto* term = std::get_if<TermItem>(&item.node)) {
            collect(term->body, result);
            for (const Form& form : term->forms) {
                collect(form.comments, result);
                collect(form.body, result);
            }
        }
        if (const auto* model = std::get_if<ModelItem>(&item.node)) {
            for (const Let& let : model->lets) {
                collect(let.comments, result);
                collect(let.trailing, result);
            }
            for (const Output& output : model->outputs) {
                collect(output.comments, result);
                collect(output.trailing, result);
            }
        }
        if (const auto* gbuffer = std::get_if<GbufferItem>(&item.node)) collect(*gbuffer, result);
        if (const auto* code = std::get_if<CodeItem>(&item.node)) collect(*code, result);
        if (const auto* packing = std::get_if<PackingItem>(&item.node)) collect(*packing, result);
        if (const auto* engine = std::get_if<EngineItem>(&item.node))
            collect_lines(engine->lines, result);
        collect(item.trailing, result);
    }
    collect(tree.footer, result);
    collect_sums(tree, result);
    return result;
}

Parsed parsed(std::string text)
{
    Parsed result;
    result.sources.add("test.lobe", std::move(text));
    result.tree = parse(result.sources, 0, result.diagnostics);
    return result;
}

std::string codes(const Diagnostics& diagnostics)
{
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics.sorted())
        result += fmt::format("{}{}", result.empty() ? "" : " ", id(diagnostic.code));
    return result;
}

std::string expression(std::string_view text)
{
    const Parsed result = parsed(fmt::format("module m\nterm t() -> float = {}\n", text));
    if (result.diagnostics.has_errors()) return codes(result.diagnostics);
    return meaning(result.tree, std::get<TermItem>(result.tree.items.at(0).node).body.value);
}

}  // namespace lobe::tests
