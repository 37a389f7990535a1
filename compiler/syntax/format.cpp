#include "syntax/format.h"

#include "syntax/format_expression.h"
#include "syntax/lex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace lobe::syntax {
namespace {

constexpr std::size_t step = 2;
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
    explicit Formatter(const Tree& tree) : tree_(tree), expressions_(tree) {}

    std::string run()
    {
        write_comments(tree_.header, 0);
        if (tree_.module) {
            if (tree_.module_blank_before) blank_line();
            out_ += fmt::format("module {}\n", tree_.module->text);
        }
        const std::vector<Columns> columns = align_params();
        for (std::size_t i = 0; i < tree_.items.size(); ++i) {
            const Item& item = tree_.items[i];
            write_comments(item.comments, 0);
            if (item.blank_lines_before > 0) blank_line();
            columns_ = columns[i];
            std::visit([&](const auto& node) { write(node); }, item.node);
            end_line(item.trailing);
        }
        write_comments(tree_.footer, 0);
        return std::move(out_);
    }

private:
    // ---- lines

    void indent(std::size_t columns) { out_.append(columns, ' '); }

    /// One empty line, unless there is one or a block has just been opened.
    void blank_line()
    {
        if (out_.empty() || out_.ends_with("\n\n") || out_.ends_with("{\n")) return;
        out_ += '\n';
    }

    void end_line(const std::vector<Comment>& trailing)
    {
        for (const Comment& comment : trailing) out_ += fmt::format("  {}", slashes(comment));
        if (!out_.ends_with('\n')) out_ += '\n';
    }

    static std::string slashes(const Comment& comment)
    {
        return fmt::format("{}{}{}", comment.doc ? "///" : "//", comment.text.empty() ? "" : " ",
                           comment.text);
    }

    void write_comments(const std::vector<Comment>& comments, std::size_t columns)
    {
        for (const Comment& comment : comments) {
            if (comment.blank_before) blank_line();
            indent(columns);
            out_ += fmt::format("{}\n", slashes(comment));
        }
    }

    std::size_t column() const
    {
        const std::size_t line = out_.rfind('\n') + 1;  // npos + 1 is 0
        return character_count(std::string_view{out_}.substr(line));
    }

    /// ` value` behind an `=`, or the value on lines of its own where that does not fit.
    void write_value(ExpressionId value, std::size_t columns)
    {
        if (column() + 1 + expressions_.width(value) <= widest_line) {
            out_ += fmt::format(" {}", expressions_.flat(value));
            return;
        }
        out_ += '\n';
        indent(columns + step);
        out_ += expressions_.broken(value, columns + step, columns + step);
    }

    // ---- items

    void write(const Import& import)
    {
        std::string line = fmt::format("import {} {{ ", import.module.text);
        std::string names;
        for (const Identifier& name : import.names)
            names += fmt::format("{}{}", names.empty() ? "" : ", ", name.text);
        if (line.size() + names.size() + step <= widest_line) {
            out_ += fmt::format("{}{} }}", line, names);
            return;
        }
        line.back() = '\n';
        out_ += line;
        std::size_t at = 0;
        for (std::size_t i = 0; i < import.names.size(); ++i) {
            const bool last = i + 1 == import.names.size();
            const std::string name = fmt::format("{}{}", import.names[i].text, last ? "" : ",");
            if (at > 0 && at + 1 + name.size() > widest_line) {
                out_ += '\n';
                at = 0;
            }
            const std::size_t space = at == 0 ? step : 1;
            indent(space);
            out_ += name;
            at += space + name.size();
        }
        out_ += "\n}";
    }

    void write(const SourceItem& source)
    {
        out_ += fmt::format("source {} = {}", source.name.text, quote(source.text));
    }

    void write(const TierItem& tier)
    {
        out_ += "tier ";
        for (std::size_t i = 0; i < tier.names.size(); ++i)
            out_ += fmt::format("{}{}", i > 0 ? ", " : "", tier.names[i].text);
    }

    std::string type(const TypeClause& clause) const
    {
        if (!clause.range) return clause.name.text;
        return fmt::format("{} in [{}, {}]", clause.name.text, expressions_.flat(clause.range->low),
                           expressions_.flat(clause.range->high));
    }

