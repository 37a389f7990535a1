#include "analyze/residual/surface.h"

#include "analyze/residual/reach.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

using ir::Range;

constexpr double specular_scale = 0.08;
constexpr double default_ior = 1.5;

Range clamped(const Range& range, double low, double high)
{
    return {std::clamp(range.low, low, high), std::clamp(range.high, low, high)};
}

/// The reach of a value, held within [low, 1] as the format declares it.
InputFact fact_of(const scene::Scene& scene, const scene::Value& value, std::size_t components,
                  double low = 0)
{
    const Reach found = reach(scene, value);
    InputFact fact;
    for (std::size_t k = 0; k < components && k < found.in_floats.size(); ++k)
        fact.components.push_back(clamped(found.in_floats[k], low, 1));
    // The format's default: a factor of 1 where nothing is given.
    fact.components.resize(components, Range{1, 1});
    fact.is_binary = found.is_binary && low == 0;
    fact.is_default = !value.is_given;
    if (value.is_given) fact.called_by = value.pointer;
    return fact;
}

void mark_binary(InputFact& fact)
{
    fact.is_binary = std::ranges::all_of(fact.components, [](const Range& range) {
        return range.low == range.high && (range.low == 0 || range.low == 1);
    });
}

/// `dielectric_f0` over what a material gives: it grows with color and strength, and with how far
/// the index is from 1.
InputFact dielectric_of(const scene::Scene& scene, const scene::Material& material)
{
    InputFact out;
    out.is_default = true;
    const auto given = [&](const char* name) -> const scene::Value* {
        const auto found = material.extensions.find(name);
        if (found == material.extensions.end()) return nullptr;
        if (out.is_default) out.called_by = found->second.pointer;
        out.is_default = false;
        return &found->second;
    };
    double least = default_ior;
    double most = default_ior;
    if (const scene::Value* ior = given("ior")) {
        const Range n = reach(scene, *ior).components.at(0);
        const bool low_is_more = dielectric_f0(n.low, 1, 1) > dielectric_f0(n.high, 1, 1);
        least = n.low <= 1 && n.high >= 1 ? 1 : low_is_more ? n.high : n.low;
        most = low_is_more ? n.low : n.high;
    }
    std::vector<Range> color(3, Range{1, 1});
    if (const scene::Value* const value = given("specular_color")) {
        const Reach found = reach(scene, *value);
        for (std::size_t k = 0; k < color.size() && k < found.in_floats.size(); ++k)
            color[k] = {std::max(found.in_floats[k].low, 0.0),
                        std::max(found.in_floats[k].high, 0.0)};
    }
    Range strength{1, 1};
    if (const scene::Value* const value = given("specular"))
        strength = clamped(reach(scene, *value).in_floats.at(0), 0, 1);
    for (const Range& channel : color)
        out.components.push_back({dielectric_f0(least, channel.low, strength.low),
                                  dielectric_f0(most, channel.high, strength.high)});
    return out;
}

/// d (1 - m) + b m over a box: linear in each, so that its ends are at corners.
Range blended(const Range& d, const Range& b, const Range& m)
{
    const auto at = [](double x, double y, double t) { return x * (1 - t) + y * t; };
    Range out{1, 0};
    for (const double x : {d.low, d.high})
        for (const double y : {b.low, b.high})
            for (const double t : {m.low, m.high}) {
                out.low = std::min(out.low, at(x, y, t));
                out.high = std::max(out.high, at(x, y, t));
            }
    return out;
}

/// A fact that follows from several: who called for it is the first of them that is no default.
InputFact derived(std::initializer_list<const InputFact*> sources)
{
    InputFact out;
    out.is_default = true;
    for (const InputFact* source : sources) {
        out.is_default = out.is_default && source->is_default;
        if (out.called_by.empty()) out.called_by = source->called_by;
    }
    return out;
}

}  // namespace

double dielectric_f0(double ior, double specular_color, double specular)
{
    const double of_index = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
    return std::min(of_index * specular_color, 1.0) * specular;
}

