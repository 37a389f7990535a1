#include "analyze/residual/surface.h"

#include "analyze/residual/reach.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

using ir::Range;

constexpr double specular_scale = 0.08;
constexpr double default_f0 = 0.04;

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

struct Dielectric {
    std::vector<Range> f0{3, Range{default_f0, default_f0}};
    scene::Pointer called_by;
};

Dielectric dielectric_of(const scene::Scene& scene, const scene::Material& material)
{
    Dielectric out;
    const auto given = [&](const char* name) -> const scene::Value* {
        const auto found = material.extensions.find(name);
        if (found == material.extensions.end()) return nullptr;
        if (out.called_by.empty()) out.called_by = found->second.pointer;
        return &found->second;
    };
    if (const scene::Value* ior = given("ior")) {
        // Grows with an index from 1 on; 0 stands for a reflectance of 1.
        const auto at = [](double n) { return (n - 1) * (n - 1) / ((n + 1) * (n + 1)); };
        const Range n = reach(scene, *ior).components.at(0);
        const double a = at(n.low);
        const double b = at(n.high);
        const double least = n.low <= 1 && n.high >= 1 ? 0 : std::min(a, b);
        out.f0.assign(3, {least, std::max(a, b)});
    }
    if (const scene::Value* color = given("specular_color")) {
        const Reach found = reach(scene, *color);
        for (std::size_t k = 0; k < 3 && k < found.in_floats.size(); ++k)
            out.f0[k] = {out.f0[k].low * std::max(found.in_floats[k].low, 0.0),
                         out.f0[k].high * std::max(found.in_floats[k].high, 0.0)};
    }
    for (Range& range : out.f0) range = clamped(range, 0, 1);
    if (const scene::Value* strength = given("specular")) {
        const Range found = clamped(reach(scene, *strength).in_floats.at(0), 0, 1);
        for (Range& range : out.f0) range = {range.low * found.low, range.high * found.high};
    }
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

void mark_binary(InputFact& fact)
{
    fact.is_binary = std::ranges::all_of(fact.components, [](const Range& range) {
        return range.low == range.high && (range.low == 0 || range.low == 1);
    });
}

}  // namespace

RawSurface raw_surface(const scene::Scene& scene, const scene::Material& material)
{
    RawSurface raw;
    raw.base_color = fact_of(scene, material.base_color, 3);
    raw.metallic = fact_of(scene, material.metallic, 1);
    raw.roughness =
        fact_of(scene, material.roughness, 1, ir::facts(ir::SurfaceField::roughness).low);
    const Dielectric dielectric = dielectric_of(scene, material);
    raw.dielectric_f0.components = dielectric.f0;
    raw.dielectric_f0.called_by = dielectric.called_by;
    raw.dielectric_f0.is_default = dielectric.called_by.empty();
    raw.exceeds_specular = std::ranges::any_of(dielectric.f0, [&](const Range& range) {
        return range.high > specular_scale || range != dielectric.f0.front();
    });
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
