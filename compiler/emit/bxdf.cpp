// A BxDF as something to run: the emitted file under a point light of radiance 1, and the function
// over vectors that it must compute there.
//
// That function differs from a model's output in what the engine prescribes: NoV is |n.v| + 1e-5,
// NoH and VoH come from the engine's context. Where the model is packed there is a second check of
// every output: parameters then come out of the channels, by the packing's own file, and must be
// what its unpack functions say.
#include "emit/frame.h"
#include "emit/packing.h"
#include "emit/unreal.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {
namespace {

using Field = ir::GeometryField;
using ir::ExprId;
using ir::Op;

/// Geometry as the BxDF sees it, over vectors.
class PointLight {
public:
    PointLight(ir::Graph& graph, const ir::Frame& frame) : g_(graph), frame_(frame) {}

    ExprId field(Field field)
    {
        const ExprId n_dot_l = dot(frame_.n, frame_.l);
        const ExprId n_dot_v = dot(frame_.n, frame_.v);
        const ExprId v_dot_l = dot(frame_.v, frame_.l);
        switch (field) {
        case Field::cos_i: return saturate(n_dot_l);
        case Field::cos_o:
            return saturate(add(g_.apply(Op::absolute, {n_dot_v}), g_.literal("1e-5")));
        case Field::cos_h: return saturate(over_length(add(n_dot_l, n_dot_v), v_dot_l));
        case Field::cos_d: return saturate(over_length(add(g_.literal("1"), v_dot_l), v_dot_l));
        case Field::v_dot_l:
            return g_.apply(Op::clamp, {v_dot_l, g_.literal("-1"), g_.literal("1")});
        default: return ir::expand(g_, field, frame_);
        }
    }

private:
    ExprId dot(ExprId a, ExprId b) { return g_.apply(Op::dot, {a, b}); }
    ExprId add(ExprId a, ExprId b) { return g_.apply(Op::add, {a, b}); }
    ExprId saturate(ExprId a) { return g_.apply(Op::saturate, {a}); }

    /// Over the length of l + v.
    ExprId over_length(ExprId x, ExprId v_dot_l)
    {
        const ExprId two = g_.literal("2");
        const ExprId square = add(two, g_.apply(Op::multiply, {two, v_dot_l}));
        return g_.apply(Op::multiply, {x, g_.apply(Op::inverse_square_root, {square})});
    }

    ir::Graph& g_;
    ir::Frame frame_;
};

/// A packing that fills the parameters of a model, as the engine's shaders reach it.
struct Packed {
    const ir::Packing* packing = nullptr;
    GbufferAccess access;
};

/// The first one of a model, which has the macro that the model's file looks for.
std::optional<Packed> packed(const ir::Module& module, const ir::Model& model)
{
    for (std::size_t i = 0; i < module.packings.size(); ++i) {
        const ir::Packing& packing = module.packings[i];
        if (packing.model.name != model.name || packing.model.module != model.module) continue;
        if (auto access = gbuffer_access(module, i)) return Packed{&packing, std::move(*access)};
        return std::nullopt;
    }
    return std::nullopt;
}

/// The function over vectors, under construction.
class UnderPointLight {
public:
    UnderPointLight(const ir::Module& module, const ir::ModelOutput& output, std::string name,
                    const Packed* packed)
        : module_(module), output_(output), packed_(packed), function_(module[output.function])
    {
        function_.name = std::move(name);
        function_.graph = {};
        function_.inputs.clear();
    }

    ir::Function build()
    {
        const ir::Function& callee = module_[output_.function];
        ir::Frame frame;
        frame.l = add_vector(Field::l);
        frame.v = add_vector(Field::v);
        frame.n = add_vector(Field::n);
        PointLight light{function_.graph, frame};

        std::vector<ExprId> operands;
        for (const ir::Input& input : callee.inputs) {
            if (input.origin == ir::Origin::geometry)
                operands.push_back(light.field(static_cast<Field>(input.which)));
            else if (input.origin == ir::Origin::parameter && packed_ != nullptr)
                operands.push_back(unpacked(input));
            else
                operands.push_back(given(input));
        }
        function_.result =
            function_.graph.call(output_.function, callee.type(), operands, callee.span);
        return std::move(function_);
    }

private:
    ExprId add_input(const ir::Input& input)
    {
        function_.inputs.push_back(input);
        return function_.graph.input(static_cast<std::uint32_t>(function_.inputs.size() - 1),
                                     input.type);
    }

    ExprId add_vector(Field field)
    {
        const ir::FieldFacts& known = ir::facts(field);
        return add_input({std::string{known.name},
                          known.type,
                          ir::Quantity::direction,
                          {known.low, known.high},
                          ir::Origin::geometry,
                          static_cast<std::uint32_t>(field),
                          {}});
    }

    ExprId given(const ir::Input& input)
    {
        const ExprId value = add_input(input);
        const bool roughness =
            input.origin == ir::Origin::surface &&
            input.which == static_cast<std::uint32_t>(ir::SurfaceField::roughness);
        if (!roughness) return value;
        return function_.graph.apply(Op::maximum,
                                     {value, function_.graph.literal(least_roughness)});
    }

    /// What the channels hold of a parameter; its default where it is not packed.
    ExprId unpacked(const ir::Input& input)
    {
        ir::Graph& g = function_.graph;
        for (const auto& parameter : packed_->packing->parameters) {
            if (parameter.parameter != input.which) continue;
            std::vector<ExprId> operands;
            for (std::size_t i = 0; i < parameter.channels.size(); ++i)
                operands.push_back(
                    stored(module_[parameter.unpack].inputs[i], parameter.channels[i]));
            return g.call(parameter.unpack, input.type, operands);
        }
        std::vector<ExprId> parts;
        for (const double part : module_.parameters[input.which].default_value)
            parts.push_back(g.literal(fmt::format("{}", part)));
        if (input.type == ir::Type::boolean)
            return g.apply(Op::not_equal, {parts[0], g.literal("0")});
        return parts.size() == 1 ? parts[0] : g.construct(input.type, parts);
    }

