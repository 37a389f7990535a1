// Members: fields of structures, components of vectors, and what shader authors call them.
#include "check/lowering.h"

#include <fmt/format.h>

#include <array>

namespace lobe::check {

using ir::Quantity;

namespace {

struct ShaderName {
    std::string_view written;
    std::string_view field;
};

// What shader authors write for the fields of a geometry.
constexpr std::array shader_names{
    ShaderName{"NdotL", "cos_i"},   ShaderName{"NoL", "cos_i"},   ShaderName{"n_dot_l", "cos_i"},
    ShaderName{"NdotV", "cos_o"},   ShaderName{"NoV", "cos_o"},   ShaderName{"n_dot_v", "cos_o"},
    ShaderName{"NdotH", "cos_h"},   ShaderName{"NoH", "cos_h"},   ShaderName{"n_dot_h", "cos_h"},
    ShaderName{"LdotH", "cos_d"},   ShaderName{"LoH", "cos_d"},   ShaderName{"l_dot_h", "cos_d"},
    ShaderName{"VdotH", "cos_d"},   ShaderName{"VoH", "cos_d"},   ShaderName{"v_dot_h", "cos_d"},
    ShaderName{"VdotL", "v_dot_l"}, ShaderName{"VoL", "v_dot_l"}, ShaderName{"LdotV", "v_dot_l"},
};

std::string_view shader_field(std::string_view name)
{
    for (const ShaderName& known : shader_names)
        if (known.written == name) return known.field;
    return name;
}

std::vector<std::string> geometry_fields()
{
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(ir::GeometryField::one_minus_cos_d); ++i) {
        const ir::FieldFacts& known = ir::facts(static_cast<ir::GeometryField>(i));
        if (known.nameable) names.emplace_back(known.name);
    }
    return names;
}

std::vector<std::string> emitter_fields()
{
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(ir::EmitterField::distance_squared); ++i)
        names.emplace_back(ir::facts(static_cast<ir::EmitterField>(i)).name);
    return names;
}

std::vector<std::string> surface_fields()
{
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(ir::SurfaceField::f0); ++i)
        names.emplace_back(ir::facts(static_cast<ir::SurfaceField>(i)).name);
    return names;
}

}  // namespace

std::optional<Fix> Lowering::field_fix(std::string_view name, const Span& span,
                                       std::vector<std::string>& helps) const
{
    const std::string_view field = shader_field(name);
    const bool geometry = ir::find_geometry_field(field).has_value();
    if (!geometry && !ir::find_surface_field(field)) return std::nullopt;
    const Structure wanted = geometry ? Structure::geometry : Structure::surface;
    for (const auto& [local, known] : locals_)
        if (known.value.type.structure == wanted) {
            const std::string text = fmt::format("{}.{}", local, field);
            return Fix{span, text, fmt::format("write `{}`", text)};
        }
    helps.push_back(geometry ? fmt::format("take `g: geometry` and write `g.{}`", field)
                             : fmt::format("take `s: surface` and write `s.{}`", field));
    return std::nullopt;
}

Value Lowering::unknown_member(const syntax::Member& member, const ValueType& type,
                               const std::vector<std::string>& known)
{
    const std::string& name = member.member.text;
    if (name.empty()) return {};  // a syntax error was reported
    const std::string_view field = shader_field(name);
    const bool translated = field != name && type.structure == Structure::geometry;
    Diagnostic diagnostic{
        .code = Code::unknown_member,
        .message = known.empty() ? fmt::format("{} has no members", describe(type))
                                 : fmt::format("{} has no member `{}`", describe(type), name),
        .primary = {member.member.span, ""}};
    if (translated) {
        diagnostic.message += fmt::format("; here it is `{}`", field);
        diagnostic.fix =
            Fix{member.member.span, std::string{field}, fmt::format("write `{}`", field)};
    } else {
        diagnostic.message += did_you_mean(name, known);
        diagnostic.fix = rename_fix(name, member.member.span, known);
    }
    if (!known.empty())
        diagnostic.notes = {fmt::format("the members are {}", fmt::join(known, ", "))};
    diagnostics_->report(std::move(diagnostic));
    return {};
}

Value Lowering::lower_member(const syntax::Member& member, const Span& span)
{
    const Value base = value(member.base);
    if (!base.good) return {};
    const std::string& name = member.member.text;

    if (base.type.structure == Structure::geometry) {
        const auto field = ir::find_geometry_field(name);
        if (!field) return unknown_member(member, base.type, geometry_fields());
        const bool vector = ir::facts(*field).type == ir::Type::vec3;
        return good(vector ? direction_type : number_type, draft_.geometry(*field, span));
    }
    if (base.type.structure == Structure::surface) {
        const auto field = ir::find_surface_field(name);
        if (!field) return unknown_member(member, base.type, surface_fields());
        const bool vector = ir::facts(*field).type == ir::Type::vec3;
        return good(vector ? color_type : number_type, draft_.surface(*field, span));
    }

    if (base.type.structure == Structure::emitter) {
        const auto field = ir::find_emitter_field(name);
        if (!field) return unknown_member(member, base.type, emitter_fields());
        const bool vector = ir::facts(*field).type == ir::Type::vec3;
        const bool is_free = *field == ir::EmitterField::to_light;
        return good(is_free  ? vector_type(3)
                    : vector ? direction_type
                             : number_type,
                    draft_.emitter(*field, span));
    }

    const int count = is_vector(base.type) ? ir::components(base.type.type) : 0;
    const std::string_view letters = base.type.quantity == Quantity::color ? "rgb" : "xyzw";
    const std::size_t index = name.size() == 1 ? letters.find(name[0]) : std::string::npos;
    if (index >= static_cast<std::size_t>(count)) {
        std::vector<std::string> known;
        for (int i = 0; i < count; ++i) known.emplace_back(1, letters[static_cast<std::size_t>(i)]);
        return unknown_member(member, base.type, known);
    }
    return good(number_type, graph().component(base.expr, static_cast<int>(index), span));
}

}  // namespace lobe::check
