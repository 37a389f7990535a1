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
    FieldFacts{"one_minus_cos_h", Type::scalar, 0, 1, false, "|n - h|^2 / 2"},
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

// What the host counts lengths in: every whole number is a float up to here.
constexpr double farthest = 0x1p24;
// Of a source, and of an inverse range: 41 m in centimeters, and less than a millimeter in meters.
constexpr double largest = 0x1p12;

// ORDER EmitterField
constexpr std::array emitter_facts{
    FieldFacts{"to_light", Type::vec3, -farthest, farthest, true,
               "the vector from the shaded point to the light's center"},
    FieldFacts{"axis", Type::vec3, -1, 1, true,
               "the unit vector along which a spot shines or a tube lies"},
    FieldFacts{"radius", Type::scalar, 0, largest, true, "the radius of the source"},
    FieldFacts{"half_length", Type::scalar, 0, largest, true, "half the length of a tube"},
    FieldFacts{"inverse_range", Type::scalar, 0, largest, true,
               "1 / the distance at which the light ends; 0 where it does not"},
    FieldFacts{"cos_inner", Type::scalar, 0, 1, true, "the cosine of a spot's inner angle"},
    FieldFacts{"cos_outer", Type::scalar, 0, 1, true, "the cosine of a spot's outer angle"},
    FieldFacts{"v", Type::vec3, -1, 1, true, "unit vector to the eye"},
    FieldFacts{"n", Type::vec3, -1, 1, true, "unit normal"},
    FieldFacts{"l", Type::vec3, -1, 1, true, "unit vector to the light's center"},
    FieldFacts{"r", Type::vec3, -1, 1, true, "the eye mirrored by the normal"},
    FieldFacts{"distance_squared", Type::scalar, 0, 3 * farthest* farthest, true, "|to_light|^2"},
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

const FieldFacts& facts(EmitterField field)
{
    return emitter_facts[static_cast<std::size_t>(field)];
}

std::optional<GeometryField> find_geometry_field(std::string_view name)
{
    return find<GeometryField>(geometry_facts, name);
}

std::optional<SurfaceField> find_surface_field(std::string_view name)
{
    return find<SurfaceField>(surface_facts, name);
}

std::optional<EmitterField> find_emitter_field(std::string_view name)
{
    return find<EmitterField>(emitter_facts, name);
}

ExprId expand(Graph& graph, EmitterField field, const EmitterFrame& frame)
{
    switch (field) {
    case EmitterField::l: return graph.apply(Op::guarded_normalize, {frame.to_light});
    case EmitterField::distance_squared:
        return graph.apply(Op::dot, {frame.to_light, frame.to_light});
    case EmitterField::r: {
        const ExprId twice = graph.apply(
            Op::multiply, {graph.literal("2"), graph.apply(Op::dot, {frame.n, frame.v})});
        return graph.apply(Op::subtract, {graph.apply(Op::multiply, {twice, frame.n}), frame.v});
    }
    case EmitterField::to_light:
    case EmitterField::axis:
    case EmitterField::radius:
    case EmitterField::half_length:
    case EmitterField::inverse_range:
    case EmitterField::cos_inner:
    case EmitterField::cos_outer:
    case EmitterField::v:
    case EmitterField::n: break;
    }
    return {};
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

namespace {

/// What several fields are made from, in a graph that shares equal expressions.
class Expansion {
public:
    Expansion(Graph& graph, const Frame& frame) : graph_{graph}, frame_{frame} {}

    ExprId dot(ExprId a, ExprId b) { return graph_.apply(Op::dot, {a, b}); }
    ExprId saturated(ExprId a) { return graph_.apply(Op::saturate, {a}); }
    ExprId number(std::string_view text) { return graph_.literal(text); }
    ExprId times(std::string_view text, ExprId a)
    {
        return graph_.apply(Op::multiply, {number(text), a});
    }

    /// A cosine of two unit vectors, which rounding may push past 1.
    ExprId cosine(ExprId a, ExprId b)
    {
        if (frame_.bare) return dot(a, b);
        return graph_.apply(Op::clamp, {dot(a, b), number("-1"), number("1")});
    }

    ExprId h()
    {
        // That h is no longer than 1 is what this operation knows, and a product would not.
        const ExprId result =
            graph_.apply(frame_.bare ? Op::normalize : Op::guarded_normalize, {sum()});
        graph_.set_name(result, "h");
        return result;
    }

    ExprId cos_h()
    {
        if (!frame_.has_complement) return saturated(dot(frame_.n, h()));
        return graph_.apply(Op::subtract, {number("1"), one_minus_cos_h()});
    }

    /// |l + v| / 2
    ExprId cos_d()
    {
        if (frame_.bare) return saturated(dot(frame_.l, h()));
        return saturated(
            times("0.5", graph_.apply(Op::multiply, {squared_length(), inverse_length()})));
    }

    /// |n - h|^2 / 2, which is 1 - n.h for unit vectors. Where there is no h that is 1/2, and it
    /// has to be 1: the missing half goes with |l + v|^2, long before that is anything.
    ExprId one_minus_cos_h()
    {
        const ExprId chord = graph_.apply(Op::subtract, {frame_.n, h()});
        const ExprId lacks_h = saturated(graph_.apply(
            Op::subtract, {number("1"), graph_.apply(Op::multiply, {graph_.literal(0x1p124),
                                                                    squared_length()})}));
        graph_.set_name(lacks_h, "lacks_h");
        return saturated(graph_.apply(Op::add, {times("0.5", dot(chord, chord)), lacks_h}));
    }

    /// (1 - cos_h)(1 + cos_h), as a sum that joins with its product where that costs nothing.
    ExprId sin2_h()
    {
        const ExprId complement = one_minus_cos_h();
        const ExprId cosine = graph_.apply(Op::subtract, {number("1"), complement});
        const ExprId rest = graph_.apply(Op::multiply, {complement, cosine});
        return saturated(graph_.apply(Op::add, {complement, rest}));
    }

    /// |l + v|^2 / 2 - 1 where that sum is made anyway; it is not below -1.
    ExprId v_dot_l()
    {
        if (!frame_.has_sum || frame_.bare) return cosine(frame_.v, frame_.l);
        return graph_.apply(
            Op::minimum, {graph_.apply(Op::subtract, {times("0.5", squared_length()), number("1")}),
                          number("1")});
    }

    /// |l - v|^2 / (4 (1 + cos_d))
    ExprId one_minus_cos_d()
    {
        const ExprId chord = graph_.apply(Op::subtract, {frame_.l, frame_.v});
        const ExprId four_times = graph_.apply(Op::add, {number("4"), times("4", cos_d())});
        return saturated(graph_.apply(Op::divide, {dot(chord, chord), four_times}));
    }

private:
    /// A square below the least normal float counts as that.
    ExprId least() { return graph_.literal(0x1p-126); }
    ExprId sum()
    {
        const ExprId result = graph_.apply(Op::add, {frame_.l, frame_.v});
        graph_.set_name(result, "l_plus_v");
        return result;
    }
    ExprId squared_length()
    {
        const ExprId result = dot(sum(), sum());
        graph_.set_name(result, "length_squared");
        return result;
    }
    ExprId inverse_length()
    {
        const ExprId result = graph_.apply(
            Op::inverse_square_root, {graph_.apply(Op::maximum, {squared_length(), least()})});
        graph_.set_name(result, "inverse_length");
        return result;
    }

    Graph& graph_;
    const Frame& frame_;
};

}  // namespace

void Frame::expect(GeometryField field)
{
    switch (field) {
    // Not for sin2_h: what divides by cos_h near the horizon reads that, and needs the product.
    case GeometryField::one_minus_cos_h: has_complement = has_sum = true; break;
    case GeometryField::h:
    case GeometryField::cos_h:
    case GeometryField::cos_d:
    case GeometryField::x_dot_h:
    case GeometryField::y_dot_h:
    case GeometryField::sin2_h:
    case GeometryField::one_minus_cos_d: has_sum = true; break;
    case GeometryField::l:
    case GeometryField::v:
    case GeometryField::n:
    case GeometryField::x:
    case GeometryField::y:
    case GeometryField::cos_i:
    case GeometryField::cos_o:
    case GeometryField::v_dot_l:
    case GeometryField::x_dot_l:
    case GeometryField::y_dot_l:
    case GeometryField::x_dot_v:
    case GeometryField::y_dot_v: break;
    }
}

ExprId expand(Graph& graph, GeometryField field, const Frame& frame)
{
    Expansion of{graph, frame};
    switch (field) {
    case GeometryField::l: return frame.l;
    case GeometryField::v: return frame.v;
    case GeometryField::n: return frame.n;
    case GeometryField::x: return frame.x;
    case GeometryField::y: return frame.y;
    case GeometryField::h: return of.h();
    case GeometryField::cos_i: return of.saturated(of.dot(frame.n, frame.l));
    case GeometryField::cos_o: return of.saturated(of.dot(frame.n, frame.v));
    case GeometryField::cos_h: return of.cos_h();
    case GeometryField::cos_d: return of.cos_d();
    case GeometryField::v_dot_l: return of.v_dot_l();
    case GeometryField::x_dot_l: return of.cosine(frame.x, frame.l);
    case GeometryField::y_dot_l: return of.cosine(frame.y, frame.l);
    case GeometryField::x_dot_v: return of.cosine(frame.x, frame.v);
    case GeometryField::y_dot_v: return of.cosine(frame.y, frame.v);
    case GeometryField::x_dot_h: return of.cosine(frame.x, of.h());
    case GeometryField::y_dot_h: return of.cosine(frame.y, of.h());
    case GeometryField::sin2_h: return of.sin2_h();
    case GeometryField::one_minus_cos_h: return of.one_minus_cos_h();
    case GeometryField::one_minus_cos_d: return of.one_minus_cos_d();
    }
    return {};
}

}  // namespace lobe::ir
