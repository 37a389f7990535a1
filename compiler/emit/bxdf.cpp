// A BxDF as something to run: the emitted file under a point light of radiance 1, and the function
// over vectors that it must compute there.
//
// That function differs from a model's output in what the engine prescribes: NoV is |n.v| + 1e-5,
// NoH and VoH come from the engine's context.
#include "emit/frame.h"
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

ir::Function under_point_light(const ir::Module& module, const ir::ModelOutput& output,
                               std::string name)
{
    const ir::Function& callee = module[output.function];
    ir::Function function = callee;
    function.name = std::move(name);
    function.graph = {};
    function.inputs.clear();

    const auto add_input = [&function](const ir::Input& input) {
        function.inputs.push_back(input);
        return function.graph.input(static_cast<std::uint32_t>(function.inputs.size() - 1),
                                    input.type);
    };
    const auto add_vector = [&](Field field) {
        const ir::FieldFacts& known = ir::facts(field);
        return add_input({std::string{known.name},
                          known.type,
                          ir::Quantity::direction,
                          {known.low, known.high},
                          ir::Origin::geometry,
                          static_cast<std::uint32_t>(field),
                          {}});
    };
    ir::Frame frame;
    frame.l = add_vector(Field::l);
    frame.v = add_vector(Field::v);
    frame.n = add_vector(Field::n);
    PointLight light{function.graph, frame};

    std::vector<ExprId> operands;
    for (const ir::Input& input : callee.inputs) {
        if (input.origin == ir::Origin::geometry) {
            operands.push_back(light.field(static_cast<Field>(input.which)));
            continue;
        }
        ExprId operand = add_input(input);
        if (input.origin == ir::Origin::surface &&
            input.which == static_cast<std::uint32_t>(ir::SurfaceField::roughness))
            operand = function.graph.apply(Op::maximum,
                                           {operand, function.graph.literal(least_roughness)});
        operands.push_back(operand);
    }
    function.result = function.graph.call(output.function, callee.type(), operands, callee.span);
    return function;
}

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
                 const ir::Function& entry, const Artifact& artifact, const Dialect& dialect)
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
    for (LineOrigin origin : artifact.origins) {
        origin.first += framed.first_line - 1;
        origin.last += framed.first_line - 1;
        result.artifact.origins.push_back(origin);
    }
    return result;
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
        for (const ir::ModelOutput& output : model.outputs) {
            const auto shares = std::ranges::count(
                model.outputs, engine_output(output),
                [](const ir::ModelOutput& other) { return engine_output(other); });
            if (shares > 1) continue;
            const std::string name =
                fmt::format("{}BxDF_{}", language.styled(model_stem(module, model.name, language)),
                            engine_output(output));
            BxdfCheck check{module, ir::FunctionId{module.functions.size()}, {}};
            check.module.functions.push_back(under_point_light(module, output, name));
            const ir::Function entry = ir::entry_point(check.module, check.function);
            check.harness = run_bxdf(module, model, output, entry, artifact, language);
            checks.push_back(std::move(check));
        }
    }
    return checks;
}

}  // namespace lobe::emit
