#include "ir/geometry.h"

#include <array>

namespace lobe::ir {
namespace {

// ORDER GeometryField
constexpr std::array geometry_facts{
    FieldFacts{"l", Type::vec3, -1, 1, true, "unit vector to the light"},
    FieldFacts{"v", Type::vec3, -1, 1, true, "unit vector to the eye"},
    FieldFacts{"n", Type::vec3, -1, 1, true, "unit normal"},
    FieldFacts{"x", Type::vec3, -1, 1, true, "unit tangent"},
    FieldFacts{"y", Type::vec3, -1, 1, true, "unit bitangent"},
    FieldFacts{"h", Type::vec3, -1, 1, true, "half vector, normalize(l + v); 0 where l = -v"},
    FieldFacts{"cos_i", Type::scalar, 0, 1, true, "max(n.l, 0)"},
    FieldFacts{"cos_o", Type::scalar, 0, 1, true, "max(n.v, 0)"},
    FieldFacts{"cos_h", Type::scalar, 0, 1, true, "max(n.h, 0)"},
    FieldFacts{"cos_d", Type::scalar, 0, 1, true, "max(l.h, 0), which is max(v.h, 0)"},
    FieldFacts{"v_dot_l", Type::scalar, -1, 1, true, "v.l"},
    FieldFacts{"x_dot_l", Type::scalar, -1, 1, true, "x.l"},
    FieldFacts{"y_dot_l", Type::scalar, -1, 1, true, "y.l"},
    FieldFacts{"x_dot_v", Type::scalar, -1, 1, true, "x.v"},
    FieldFacts{"y_dot_v", Type::scalar, -1, 1, true, "y.v"},
    FieldFacts{"x_dot_h", Type::scalar, -1, 1, true, "x.h"},
    FieldFacts{"y_dot_h", Type::scalar, -1, 1, true, "y.h"},
    FieldFacts{"sin2_h", Type::scalar, 0, 1, false, "|n x h|^2, which is 1 - cos_h^2"},
    FieldFacts{"one_minus_cos_h", Type::scalar, 0, 1, false, "|n x h|^2 / (1 + n.h)"},
    FieldFacts{"one_minus_cos_d", Type::scalar, 0, 1, false, "|l - v|^2 / (4 (1 + l.h))"},
};

// The smallest roughness is 1/64: its fourth power, 2^-24, is the smallest half, and below it
// no 8-bit channel and no engine here tells roughnesses apart.
constexpr double least_roughness = 0x1p-6;

// ORDER SurfaceField
constexpr std::array surface_facts{
    FieldFacts{"base_color", Type::vec3, 0, 1, true, "base color, linear RGB"},
    FieldFacts{"metallic", Type::scalar, 0, 1, true, "0 dielectric, 1 metal"},
    FieldFacts{"specular", Type::scalar, 0, 1, true, "dielectric reflectance is 0.08 specular"},
    FieldFacts{"roughness", Type::scalar, least_roughness, 1, true, "perceptual roughness"},
    FieldFacts{"alpha", Type::scalar, least_roughness* least_roughness, 1, true, "roughness^2"},
    FieldFacts{"diffuse_color", Type::vec3, 0, 1, true, "diffuse albedo, linear RGB"},
    FieldFacts{"f0", Type::vec3, 0, 1, true, "reflectance at normal incidence, linear RGB"},
};

template <class Field, class Table>
std::optional<Field> find(const Table& table, std::string_view name)
{
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].nameable && table[i].name == name) return static_cast<Field>(i);
    return std::nullopt;
}

}  // namespace

const FieldFacts& facts(GeometryField field)
{
    return geometry_facts[static_cast<std::size_t>(field)];
}

const FieldFacts& facts(SurfaceField field)
{
    return surface_facts[static_cast<std::size_t>(field)];
}

std::optional<GeometryField> find_geometry_field(std::string_view name)
{
    return find<GeometryField>(geometry_facts, name);
}

std::optional<SurfaceField> find_surface_field(std::string_view name)
{
    return find<SurfaceField>(surface_facts, name);
}

