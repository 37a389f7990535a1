// GLSL, ESSL and HLSL: one file per module. Its functions, and for every model a structure of
// parameters with its defaults, one of surface fields, and a function from vectors to results.
#include "emit/frame.h"
#include "emit/model.h"
#include "emit/wrap.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {
namespace {

std::string pascal(std::string_view name)
{
    Dialect style;
    style.names = Case::pascal;
    return style.styled(name);
}

/// A structure, when it has members: a list of one or none.
std::vector<Record> structure(const std::string& type, std::vector<Record> members)
{
    if (members.empty()) return {};
    return {{{{"type", type}}, {{"members", std::move(members)}}}};
}

class ModelFrame {
public:
    ModelFrame(const ir::Module& module, const ir::Model& model, const Dialect& dialect,
               Listing& listing)
        : module_(module), model_(model), dialect_(dialect), listing_(listing),
          inputs_(inputs_of(module, model, dialect)),
          stem_(pascal(model_stem(module, model.name, dialect)))
    {
    }

    Record record(std::vector<std::string>& calls)
    {
        const std::string surface_type = listing_.unique(stem_ + "Surface");
        const std::string parameters_type = listing_.unique(stem_ + "Parameters");
        const std::string result_type = listing_.unique(stem_ + "Result");
        const std::string defaults = listing_.unique(model_.name + "_defaults");
        const std::string name = listing_.unique(model_.name);

        std::vector<std::string> arguments;
        const std::vector<Record> statements = entry(arguments, surface_type, parameters_type);
        Record record;
        record.tag = listing_.tag(model_.span);
        record.texts = {{"name", name},
                        {"result", result_type},
                        {"signature", wrap(fmt::format("{} {}({})", result_type, name,
                                                       fmt::join(arguments, ", ")),
                                           0, dialect_.indent)}};
        record.lists["comment"] = model_comment(module_, model_, listing_);
        record.lists["surfaces"] =
            structure(surface_type, member_records(module_, dialect_, inputs_.surface, false));
        record.lists["parameters"] =
            structure(parameters_type, member_records(module_, dialect_, inputs_.parameters, true));
        for (Record& parameters : record.lists["parameters"])
            parameters.texts["defaults"] = defaults;
        record.lists["statements"] = statements;
        record.lists["outputs"] = outputs_;
        record_call(calls, name, result_type, surface_type, parameters_type, defaults);
        return record;
    }

private:
    /// The statements before the outputs; fills `outputs_` and the arguments.
    std::vector<Record> entry(std::vector<std::string>& arguments, const std::string& surface_type,
                              const std::string& parameters_type)
    {
        TextGraph text;
        Scope scope = listing_.scope();
        const auto argument = [&](std::string_view type, const std::string& wanted) {
            const std::string name = scope.namer.unique(wanted);
            arguments.push_back(fmt::format("{} {}", type, name));
            argument_types_.emplace_back(type);
            return name;
        };
        const auto vector = [&](ir::GeometryField field) {
            const ir::FieldFacts& facts = ir::facts(field);
            return text.input(argument(dialect_.type(facts.type), std::string{facts.name}),
                              facts.type);
        };
        ir::Frame frame;
        if (!inputs_.geometry.empty()) {
            frame.l = vector(ir::GeometryField::l);
            frame.v = vector(ir::GeometryField::v);
            frame.n = vector(ir::GeometryField::n);
        }
        if (inputs_.needs_tangents()) {
            frame.x = vector(ir::GeometryField::x);
            frame.y = vector(ir::GeometryField::y);
        }
        for (const ir::GeometryField field : inputs_.geometry) frame.expect(field);
        std::string surface;
        std::string parameters;
        if (!inputs_.surface.empty()) surface = argument(surface_type, "surface") + ".";
        if (!inputs_.parameters.empty()) parameters = argument(parameters_type, "parameters") + ".";
        std::vector<std::string> own;
        for (const ir::Input& input : inputs_.arguments)
            own.push_back(argument(dialect_.type(input.type), input_name(dialect_, input)));

        std::vector<ir::ExprId> roots;
        for (const ir::ModelOutput& output : model_.outputs)
            roots.push_back(text.call(module_, output.function, [&](const ir::Input& input) {
                switch (input.origin) {
                case ir::Origin::geometry: {
                    const auto field = static_cast<ir::GeometryField>(input.which);
                    const ir::ExprId value = ir::expand(text.graph, field, frame);
                    text.graph.set_name(value, input_name(dialect_, input));
                    return value;
                }
                case ir::Origin::surface:
                    return text.input(surface + member(inputs_.surface, input), input.type);
                case ir::Origin::parameter:
                    return text.input(parameters + member(inputs_.parameters, input), input.type);
                case ir::Origin::emitter:
                case ir::Origin::argument: break;
                }
                for (std::size_t i = 0; i < own.size(); ++i)
                    if (inputs_.arguments[i].name == input.name)
                        return text.input(own[i], input.type);
                return ir::ExprId{};
            }));

        const std::string result = scope.namer.unique("result");
        scope.inputs = text.texts;
        const Body body = listing_.write(scope, text.graph, roots);
        std::vector<Statement> after;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const ir::ModelOutput& output = model_.outputs[i];
            outputs_.push_back(
                {{{"type", std::string{dialect_.type(module_[output.function].type())}},
                  {"name", result_names_.unique(output.name)}},
                 {}});
            after.push_back({fmt::format("{}.{} = {};", result, outputs_.back().texts.at("name"),
                                         body.results[i].text),
                             module_[output.function].span});
        }
        std::vector<Record> statements = listing_.statements(body.locals);
        const std::string result_type = stem_ + "Result";
        statements.push_back({{{"text", fmt::format("{} {};", result_type, result)}}, {}});
        for (Record& assignment : listing_.statements(after))
            statements.push_back(std::move(assignment));
        statements.push_back({{{"text", fmt::format("return {};", result)}}, {}});
        return statements;
    }

