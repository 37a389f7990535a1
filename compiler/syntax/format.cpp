#include "syntax/format.h"

#include "syntax/format_items.h"
#include "syntax/format_lines.h"
#include "syntax/lex.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::syntax {
namespace {

constexpr std::size_t step = LineWriter::step;
constexpr std::size_t widest_line = ExpressionWriter::widest_line;
/// Parameters with longer heads do not take part in the alignment of their run.
constexpr std::size_t widest_head = 72;

/// The columns of a run of `param` lines.
struct Columns {
    std::size_t head = 0;
    std::size_t tier = 0;
};

class Formatter {
public:
    explicit Formatter(const Tree& tree) : tree_(tree), lines_(tree) {}

    std::string run()
    {
        lines_.write_comments(tree_.header, 0);
        if (tree_.module) {
            if (tree_.module_blank_before) lines_.blank_line();
            lines_.put(fmt::format("module {}\n", tree_.module->text));
        }
        const std::vector<Columns> columns = align_params();
        for (std::size_t i = 0; i < tree_.items.size(); ++i) {
            const Item& item = tree_.items[i];
            lines_.write_comments(item.comments, 0);
            if (item.blank_lines_before > 0) lines_.blank_line();
            columns_ = columns[i];
            std::visit([&](const auto& node) { write(node); }, item.node);
            lines_.end_line(item.trailing);
        }
        lines_.write_comments(tree_.footer, 0);
        return lines_.take();
    }

private:
    // ---- items

    void write(const Import& import)
    {
        std::string line = fmt::format("import {} {{ ", import.module.text);
        std::string names;
        for (const Identifier& name : import.names)
            names += fmt::format("{}{}", names.empty() ? "" : ", ", name.text);
        if (line.size() + names.size() + step <= widest_line) {
            lines_.put(fmt::format("{}{} }}", line, names));
            return;
        }
        line.back() = '\n';
        lines_.put(line);
        std::size_t at = 0;
        for (std::size_t i = 0; i < import.names.size(); ++i) {
            const bool last = i + 1 == import.names.size();
            const std::string name = fmt::format("{}{}", import.names[i].text, last ? "" : ",");
            if (at > 0 && at + 1 + name.size() > widest_line) {
                lines_.put("\n");
                at = 0;
            }
            const std::size_t space = at == 0 ? step : 1;
            lines_.indent(space);
            lines_.put(name);
            at += space + name.size();
        }
        lines_.put("\n}");
    }

    void write(const SourceItem& source)
    {
        lines_.put(fmt::format("source {} = {}", source.name.text, quote(source.text)));
    }

    void write(const TierItem& tier)
    {
        lines_.put("tier ");
        for (std::size_t i = 0; i < tier.names.size(); ++i)
            lines_.put(fmt::format("{}{}", i > 0 ? ", " : "", tier.names[i].text));
    }

    /// A parameter up to where its tier stands.
    std::string head(const ParamItem& param) const
    {
        std::string value;
        for (const ExpressionId id : param.default_value)
            value += fmt::format("{}{}", value.empty() ? "" : ", ", lines_.expressions().flat(id));
        if (param.default_value.size() > 1) value = fmt::format("({})", value);
        return fmt::format("param {} : {} = {}", param.name.text, lines_.type(param.type), value);
    }

    /// For each item the columns of its run: parameters that no empty line separates.
    std::vector<Columns> align_params() const
    {
        std::vector<Columns> result(tree_.items.size());
        std::size_t begin = 0;
        Columns columns;
        const auto close = [&](std::size_t end) {
            for (; begin < end; ++begin) result[begin] = columns;
            columns = {};
        };
        for (std::size_t i = 0; i < tree_.items.size(); ++i) {
            const Item& item = tree_.items[i];
            const auto* param = std::get_if<ParamItem>(&item.node);
            const bool apart =
                item.blank_lines_before > 0 ||
                std::any_of(item.comments.begin(), item.comments.end(),
                            [](const Comment& comment) { return comment.blank_before; });
            if (param == nullptr || apart) close(i);
            if (param == nullptr) continue;
            const std::size_t size = head(*param).size();
            if (size <= widest_head) columns.head = std::max(columns.head, size);
            if (param->tier) columns.tier = std::max(columns.tier, param->tier->text.size());
        }
        close(tree_.items.size());
        return result;
    }