    /// What a channel reads: an input, with the index among Packing::channels for its `which`.
    ExprId stored(const ir::Input& reading, std::size_t channel)
    {
        const auto which = static_cast<std::uint32_t>(channel);
        if (const auto known = function_.find_input(ir::Origin::argument, which))
            return function_.graph.input(*known, reading.type);
        ir::Input input = reading;
        input.which = which;
        return add_input(input);
    }

    const ir::Module& module_;
    const ir::ModelOutput& output_;
    const Packed* packed_;
    ir::Function function_;
};

/// `float3( harness_points[harness_base + 3u], … )`
std::string read(const Dialect& dialect, ir::Type type, int at)
{
    std::vector<std::string> floats;
    for (int i = 0; i < ir::components(type); ++i)
        floats.push_back(fmt::format("harness_points[harness_base + {}u]", at + i));
    if (type == ir::Type::boolean) return floats.front() + " != 0.0";
    if (floats.size() == 1) return floats.front();
    return fmt::format("{}( {} )", dialect.type(type), fmt::join(floats, ", "));
}

Harness run_bxdf(const ir::Module& module, const ir::Model& model, const ir::ModelOutput& output,
                 const ir::Function& entry, const Artifact& artifact, const Packed* packed,
                 const Dialect& dialect)
{
    const std::string stem = model_stem(module, model.name, dialect);
    const ModelInputs inputs = inputs_of(module, model, dialect);
    Harness result;
    std::vector<std::string> loads;
    std::string parameters;
    for (const ir::Input& input : entry.inputs) {
        const std::string value = read(dialect, input.type, result.inputs);
        result.inputs += ir::components(input.type);
        if (input.origin == ir::Origin::geometry) {
            loads.push_back(fmt::format("const {} {} = {};", dialect.type(input.type),
                                        dialect.styled(input.name), value));
        } else if (input.origin == ir::Origin::surface) {
            const auto field = static_cast<ir::SurfaceField>(input.which);
            loads.push_back(fmt::format("{} = {};", gbuffer_field(field), value));
        } else if (packed != nullptr) {
            loads.push_back(fmt::format("{} = {};", packed->access.fields[input.which], value));
        } else {
            for (const Member& member : inputs.parameters)
                if (member.input.which == input.which)
                    parameters += fmt::format(" Parameters.{} = {};", member.name, value);
        }
    }
    result.outputs = ir::components(entry.type());

    Record values;
    values.texts = {{"stride", std::to_string(result.inputs)},
                    {"bxdf", dialect.styled(stem) + "BxDF"}};
    values.lists["prelude"] = lines({unreal_prelude()});
    values.lists["macros"] = {};
    if (!parameters.empty())
        values.lists["macros"] = {
            {{{"name", parameters_macro(stem)}, {"statements", parameters.substr(1)}}, {}}};
    values.lists["loads"] = lines(loads);
    for (int i = 0; i < result.outputs; ++i)
        values.lists["stores"].push_back(
            {{{"outputs", std::to_string(result.outputs)},
              {"component", std::to_string(i)},
              {"value", fmt::format("Lighting.{}.{}", engine_output(output), "xyz"[i])}},
             {}});
    Framed framed = insert(render_embedded("harness/bxdf.hlsl", values).text, artifact.text);
    result.artifact.path = fmt::format("{}/ue4/harness/{}.hlsl", module.name, entry.name);
    result.artifact.text = std::move(framed.text);
    result.artifact.origins = moved_down(artifact.origins, framed.first_line - 1);
    return result;
}

/// Two artifacts as one file.
Artifact joined(Artifact first, const Artifact& second)
{
    const auto lines = static_cast<int>(std::ranges::count(first.text, '\n'));
    first.text += second.text;
    for (const LineOrigin& origin : moved_down(second.origins, lines))
        first.origins.push_back(origin);
    return first;
}

}  // namespace

std::vector<BxdfCheck> bxdf_checks(const ir::Module& module, const Sources& sources)
{
    const Target& target = *find_target("ue4");
    const Dialect& language = dialect(target);
    const Artifact artifact = emit_unreal(module, sources, target);
    std::vector<BxdfCheck> checks;
    for (const ir::Model& model : module.models) {
        const ModelInputs inputs = inputs_of(module, model, language);
        if (!has_bxdf(inputs) || inputs.needs_tangents()) continue;
        const auto add = [&](const Packed* by, const Artifact& text, std::string_view suffix) {
            for (const ir::ModelOutput& output : model.outputs) {
                const auto shares = std::ranges::count(
                    model.outputs, engine_output(output),
                    [](const ir::ModelOutput& other) { return engine_output(other); });
                if (shares > 1) continue;
                const std::string name = fmt::format(
                    "{}BxDF_{}{}", language.styled(model_stem(module, model.name, language)),
                    engine_output(output), suffix);
                BxdfCheck check{module, ir::FunctionId{module.functions.size()}, {}};
                check.module.functions.push_back(UnderPointLight{module, output, name, by}.build());
                const ir::Function entry = ir::entry_point(check.module, check.function);
                check.harness = run_bxdf(module, model, output, entry, text, by, language);
                checks.push_back(std::move(check));
            }
        };
        add(nullptr, artifact, "");
        if (const auto by = packed(module, model))
            add(&*by, joined(PackingFiles{module, sources, target}.artifact(target), artifact),
                "_packed");
    }
    return checks;
}

}  // namespace lobe::emit
