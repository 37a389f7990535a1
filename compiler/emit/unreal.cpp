// Unreal Engine 4: one .ush per module, and for every model that is lit by a light a BxDF with the
// engine's signature.
//
// The engine gives NoL and, through BxDFContext, angles that SphereMaxNoH moves for lights with a
// size. The diffuse part reads them before, the specular part after. The stable fields are not in
// the context. For a point light they come from the vectors, as everywhere; where SphereMaxNoH has
// moved the half vector no vector is left that belongs to it, and they come from the moved cosines,
// which is as accurate as these: a light of that size has no peak finer than a float can resolve.
#include "emit/unreal.h"

#include "emit/frame.h"
#include "emit/model.h"
#include "ir/shade.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {
namespace {

using Field = ir::GeometryField;

/// Fields that the engine's context lacks.
bool is_stable(Field field) { return !ir::facts(field).nameable; }

/// The geometry and surface of a BxDF as expressions over the names in its scope, before or after
/// SphereMaxNoH.
class Phase {
public:
    /// Stable fields of the light as a point, and the locals that hold them.
    using Points = std::vector<std::pair<Field, std::string>>;

    /// `points` is what the phase before SphereMaxNoH left; nullptr is that phase.
    Phase(std::string roughness, const Points* points)
        : roughness_(std::move(roughness)), points_(points)
    {
    }

    TextGraph text;

    /// Named where it is more than a name already.
    ir::ExprId field(Field field, const std::string& name)
    {
        if (field == Field::h) {
            const ir::ExprId h = ir::expand(text.graph, field, frame());
            text.graph.set_name(h, "h");
            return h;
        }
        const ir::ExprId value = is_stable(field) ? stable(field) : plain(field);
        text.graph.set_name(value, points_ != nullptr ? "Area" + name : name);
        return value;
    }

    ir::ExprId surface(ir::SurfaceField field)
    {
        if (field == ir::SurfaceField::roughness) return scalar(roughness_);
        if (field == ir::SurfaceField::alpha) {
            const ir::ExprId roughness = scalar(roughness_);
            return text.graph.apply(ir::Op::multiply, {roughness, roughness});
        }
        return text.input(std::string{gbuffer_field(field)}, ir::facts(field).type);
    }

private:
    ir::ExprId vector(const std::string& name) { return text.input(name, ir::Type::vec3); }
    ir::ExprId scalar(const std::string& name) { return text.input(name, ir::Type::scalar); }
    ir::Frame frame() { return {vector("L"), vector("V"), vector("N"), {}, {}}; }

    ir::ExprId plain(Field field)
    {
        const auto clamped = [&](const std::string& name) {
            ir::Graph& g = text.graph;
            return g.apply(ir::Op::clamp, {scalar(name), g.literal("-1"), g.literal("1")});
        };
        switch (field) {
        case Field::l: return vector("L");
        case Field::v: return vector("V");
        case Field::n: return vector("N");
        case Field::x: return vector("X");
        case Field::y: return vector("Y");
        case Field::cos_i: return scalar("NoL");
        case Field::cos_o: return scalar("NoV");
        case Field::cos_h: return scalar("Context.NoH");
        case Field::cos_d: return scalar("Context.VoH");
        case Field::v_dot_l: return clamped("Context.VoL");
        case Field::x_dot_l: return clamped("Context.XoL");
        case Field::y_dot_l: return clamped("Context.YoL");
        case Field::x_dot_v: return clamped("Context.XoV");
        case Field::y_dot_v: return clamped("Context.YoV");
        case Field::x_dot_h: return clamped("Context.XoH");
        case Field::y_dot_h: return clamped("Context.YoH");
        case Field::h:
        case Field::sin2_h:
        case Field::one_minus_cos_h:
        case Field::one_minus_cos_d: break;
        }
        return {};
    }

    ir::ExprId stable(Field field)
    {
        ir::Graph& g = text.graph;
        if (points_ == nullptr) return ir::expand(g, field, frame());
        const ir::ExprId cos =
            scalar(field == Field::one_minus_cos_d ? "Context.VoH" : "Context.NoH");
        ir::ExprId moved = g.apply(ir::Op::subtract, {g.literal("1"), cos});
        if (field == Field::sin2_h)
            moved = g.apply(ir::Op::multiply, {moved, g.apply(ir::Op::add, {g.literal("1"), cos})});
        std::string point;
        for (const auto& [known, name] : *points_)
            if (known == field) point = name;
        const ir::ExprId size = scalar("AreaLight.SphereSinAlpha");
        const ir::ExprId is_sphere = g.apply(ir::Op::less, {g.literal("0"), size});
        g.set_name(is_sphere, "is_sphere");
        return g.apply(ir::Op::select, {is_sphere, moved, scalar(point)});
    }

    std::string roughness_;
    const Points* points_;
};

class ModelFrame {
public:
    ModelFrame(const ir::Module& module, const ir::Model& model, const Dialect& dialect,
               Listing& listing)
        : module_(module), model_(model), dialect_(dialect), listing_(listing),
          inputs_(inputs_of(module, model, dialect)),
          snake_stem_(model_stem(module, model.name, dialect)), stem_(dialect.styled(snake_stem_))
    {
    }