    static std::string member(const std::vector<Member>& members, const ir::Input& input)
    {
        for (const Member& member : members)
            if (member.input.which == input.which) return member.name;
        return {};
    }

    /// Statements for the frame's main that call the model once.
    void record_call(std::vector<std::string>& calls, const std::string& name,
                     const std::string& result_type, const std::string& surface_type,
                     const std::string& parameters_type, const std::string& defaults) const
    {
        std::vector<std::string> operands;
        for (const std::string& type : argument_types_) {
            if (type == surface_type) {
                calls.push_back(fmt::format("{} frame_{}_surface;", surface_type, model_.name));
                for (const Member& member : inputs_.surface)
                    calls.push_back(fmt::format("frame_{}_surface.{} = {};", model_.name,
                                                member.name, sample(dialect_, member.input.type)));
                operands.push_back(fmt::format("frame_{}_surface", model_.name));
            } else if (type == parameters_type) {
                operands.push_back(defaults + "()");
            } else {
                operands.push_back(sample(dialect_, type_named(type)));
            }
        }
        calls.push_back(fmt::format("{} frame_{} = {}({});", result_type, model_.name, name,
                                    fmt::join(operands, ", ")));
        for (std::size_t i = 0; i < outputs_.size(); ++i)
            calls.push_back(fmt::format(
                "frame_sum += {};",
                to_float(module_[model_.outputs[i].function].type(),
                         fmt::format("frame_{}.{}", model_.name, outputs_[i].texts.at("name")))));
    }

    ir::Type type_named(std::string_view text) const
    {
        for (std::size_t i = 0; i < dialect_.types.size(); ++i)
            if (dialect_.types[i] == text) return static_cast<ir::Type>(i);
        return ir::Type::scalar;
    }

    const ir::Module& module_;
    const ir::Model& model_;
    const Dialect& dialect_;
    Listing& listing_;
    ModelInputs inputs_;
    std::string stem_;
    Namer result_names_{dialect_};
    std::vector<Record> outputs_;
    std::vector<std::string> argument_types_;
};

}  // namespace

std::string sample(const Dialect& dialect, ir::Type type)
{
    if (type == ir::Type::boolean) return "frame_x > 0.0";
    if (type == ir::Type::scalar) return "frame_x";
    return dialect.spread_by_cast ? fmt::format("({})frame_x", dialect.type(type))
                                  : fmt::format("{}(frame_x)", dialect.type(type));
}

std::string to_float(ir::Type type, const std::string& value)
{
    if (type == ir::Type::boolean) return fmt::format("({}) ? 1.0 : 0.0", value);
    return type == ir::Type::scalar ? value : fmt::format("length({})", value);
}

std::vector<std::string> root_calls(const ir::Module& module,
                                    const std::vector<ir::FunctionId>& roots,
                                    const Listing& listing, const Dialect& dialect)
{
    std::vector<std::string> calls;
    for (const ir::FunctionId root : roots) {
        std::vector<std::string> operands;
        for (const ir::Input& input : module[root].inputs)
            operands.push_back(sample(dialect, input.type));
        calls.push_back(
            fmt::format("frame_sum += {};",
                        to_float(module[root].type(), fmt::format("{}({})", listing.name_of(root),
                                                                  fmt::join(operands, ", ")))));
    }
    return calls;
}

ShadingFiles::ShadingFiles(const ir::Module& module, const Sources& sources, const Target& target,
                           Part part)
    : module_(module.name), stem_(file_stem(module, part)), dialect_(&dialect(target)),
      listing_(module, sources, *dialect_, module.reachable(roots_of(module, part)),
               function_prefix(module, target),
               part == Part::own ? std::vector<std::string>{}
                                 : names_of_shared(module, sources, target, roots_of(module, part)))
{
    calls_ = root_calls(module, roots_of(module, part), listing_, *dialect_);
    values_.texts = {{"banner", banner(module)},
                     {"guard", include_guard(module, target, part == Part::own ? "" : "lights")}};
    values_.lists["remarks"] = remarks(module);
    values_.lists["doc"] = module_doc(module);
    std::vector<Record> models;
    if (part == Part::own)
        for (const ir::Model& model : module.models)
            models.push_back(ModelFrame{module, model, *dialect_, listing_}.record(calls_));
    values_.lists["functions"] = listing_.functions();
    values_.lists["models"] = std::move(models);
    values_.lists["helpers"] = listing_.helpers();
}

Artifact ShadingFiles::artifact(const Target& target)
{
    const bool precise = target.language == Language::essl;
    std::optional<Rendered>& rendered = rendered_[precise ? 1 : 0];
    if (!rendered && target.language == Language::hlsl) {
        rendered = render_embedded("hlsl/module.hlsl", values_);
    } else if (!rendered) {
        values_.lists["precisions"] = std::vector<Record>(precise ? 1 : 0);
        rendered = render_embedded("glsl/module.glsl", values_);
    }
    return {fmt::format("{}/{}/{}{}", module_, target.name, stem_, target.extension),
            rendered->text, listing_.origins(rendered->marks), calls_};
}

}  // namespace lobe::emit