    /// A parameter up to where its tier stands.
    std::string head(const ParamItem& param) const
    {
        std::string value;
        for (const ExpressionId id : param.default_value)
            value += fmt::format("{}{}", value.empty() ? "" : ", ", expressions_.flat(id));
        if (param.default_value.size() > 1) value = fmt::format("({})", value);
        return fmt::format("param {} : {} = {}", param.name.text, type(param.type), value);
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
        out_ += line;
    }

    void write(const TermItem& term)
    {
        out_ += fmt::format("term {}", term.name.text);
        write_signature(term.parameters, term.result);
        write_body(term.body, 0);
        for (const Form& form : term.forms) {
            write_comments(form.comments, step);
            indent(step);
            out_ += fmt::format("form {}", form.name.text);
            write_body(form.body, step);
        }
    }

    void write(const EffectItem& effect)
    {
        out_ += fmt::format("effect {} off when", quote(effect.name));
        write_value(effect.off_when, 0);
    }

    void write(const ModelItem& model)
    {
        out_ += fmt::format("model {}", model.name.text);
        write_signature(model.parameters, std::nullopt);
        out_ += " {\n";
        for (const Let& let : model.lets) write_let(let, step);
        std::size_t widest = 0;
        for (const Output& output : model.outputs)
            widest = std::max(widest, output.name.text.size());
        for (const Output& output : model.outputs) {
            write_comments(output.comments, step);
            if (output.blank_before) blank_line();
            indent(step);
            const std::size_t column = std::min(widest, widest_head);
            out_ += fmt::format("{:<{}} =", output.name.text, column);
            write_value(output.value, step);
            end_line(output.trailing);
        }
        out_ += "}";
    }

    void write(const GbufferItem&)
    {
        assert(false && "not parsed yet");
    }

    void write(const CodeItem&)
    {
        assert(false && "not parsed yet");
    }

    void write(const PackingItem&)
    {
        assert(false && "not parsed yet");
    }

    void write(const EngineItem&)
    {
        assert(false && "not parsed yet");
    }

    // ---- pieces of items

    void write_signature(const std::vector<ParameterClause>& parameters,
                         const std::optional<TypeClause>& result)
    {
        std::vector<std::string> texts;
        for (const ParameterClause& parameter : parameters)
            texts.push_back(fmt::format("{}: {}", parameter.name.text, type(parameter.type)));
        const std::string arrow = result ? fmt::format(" -> {}", type(*result)) : "";
        const std::string flat = fmt::format("({}){}", fmt::join(texts, ", "), arrow);
        if (column() + flat.size() + step <= widest_line || parameters.empty()) {
            out_ += flat;
            return;
        }
        out_ += fmt::format("(\n  {}\n){}", fmt::join(texts, ",\n  "), arrow);
    }

    void write_body(const Body& body, std::size_t columns)
    {
        if (!body.block) {
            out_ += " =";
            write_value(body.value, columns);
            end_line(body.trailing);
            return;
        }
        out_ += " {\n";
        for (const Let& let : body.lets) write_let(let, columns + step);
        write_comments(body.value_comments, columns + step);
        if (body.value_blank_before) blank_line();
        indent(columns + step);
        // A line that starts with `-` would continue the `let` before it.
        const bool minus = !body.lets.empty() && expressions_.flat(body.value).starts_with('-');
        if (minus) out_ += '(';
        out_ += expressions_.broken(body.value, columns + step, columns + step);
        out_ += minus ? ")\n" : "\n";
        indent(columns);
        out_ += "}";
        end_line(body.trailing);
    }

    void write_let(const Let& let, std::size_t columns)
    {
        write_comments(let.comments, columns);
        if (let.blank_before) blank_line();
        indent(columns);
        out_ += fmt::format("let {} =", let.name.text);
        write_value(let.value, columns);
        end_line(let.trailing);
    }

    const Tree& tree_;
    ExpressionWriter expressions_;
    Columns columns_;
    std::string out_;
};

}  // namespace

std::string format(const Tree& tree) { return Formatter{tree}.run(); }

}  // namespace lobe::syntax
