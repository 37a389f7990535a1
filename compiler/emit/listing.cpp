#include "emit/listing.h"

#include "emit/wrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::emit {
namespace {

constexpr std::size_t comment_width = 96;

constexpr ir::Op guarded_ops[] = {ir::Op::guarded_power, ir::Op::guarded_smoothstep,
                                  ir::Op::guarded_normalize};

/// What the language's people call a function. The names of papers stay: D_GGX, c1.
std::string function_name(const Dialect& dialect, const ir::Module& module,
                          const ir::Function& function, const std::string& prefix)
{
    if (dialect.names == Case::snake) return function.name;
    if (function.kind == ir::Function::Kind::output)
        return dialect.styled(model_stem(module, function.name, dialect));
    const auto styled = [&](const std::string& name) {
        const bool capital = std::ranges::any_of(name, [](char c) { return c >= 'A' && c <= 'Z'; });
        return capital || name.size() <= 2 ? name : dialect.styled(name);
    };
    if (function.kind == ir::Function::Kind::form && function.form_of.valid())
        return prefix + styled(module[function.form_of].name) + "_" +
               dialect.styled(function.form_name);
    return prefix + styled(function.name);
}

std::string end_text(double value)
{
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    return fmt::format("{}", value);
}

}  // namespace

std::vector<Record> lines(const std::vector<std::string>& texts)
{
    std::vector<Record> records;
    records.reserve(texts.size());
    for (const std::string& text : texts) records.emplace_back().texts["text"] = text;
    return records;
}

std::string range_text(const ir::Range& range)
{
    if (std::isinf(range.low) && std::isinf(range.high)) return {};
    return fmt::format("{}{}, {}{}", std::isinf(range.low) ? "(" : "[", end_text(range.low),
                       end_text(range.high), std::isinf(range.high) ? ")" : "]");
}

std::string model_stem(std::string_view module, const std::string& name, const Dialect& dialect)
{
    if (dialect.names == Case::snake || name.starts_with(module)) return name;
    return fmt::format("{}_{}", module, name);
}

std::string shown_path(std::string_view path)
{
    const bool absolute = path.starts_with('/') || (path.size() > 1 && path[1] == ':');
    if (absolute) path.remove_prefix(path.find_last_of("/\\") + 1);
    return std::string{path};
}

Listing::Listing(const ir::Module& module, const Sources& sources, const Dialect& dialect,
                 std::vector<ir::FunctionId> functions, std::string prefix,
                 const std::vector<std::string>& taken)
    : module_(module), sources_(sources), dialect_(dialect), functions_(std::move(functions)),
      prefix_(std::move(prefix)), file_(dialect), names_(module.functions.size())
{
    for (const std::string& name : taken) file_.unique(name);
    for (const ir::Op op : guarded_ops) file_.unique(helper_name(dialect_, prefix_, op));
    for (const ir::FunctionId id : functions_)
        names_[id.index] = file_.unique(function_name(dialect_, module_, module_[id], prefix_));
}

std::vector<Record> Listing::functions()
{
    std::vector<Record> records;
    for (const ir::FunctionId id : functions_)
        records.push_back(function(module_[id], names_[id.index]));
    return records;
}

Scope Listing::scope() const { return {module_, dialect_, names_, {}, {}, file_.inner(), prefix_}; }

Body Listing::write(Scope& scope, const ir::Graph& graph, const std::vector<ir::ExprId>& roots)
{
    return emit::write(scope, helpers_, graph, roots);
}

Record Listing::function(const ir::Function& function, const std::string& name)
{
    Scope scope = this->scope();
    std::vector<std::string> parameters;
    for (const ir::Input& input : function.inputs) {
        scope.inputs.push_back(scope.namer.unique(input_name(dialect_, input)));
        scope.colors.push_back(input.quantity == ir::Quantity::color);
        parameters.push_back(fmt::format("{} {}", dialect_.type(input.type), scope.inputs.back()));
    }
    Body body = write(scope, function.graph, {function.result});
    body.locals.push_back({fmt::format("return {};", body.results.front().text),
                           function.graph.span(function.result)});

    const std::string inside = fmt::format("{}", fmt::join(parameters, ", "));
    const std::string signature = fmt::format("{} {}{}{}{}", dialect_.type(function.type()), name,
                                              inside.empty() ? "(" : dialect_.call_open, inside,
                                              inside.empty() ? ")" : dialect_.call_close);
    return {{{"signature", wrap(signature, 0, dialect_.indent)}},
            {{"comment", comment(function, scope.inputs)}, {"statements", statements(body.locals)}},
            tag(function.span)};
}

std::vector<Record> Listing::statements(const std::vector<Statement>& statements)
{
    std::vector<Record> records;
    for (const Statement& statement : statements)
        records.push_back({{{"text", wrap(statement.text, 4, dialect_.indent)}},
                           {},
                           statement.span == Span{} ? -1 : tag(statement.span)});
    return records;
}

std::string Listing::citation(const ir::Citation& citation, const Span& place) const
{
    std::string text = citation.source;
    if (!citation.locator.empty()) text += " " + citation.locator;
    // The declaration in the same file, for two modules may use one short name.
    const ir::Source* source = nullptr;
    for (const ir::Source& declared : module_.sources)
        if (declared.name == citation.source &&
            (source == nullptr || declared.span.source == place.source))
            source = &declared;
    return source == nullptr ? text : text + ": " + source->text;
}

