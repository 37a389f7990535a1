// The standard structures of the language, as fields: `geometry`, `surface` and `emitter`.
//
// A function never receives a structure. It receives the fields that it uses, each as one input
// (see `Input::origin`), so generated functions have the signatures a shader author would write.
//
// Geometry, all directions unit vectors that point away from the surface:
//
//   l, v, n   to the light, to the eye, the normal        x, y  the tangent frame
//   h         normalize(l + v); 0 where l = -v
//   cos_i     max(n.l, 0)    cos_o  max(n.v, 0)    cos_h  max(n.h, 0)    cos_d  max(l.h, 0)
//   v_dot_l   v.l in [-1, 1]
//   x_dot_l .. y_dot_h  in [-1, 1]
//
// Fields marked stable below cannot be named in a .lobe file. They carry the same quantity
// without cancellation, and optimize/stabilize.cpp puts them where accuracy asks for them:
//
//   one_minus_cos_h   |n - h|^2 / 2                     = 1 - cos_h
//   sin2_h            one_minus_cos_h (1 + cos_h)       = 1 - cos_h^2
//   one_minus_cos_d   |l - v|^2 / (4 (1 + cos_d))       = 1 - cos_d
//
// and cos_d is |l + v| / 2. Where n.h <= 0, cos_h is 0 by definition, so sin2_h and
// one_minus_cos_h are 1 there.
//
// Why they are accurate: the differences of vectors are exact where they are small (Sterbenz), and
// a unit vector that rounding made longer by e moves |n - h|^2 / 2 by e (1 - cos_h) + e^2 / 2.
// Source: the law of cosines for unit vectors, and the half angle of l and v.
//
// An emitter is one light as the shaded point sees it. Its v and n are those of a geometry; what
// else it can be asked for follows from the vectors (`expand`):
//
//   to_light    from the point to the light's center, of any length; a directional light has none,
//               and this is the unit vector towards it
//   l           normalize(to_light); 0 where the light is the point
//   r           the eye mirrored by the normal, 2 (n.v) n - v
//   distance_squared   |to_light|^2
//
// A light's range is given by its inverse, as engines have it: none at all is 0 then, and no
// division is left that could see it.
//
// Lengths are in whatever unit the host counts in. They go up to 2^24, the last number up to which
// a float has every whole one: 168 km in centimeters. Sources and ranges go from 1/4096 to 4096 of
// it, so that every square and product of two squares here is far from the ends of float.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <string_view>

namespace lobe::ir {

enum class GeometryField : std::uint8_t {
    l,
    v,
    n,
    x,
    y,
    h,
    cos_i,
    cos_o,
    cos_h,
    cos_d,
    v_dot_l,
    x_dot_l,
    y_dot_l,
    x_dot_v,
    y_dot_v,
    x_dot_h,
    y_dot_h,
    sin2_h,
    one_minus_cos_h,
    one_minus_cos_d,
};

enum class SurfaceField : std::uint8_t {
    base_color,
    metallic,
    specular,
    roughness,
    alpha,
    diffuse_color,
    f0,
};

/// What a function receives comes first, and is an input; what is made of it follows.
enum class EmitterField : std::uint8_t {
    to_light,
    axis,
    radius,
    half_length,
    inverse_range,
    cos_inner,
    cos_outer,
    v,
    n,
    l,
    r,
    distance_squared,
};

/// What is known of a field without looking at any model.
struct FieldFacts {
    std::string_view name;
    Type type{};
    double low = 0;  ///< of every component
    double high = 0;
    bool nameable = true;  ///< false for the stable fields
    std::string_view doc;
};

const FieldFacts& facts(GeometryField field);
const FieldFacts& facts(SurfaceField field);
const FieldFacts& facts(EmitterField field);

/// The field with this name, if the language lets it be named.
std::optional<GeometryField> find_geometry_field(std::string_view name);
std::optional<SurfaceField> find_surface_field(std::string_view name);
std::optional<EmitterField> find_emitter_field(std::string_view name);

/// Where the vectors of a geometry are, in some graph.
struct Frame {
    ExprId l, v, n;
    ExprId x, y;  ///< the tangent frame; may be invalid when nothing needs it
    /// As a port by hand computes fields: h is normalize(l + v), which l = -v makes undefined, and
    /// cosines that no saturation holds are as they come. For comparison only.
    bool bare = false;
    /// one_minus_cos_h is computed as well: cos_h is one minus that, not a product of its own.
    bool has_complement = false;
    /// |l + v| is computed as well: v.l follows from that.
    bool has_sum = false;

    /// To be told of all fields that will be computed, before the first one is: some are made of
    /// what others need.
    void expect(GeometryField field);
};

/// The expression that computes a field from the vectors. Guarded: l = -v gives h = 0.
/// Cosines are saturated; `sin2_h`, `one_minus_*` are saturated.
ExprId expand(Graph& graph, GeometryField field, const Frame& frame);

/// The vectors that the fields of an emitter are made of, in some graph; those that a field does
/// not need may be invalid.
struct EmitterFrame {
    ExprId to_light, v, n;
};

/// The expression that computes a field that is no input: l, r, distance_squared.
ExprId expand(Graph& graph, EmitterField field, const EmitterFrame& frame);

/// True when a field needs the tangent frame.
bool needs_tangents(GeometryField field);

}  // namespace lobe::ir