std::vector<VertexColors> vertex_colors(const scene::Scene& scene)
{
    const Range one{1, 1};
    std::vector<VertexColors> out(scene.materials.size());
    std::vector<bool> is_shown(scene.materials.size());
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& mesh = scene.meshes[instance.mesh];
        VertexColors& colors = out[mesh.material];
        for (std::size_t k = 0; k < colors.rgb.size(); ++k) {
            const Range here{static_cast<double>(mesh.least_color[k]),
                             static_cast<double>(mesh.greatest_color[k])};
            colors.rgb[k] = is_shown[mesh.material] ? hull(colors.rgb[k], here) : here;
            if (here != one && colors.called_by.empty())
                colors.called_by = mesh.pointer + "/attributes/COLOR_0";
        }
        is_shown[mesh.material] = true;
    }
    return out;
}

InputFact colored(InputFact base_color, const VertexColors& colors)
{
    if (colors.called_by.empty()) return base_color;
    for (std::size_t k = 0; k < base_color.components.size(); ++k)
        base_color.components[k] =
            clamped(product_in_floats(base_color.components[k], colors.rgb[k]), 0, 1);
    mark_binary(base_color);
    if (base_color.is_default) base_color.called_by = colors.called_by;
    base_color.is_default = false;
    return base_color;
}

RawSurface raw_surface(const scene::Scene& scene, const scene::Material& material)
{
    RawSurface raw;
    raw.base_color = fact_of(scene, material.base_color, 3);
    raw.metallic = fact_of(scene, material.metallic, 1);
    raw.roughness =
        fact_of(scene, material.roughness, 1, ir::facts(ir::SurfaceField::roughness).low);
    raw.dielectric_f0 = dielectric_of(scene, material);
    const std::vector<Range>& f0 = raw.dielectric_f0.components;
    raw.exceeds_specular = std::ranges::any_of(
        f0, [&](const Range& range) { return range.high > specular_scale || range != f0.front(); });
    return raw;
}

InputFact hull(const InputFact& a, const InputFact& b)
{
    InputFact out = a;
    for (std::size_t k = 0; k < out.components.size() && k < b.components.size(); ++k)
        out.components[k] = hull(a.components[k], b.components[k]);
    out.is_default = a.is_default && b.is_default;
    if (out.called_by.empty()) out.called_by = b.called_by;
    mark_binary(out);
    return out;
}

RawSurface hull(const RawSurface& a, const RawSurface& b)
{
    return {hull(a.base_color, b.base_color), hull(a.metallic, b.metallic),
            hull(a.roughness, b.roughness), hull(a.dielectric_f0, b.dielectric_f0),
            a.exceeds_specular || b.exceeds_specular};
}

InputFact surface_field(const RawSurface& raw, ir::SurfaceField field)
{
    using Field = ir::SurfaceField;
    const Range metallic = raw.metallic.components.front();
    InputFact out;
    switch (field) {
    case Field::base_color: return raw.base_color;
    case Field::metallic: return raw.metallic;
    case Field::roughness: return raw.roughness;
    case Field::alpha: {
        out = derived({&raw.roughness});
        const Range r = raw.roughness.components.front();
        out.components = {{r.low * r.low, r.high * r.high}};
        break;
    }
    case Field::specular: {
        out = derived({&raw.dielectric_f0});
        Range all = raw.dielectric_f0.components.front();
        for (const Range& range : raw.dielectric_f0.components) all = hull(all, range);
        out.components = {clamped({all.low / specular_scale, all.high / specular_scale}, 0, 1)};
        break;
    }
    case Field::diffuse_color:
        out = derived({&raw.metallic, &raw.base_color});
        for (const Range& color : raw.base_color.components)
            out.components.push_back(blended(color, {0, 0}, metallic));
        break;
    case Field::f0:
        out = derived({&raw.metallic, &raw.dielectric_f0, &raw.base_color});
        for (std::size_t k = 0; k < raw.base_color.components.size(); ++k)
            out.components.push_back(
                blended(raw.dielectric_f0.components[k], raw.base_color.components[k], metallic));
        break;
    }
    mark_binary(out);
    return out;
}

}  // namespace lobe::analyze