std::vector<std::string> Listing::documentation(const std::string& doc,
                                                const std::vector<ir::Citation>& citations,
                                                const Span& place) const
{
    std::vector<std::string> text = paragraphs(doc, comment_width);
    for (const ir::Citation& cited : citations)
        for (std::string& line : fill(citation(cited, place), comment_width))
            text.push_back(std::move(line));
    return text;
}

std::vector<Record> Listing::comment(const ir::Function& function,
                                     const std::vector<std::string>& inputs) const
{
    std::vector<std::string> text = documentation(function.doc, function.citations, function.span);
    const auto add = [&](const std::string& prose) {
        for (std::string& line : fill(prose, comment_width)) text.push_back(std::move(line));
    };
    if (!function.formula.empty()) add("= " + function.formula);

    // What the author did not name, and a caller has to know.
    for (std::size_t i = 0; i < function.inputs.size(); ++i) {
        const ir::Input& input = function.inputs[i];
        if (input.origin != ir::Origin::geometry) continue;
        const ir::FieldFacts& field = ir::facts(static_cast<ir::GeometryField>(input.which));
        if (!field.nameable) add(fmt::format("{} is {}.", inputs[i], field.doc));
    }
    if (function.kind == ir::Function::Kind::shade)
        for (std::size_t i = 0; i < function.inputs.size(); ++i)
            if (const ir::Input& input = function.inputs[i]; input.origin == ir::Origin::emitter)
                add(fmt::format("{} is {}.", inputs[i],
                                ir::facts(static_cast<ir::EmitterField>(input.which)).doc));

    // Fields of surfaces and parameters have the ranges that their structures state.
    std::string ranges;
    for (std::size_t i = 0; i < function.inputs.size(); ++i) {
        const ir::Input& input = function.inputs[i];
        const std::string range = range_text(input.range);
        const bool stated =
            input.origin != ir::Origin::argument && input.origin != ir::Origin::emitter;
        if (range.empty() || stated || input.quantity == ir::Quantity::direction) continue;
        ranges += fmt::format("{}{} in {}", ranges.empty() ? "Expects " : ", ", inputs[i], range);
    }
    if (!ranges.empty()) ranges += ". ";
    // What was declared is a promise; what was only inferred can change with the next edit.
    if (function.declared_range)
        ranges += fmt::format("Returns {}.", range_text(*function.declared_range));
    add(ranges);
    text.push_back(cite(function.span));
    return lines(text);
}

std::vector<Record> Listing::helpers()
{
    std::vector<Record> records;
    for (const ir::Op op : guarded_ops) {
        const bool componentwise = op != ir::Op::guarded_normalize;
        const std::string name = helper_name(dialect_, prefix_, op);
        std::vector<Record> scalars;
        std::vector<Record> vectors;
        for (const Helper& helper : helpers_) {
            if (helper.op != op) continue;
            const std::string type{dialect_.type(helper.type)};
            Record record{{{"type", type}, {"guard", fmt::format("LOBE_{}_{}", name, type)}}, {}};
            const int count = ir::components(helper.type);
            if (count == 1) {
                scalars.push_back(std::move(record));
                continue;
            }
            std::vector<Record> parts;
            for (int i = 0; i < count; ++i)
                parts.push_back(
                    {{{"letter", std::string{"xyzw"[i]}}, {"comma", i + 1 < count ? "," : ""}},
                     {}});
            if (componentwise) record.lists["parts"] = std::move(parts);
            vectors.push_back(std::move(record));
        }
        if (scalars.empty() && vectors.empty()) continue;

        Record values{{{"name", name}}, {{"vectors", vectors}}};
        if (componentwise) values.lists["scalars"] = scalars;
        if (op == ir::Op::guarded_smoothstep) {
            values.texts["zero"] = dialect_.literal(0);
            values.texts["one"] = dialect_.literal(1);
            values.texts["two"] = dialect_.literal(2);
            values.texts["three"] = dialect_.literal(3);
            values.texts["width"] = dialect_.literal(ir::least_divisor);
        } else {
            values.texts["least"] = dialect_.least_normal;
        }
        const std::string path = fmt::format("{}/{}{}", dialect_.helpers,
                                             dialect_.spelling(op).word, dialect_.extension);
        std::string text = render_embedded(path, values).text;
        if (text.ends_with('\n')) text.pop_back();
        records.push_back({{{"text", std::move(text)}}, {}});
    }
    return records;
}

std::string Listing::cite(const Span& span) const
{
    return sources_.size() <= span.source ? std::string{} : shown_path(sources_.cite(span));
}

int Listing::tag(const Span& span)
{
    tags_.push_back(span);
    return static_cast<int>(tags_.size()) - 1;
}

std::vector<LineOrigin> Listing::origins(const std::vector<Mark>& marks) const
{
    int last = 0;
    for (const Mark& mark : marks) last = std::max(last, mark.last);
    std::vector<int> tag_of(static_cast<std::size_t>(last) + 1, -1);
    for (const Mark& mark : marks)
        for (int line = mark.first; line <= mark.last; ++line)
            if (int& tag = tag_of[static_cast<std::size_t>(line)]; tag < 0) tag = mark.tag;

    std::vector<LineOrigin> result;
    for (int line = 1; line <= last; ++line) {
        const int tag = tag_of[static_cast<std::size_t>(line)];
        if (tag < 0) continue;
        const Span& span = tags_[static_cast<std::size_t>(tag)];
        if (!result.empty() && result.back().last == line - 1 && result.back().span == span)
            result.back().last = line;
        else
            result.push_back({line, line, span});
    }
    return result;
}

}  // namespace lobe::emit