    void write(const ParamItem& param)
    {
        std::string line = head(param);
        if (param.tier || param.label) line = fmt::format("{:<{}}", line, columns_.head);
        if (param.tier) line += fmt::format("  {}", param.tier->text);
        if (param.label) {
            if (columns_.tier > 0)
                line = fmt::format("{:<{}}", line, columns_.head + 2 + columns_.tier);
            line += fmt::format("  {}", quote(*param.label));
        }
        lines_.put(line);
    }

    void write(const TermItem& term)
    {
        lines_.put(fmt::format("term {}", term.name.text));
        write_signature(term.parameters, term.result);
        write_body(term.body, 0);
        for (const Form& form : term.forms) {
            lines_.write_comments(form.comments, step);
            lines_.indent(step);
            lines_.put(fmt::format("form {}", form.name.text));
            write_body(form.body, step);
        }
    }

    void write(const EffectItem& effect)
    {
        lines_.put(fmt::format("effect {} off when", quote(effect.name)));
        lines_.write_value(effect.off_when, 0);
    }

    void write(const ModelItem& model)
    {
        lines_.put(fmt::format("{} {}", model.is_light ? "light" : "model", model.name.text));
        write_signature(model.parameters, std::nullopt);
        lines_.put(" {\n");
        for (const Let& let : model.lets) write_let(let, step);
        std::size_t widest = 0;
        for (const Output& output : model.outputs)
            widest = std::max(widest, output.name.text.size());
        for (const Output& output : model.outputs) {
            lines_.write_comments(output.comments, step);
            if (output.blank_before) lines_.blank_line();
            lines_.indent(step);
            const std::size_t column = std::min(widest, widest_head);
            lines_.put(fmt::format("{:<{}} =", output.name.text, column));
            lines_.write_value(output.value, step);
            lines_.end_line(output.trailing);
        }
        lines_.put("}");
    }

    void write(const GbufferItem& gbuffer) { write_gbuffer(lines_, gbuffer); }
    void write(const CodeItem& code) { write_code(lines_, code); }
    void write(const PackingItem& packing) { write_packing(lines_, packing); }
    void write(const EngineItem& engine) { write_engine(lines_, engine); }

    // ---- pieces of items

    void write_signature(const std::vector<ParameterClause>& parameters,
                         const std::optional<TypeClause>& result)
    {
        std::vector<std::string> texts;
        for (const ParameterClause& parameter : parameters)
            texts.push_back(
                fmt::format("{}: {}", parameter.name.text, lines_.type(parameter.type)));
        const std::string arrow = result ? fmt::format(" -> {}", lines_.type(*result)) : "";
        const std::string flat = fmt::format("({}){}", fmt::join(texts, ", "), arrow);
        if (lines_.column() + flat.size() + step <= widest_line || parameters.empty()) {
            lines_.put(flat);
            return;
        }
        lines_.put(fmt::format("(\n  {}\n){}", fmt::join(texts, ",\n  "), arrow));
    }

    void write_body(const Body& body, std::size_t columns)
    {
        if (!body.block) {
            lines_.put(" =");
            lines_.write_value(body.value, columns);
            lines_.end_line(body.trailing);
            return;
        }
        lines_.put(" {\n");
        for (const Let& let : body.lets) write_let(let, columns + step);
        lines_.write_comments(body.value_comments, columns + step);
        if (body.value_blank_before) lines_.blank_line();
        lines_.indent(columns + step);
        const bool minus = lines_.expressions().parenthesize_value(body);
        if (minus) lines_.put("(");
        lines_.put(lines_.expressions().broken(body.value, columns + step, columns + step));
        lines_.put(minus ? ")\n" : "\n");
        lines_.indent(columns);
        lines_.put("}");
        lines_.end_line(body.trailing);
    }

    void write_let(const Let& let, std::size_t columns)
    {
        lines_.write_comments(let.comments, columns);
        if (let.blank_before) lines_.blank_line();
        lines_.indent(columns);
        lines_.put(fmt::format("let {} =", let.name.text));
        lines_.write_value(let.value, columns);
        lines_.end_line(let.trailing);
    }

    const Tree& tree_;
    LineWriter lines_;
    Columns columns_;
};

}  // namespace

std::string format(const Tree& tree) { return Formatter{tree}.run(); }

}  // namespace lobe::syntax
