#include "emit/model.h"

#include "emit/wrap.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {

bool ModelInputs::needs_tangents() const
{
    return std::ranges::any_of(geometry, ir::needs_tangents);
}

ModelInputs inputs_of(const ir::Module& module, const ir::Model& model, const Dialect& dialect)
{
    ModelInputs result;
    std::vector<ir::Input> surface;
    std::vector<ir::Input> parameters;
    const auto add = [](std::vector<ir::Input>& list, const ir::Input& input) {
        const bool known = std::ranges::any_of(list, [&](const ir::Input& other) {
            return other.which == input.which && other.name == input.name;
        });
        if (!known) list.push_back(input);
    };
    for (const ir::ModelOutput& output : model.outputs)
        for (const ir::Input& input : module[output.function].inputs) {
            switch (input.origin) {
            case ir::Origin::geometry: {
                const auto field = static_cast<ir::GeometryField>(input.which);
                if (std::ranges::find(result.geometry, field) == result.geometry.end())
                    result.geometry.push_back(field);
                break;
            }
            case ir::Origin::surface: add(surface, input); break;
            case ir::Origin::parameter: add(parameters, input); break;
            case ir::Origin::emitter: break;  // a model knows no light
            case ir::Origin::argument: add(result.arguments, input); break;
            }
        }
    std::ranges::sort(result.geometry);
    const auto members = [&](std::vector<ir::Input>& inputs) {
        std::ranges::sort(inputs, {}, &ir::Input::which);
        Namer names{dialect};
        std::vector<Member> list;
        for (const ir::Input& input : inputs)
            list.push_back({names.unique(dialect.styled(input.name)), input});
        return list;
    };
    result.surface = members(surface);
    result.parameters = members(parameters);
    return result;
}

ir::ExprId TextGraph::input(const std::string& text, ir::Type type)
{
    const auto known = std::ranges::find(texts, text);
    const auto index = static_cast<std::uint32_t>(known - texts.begin());
    if (known == texts.end()) texts.push_back(text);
    return graph.input(index, type);
}

std::vector<Record> member_records(const ir::Module& module, const Dialect& dialect,
                                   const std::vector<Member>& members, bool defaults)
{
    std::vector<Record> records;
    for (const Member& member : members) {
        const ir::Input& input = member.input;
        const bool parameter = input.origin == ir::Origin::parameter;
        std::string doc =
            parameter ? module.parameters[input.which].doc
                      : std::string{ir::facts(static_cast<ir::SurfaceField>(input.which)).doc};
        if (doc.empty()) doc = input.name;
        const bool flag = input.type == ir::Type::boolean;
        const std::string range = flag ? std::string{} : range_text(input.range);
        if (!range.empty()) doc += (doc.ends_with('.') ? " " : "; ") + range;

        Record record{{{"type", std::string{dialect.type(input.type)}}, {"name", member.name}},
                      {{"comment", lines(fill(doc, 90))}}};
        if (defaults) {
            std::vector<std::string> values;
            for (const double value : module.parameters[input.which].default_value)
                values.push_back(input.type == ir::Type::boolean ? (value != 0 ? "true" : "false")
                                                                 : dialect.literal(value));
            record.texts["value"] =
                values.size() == 1
                    ? values.front()
                    : fmt::format("{}{}{}{}", dialect.type(input.type), dialect.call_open,
                                  fmt::join(values, ", "), dialect.call_close);
        }
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<Record> model_comment(const ir::Module& module, const ir::Model& model,
                                  const Listing& listing)
{
    // Lines that start with a source's name are citations.
    std::string prose;
    std::vector<ir::Citation> citations;
    for (std::string_view rest = model.doc; !rest.empty();) {
        const auto end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        const auto space = line.find(' ');
        const bool cites = std::ranges::any_of(module.sources, [&](const ir::Source& source) {
            return source.name == line.substr(0, space);
        });
        if (cites)
            citations.push_back(
                {std::string{line.substr(0, space)},
                 std::string{space == std::string_view::npos ? "" : line.substr(space + 1)}});
        else
            prose += std::string{line} + "\n";
    }
    std::vector<std::string> text = listing.documentation(prose, citations, model.span);
    text.push_back(listing.cite(model.span));
    return lines(text);
}

}  // namespace lobe::emit
