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
        std::string text =
            fmt::format("model {} {} {}", node.name.text, read(node.parameters), read(node.lets));
        for (const Output& output : node.outputs)
            text += fmt::format("{} = {}; ", output.name.text, read(output.value));
        return text;
    }
    std::string read(const GbufferItem&) const { return "GbufferItem"; }
    std::string read(const CodeItem&) const { return "CodeItem"; }
    std::string read(const PackingItem&) const { return "PackingItem"; }
    std::string read(const EngineItem&) const { return "EngineItem"; }

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
        collect(item.trailing, result);
    }
    collect(tree.footer, result);
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