bool needs_tangents(GeometryField field)
{
    switch (field) {
    case GeometryField::x:
    case GeometryField::y:
    case GeometryField::x_dot_l:
    case GeometryField::y_dot_l:
    case GeometryField::x_dot_v:
    case GeometryField::y_dot_v:
    case GeometryField::x_dot_h:
    case GeometryField::y_dot_h: return true;
    case GeometryField::l:
    case GeometryField::v:
    case GeometryField::n:
    case GeometryField::h:
    case GeometryField::cos_i:
    case GeometryField::cos_o:
    case GeometryField::cos_h:
    case GeometryField::cos_d:
    case GeometryField::v_dot_l:
    case GeometryField::sin2_h:
    case GeometryField::one_minus_cos_h:
    case GeometryField::one_minus_cos_d: return false;
    }
    return false;
}

ExprId expand(Graph& graph, GeometryField field, const Frame& frame)
{
    const auto dot = [&](ExprId a, ExprId b) { return graph.apply(Op::dot, {a, b}); };
    const auto saturate = [&](ExprId a) { return graph.apply(Op::saturate, {a}); };
    const auto field_of = [&](GeometryField other) { return expand(graph, other, frame); };
    const auto one = [&] { return graph.literal("1"); };
    // A cosine of two unit vectors, which rounding may push past 1.
    const auto cosine = [&](ExprId a, ExprId b) {
        if (frame.bare) return dot(a, b);
        return graph.apply(Op::clamp, {dot(a, b), graph.literal("-1"), one()});
    };

    switch (field) {
    case GeometryField::l: return frame.l;
    case GeometryField::v: return frame.v;
    case GeometryField::n: return frame.n;
    case GeometryField::x: return frame.x;
    case GeometryField::y: return frame.y;
    case GeometryField::h:
        return graph.apply(frame.bare ? Op::normalize : Op::guarded_normalize,
                           {graph.apply(Op::add, {frame.l, frame.v})});
    case GeometryField::cos_i: return saturate(dot(frame.n, frame.l));
    case GeometryField::cos_o: return saturate(dot(frame.n, frame.v));
    case GeometryField::cos_h: return saturate(dot(frame.n, field_of(GeometryField::h)));
    case GeometryField::cos_d: return saturate(dot(frame.l, field_of(GeometryField::h)));
    case GeometryField::v_dot_l: return cosine(frame.v, frame.l);
    case GeometryField::x_dot_l: return cosine(frame.x, frame.l);
    case GeometryField::y_dot_l: return cosine(frame.y, frame.l);
    case GeometryField::x_dot_v: return cosine(frame.x, frame.v);
    case GeometryField::y_dot_v: return cosine(frame.y, frame.v);
    case GeometryField::x_dot_h: return cosine(frame.x, field_of(GeometryField::h));
    case GeometryField::y_dot_h: return cosine(frame.y, field_of(GeometryField::h));
    case GeometryField::sin2_h: {
        // Where n.h <= 0 (h below the horizon, or no h at all) cos_h is 0, and this has to be 1.
        const ExprId h = field_of(GeometryField::h);
        const ExprId sine = graph.apply(Op::cross, {frame.n, h});
        const ExprId above = graph.apply(Op::less, {graph.literal("0"), dot(frame.n, h)});
        return graph.apply(Op::select, {above, saturate(dot(sine, sine)), one()});
    }
    case GeometryField::one_minus_cos_h: {
        const ExprId sin2 = field_of(GeometryField::sin2_h);
        const ExprId cos = field_of(GeometryField::cos_h);
        return saturate(graph.apply(Op::divide, {sin2, graph.apply(Op::add, {one(), cos})}));
    }
    case GeometryField::one_minus_cos_d: {
        const ExprId chord = graph.apply(Op::subtract, {frame.l, frame.v});
        const ExprId cos = field_of(GeometryField::cos_d);
        const ExprId quarter =
            graph.apply(Op::multiply, {graph.literal("0.25"), dot(chord, chord)});
        return saturate(graph.apply(Op::divide, {quarter, graph.apply(Op::add, {one(), cos})}));
    }
    }
    return {};
}

}  // namespace lobe::ir