    Record record(std::vector<std::string>& calls)
    {
        Record record;
        record.tag = listing_.tag(model_.span);
        record.lists["parameters"] = {};
        if (!inputs_.parameters.empty()) {
            Record structure;
            structure.texts = {{"type", listing_.unique("F" + stem_ + "Parameters")},
                               {"defaults", listing_.unique(stem_ + "Defaults")},
                               {"function", listing_.unique(stem_ + "ParametersOf")},
                               {"macro", parameters_macro(snake_stem_)}};
            structure.lists["members"] =
                member_records(module_, dialect_, inputs_.parameters, true);
            record.lists["parameters"].push_back(std::move(structure));
        }
        record.lists["bxdfs"] = {};
        if (!has_bxdf(inputs_)) return record;
        record.lists["bxdfs"].push_back(bxdf());
        const std::string& name = record.lists["bxdfs"].front().texts.at("name");
        calls.push_back(fmt::format("frame_sum += FrameBxDF( {}( FrameGBuffer( frame_x ), "
                                    "(half3)frame_x, (half3)frame_x, (half3)frame_x, frame_x, "
                                    "frame_x, FrameAreaLight( frame_x ), (FShadowTerms)0 ) );",
                                    name));
        return record;
    }

private:
    Record bxdf()
    {
        const bool rough = std::ranges::any_of(
            inputs_.surface, [](const Member& member) { return is_roughness(member.input); });
        const bool rough_specular = std::ranges::any_of(model_.outputs, [&](const auto& output) {
            return !is_before(output) &&
                   std::ranges::any_of(module_[output.function].inputs,
                                       [](const ir::Input& input) { return is_roughness(input); });
        });
        const std::string least = dialect_.literal(least_roughness);

        Record record{{{"name", listing_.unique(stem_ + "BxDF")}}, {}};
        record.lists["comment"] = model_comment(module_, model_, listing_);
        record.lists["roughness"] = {};
        if (rough) record.lists["roughness"] = {{{{"name", "Roughness"}, {"least", least}}, {}}};
        const bool tangents = inputs_.needs_tangents();
        record.lists["tangents"] = {};
        if (tangents) record.lists["tangents"] = {{{{"x", "X"}, {"y", "Y"}}, {}}};
        record.lists["isotropic"] = std::vector<Record>(tangents ? 0 : 1);
        Scope scope = scope_of_body();
        Phase::Points points;
        record.lists["before"] = before(scope, points);
        record.lists["specular"] = {};
        if (!std::ranges::all_of(model_.outputs, is_before)) {
            Record specular;
            specular.lists["widened"] = {};
            if (rough_specular)
                specular.lists["widened"] = {{{{"name", "SpecularRoughness"},
                                               {"roughness", "Roughness"},
                                               {"energy", "Energy"},
                                               {"least", least}},
                                              {}}};
            specular.lists["statements"] = after(scope, points, rough_specular);
            record.lists["specular"].push_back(std::move(specular));
        }
        return record;
    }

    static bool is_roughness(const ir::Input& input)
    {
        return input.origin == ir::Origin::surface &&
               (input.which == static_cast<std::uint32_t>(ir::SurfaceField::roughness) ||
                input.which == static_cast<std::uint32_t>(ir::SurfaceField::alpha));
    }

    ir::ExprId call(Phase& phase, const ir::ModelOutput& output) const
    {
        return phase.text.call(module_, output.function, [&](const ir::Input& input) {
            if (input.origin == ir::Origin::geometry)
                return phase.field(static_cast<Field>(input.which), input_name(dialect_, input));
            if (input.origin == ir::Origin::surface)
                return phase.surface(static_cast<ir::SurfaceField>(input.which));
            std::string name;
            for (const Member& member : inputs_.parameters)
                if (member.input.which == input.which) name = member.name;
            return phase.text.input("Parameters." + name, input.type);
        });
    }

    Statement add_to(const ir::ModelOutput& output, std::string_view light,
                     const std::string& value) const
    {
        return {fmt::format("Lighting.{} += {} * {};", engine_output(output), light, value),
                module_[output.function].span};
    }

    /// Every stable field of the light as a point, noted in `points`, and the outputs that see the
    /// light so.
    std::vector<Record> before(Scope& scope, Phase::Points& points)
    {
        Phase phase{"Roughness", nullptr};
        std::vector<ir::ExprId> roots;
        for (const Field field : inputs_.geometry)
            if (is_stable(field)) {
                roots.push_back(phase.field(field, input_name(dialect_, field_input(field))));
                points.emplace_back(field, "");
            }
        const std::size_t stable = roots.size();
        std::vector<const ir::ModelOutput*> outputs;
        for (const ir::ModelOutput& output : model_.outputs)
            if (is_before(output)) {
                outputs.push_back(&output);
                roots.push_back(call(phase, output));
            }
        scope.inputs = phase.text.texts;
        Body body = listing_.write(scope, phase.text.graph, roots);
        for (std::size_t i = 0; i < stable; ++i) points[i].second = body.results[i].text;
        for (std::size_t i = stable; i < roots.size(); ++i)
            body.locals.push_back(add_to(*outputs[i - stable], "LightColor", body.results[i].text));
        return listing_.statements(body.locals);
    }

    /// The outputs that follow the mirror direction of a light with a size.
    std::vector<Record> after(Scope& scope, const Phase::Points& points, bool widened)
    {
        Phase phase{widened ? "SpecularRoughness" : "Roughness", &points};
        std::vector<ir::ExprId> roots;
        std::vector<const ir::ModelOutput*> outputs;
        for (const ir::ModelOutput& output : model_.outputs)
            if (!is_before(output)) {
                outputs.push_back(&output);
                roots.push_back(call(phase, output));
            }
        scope.inputs = phase.text.texts;
        Body body = listing_.write(scope, phase.text.graph, roots);
        for (std::size_t i = 0; i < roots.size(); ++i)
            body.locals.push_back(add_to(
                *outputs[i], widened ? "LightColor * Energy" : "LightColor", body.results[i].text));
        return listing_.statements(body.locals);
    }

    static ir::Input field_input(Field field)
    {
        ir::Input input;
        input.origin = ir::Origin::geometry;
        input.which = static_cast<std::uint32_t>(field);
        return input;
    }

    /// A scope that knows what the template's own lines name.
    Scope scope_of_body() const
    {
        Scope scope = listing_.scope();
        for (const std::string_view name :
             {"GBuffer", "N", "V", "L", "X", "Y", "Falloff", "NoL", "AreaLight", "Shadow",
              "Parameters", "Roughness", "Context", "NoV", "LightColor", "Lighting",
              "SpecularRoughness", "Energy", "a2"})
            scope.namer.unique(name);
        return scope;
    }

    const ir::Module& module_;
    const ir::Model& model_;
    const Dialect& dialect_;
    Listing& listing_;
    ModelInputs inputs_;
    std::string snake_stem_;
    std::string stem_;
};

}  // namespace

bool is_before(const ir::ModelOutput& output) { return !ir::follows_mirror(output); }

std::string_view engine_output(const ir::ModelOutput& output)
{
    if (output.name == "diffuse") return "Diffuse";
    return output.name == "transmission" ? "Transmission" : "Specular";
}

bool has_bxdf(const ModelInputs& inputs)
{
    // True when a light's direction matters: more is asked than the normal and the eye.
    const bool lit = std::ranges::any_of(inputs.geometry, [](Field field) {
        return field != Field::n && field != Field::v && field != Field::cos_o &&
               field != Field::x && field != Field::y && field != Field::x_dot_v &&
               field != Field::y_dot_v;
    });
    return lit && inputs.arguments.empty();
}

std::string parameters_macro(std::string_view stem)
{
    std::string result;
    for (const char c : stem) result += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return result + "_PARAMETERS";
}

std::string_view gbuffer_field(ir::SurfaceField field)
{
    switch (field) {
    case ir::SurfaceField::base_color: return "GBuffer.BaseColor";
    case ir::SurfaceField::metallic: return "GBuffer.Metallic";
    case ir::SurfaceField::specular: return "GBuffer.Specular";
    case ir::SurfaceField::roughness:
    case ir::SurfaceField::alpha: return "GBuffer.Roughness";
    case ir::SurfaceField::diffuse_color: return "GBuffer.DiffuseColor";
    case ir::SurfaceField::f0: return "GBuffer.SpecularColor";
    }
    return {};
}

Artifact emit_unreal(const ir::Module& module, const Sources& sources, const Target& target,
                     Part part)
{
    const Dialect& language = dialect(target);
    const std::vector<ir::FunctionId> roots = roots_of(module, part);
    std::vector<std::string> taken;
    if (part != Part::own) taken = names_of_shared(module, sources, target, roots);
    Listing listing{
        module, sources, language, module.reachable(roots), function_prefix(module, target), taken};
    std::vector<std::string> calls = root_calls(module, roots, listing, language);

    Record values;
    values.texts = {{"banner", banner(module)}};
    values.lists["remarks"] = remarks(module);
    values.lists["doc"] = module_doc(module);
    std::vector<Record> models;
    if (part == Part::own)
        for (const ir::Model& model : module.models)
            models.push_back(ModelFrame{module, model, language, listing}.record(calls));
    values.lists["functions"] = listing.functions();
    values.lists["models"] = std::move(models);
    values.lists["helpers"] = listing.helpers();

    Rendered rendered = render_embedded("ue4/module.ush", values);
    if (rendered.text.ends_with("\n\n")) rendered.text.pop_back();
    return {fmt::format("{}/{}/{}{}", module.name, target.name,
                        language.styled(file_stem(module, part)), target.extension),
            rendered.text, listing.origins(rendered.marks), std::move(calls)};
}

}  // namespace lobe::emit
