#include "render/surface.h"

#include "analyze/residual/surface.h"
#include "evaluate/tape.h"
#include "scene/color.h"

#include <algorithm>
#include <cmath>

namespace lobe::render {
namespace {

using Texel = std::array<float, 4>;

Texel texel(const scene::Pixels& pixels, int x, int y)
{
    const float* const at = &pixels.rgba[4 * (static_cast<std::size_t>(y) * pixels.width + x)];
    return {at[0], at[1], at[2], at[3]};
}

int wrapped(int i, int size, bool repeats)
{
    return repeats ? ((i % size) + size) % size : std::clamp(i, 0, size - 1);
}

/// Bilinear, decoded before it is blended. White where the picture could not be read.
Texel sample(const scene::Scene& scene, const scene::Texture& texture, const SurfacePoint& point,
             bool is_srgb)
{
    const auto& pixels = scene.images[texture.image].pixels;
    if (!pixels) return {1, 1, 1, 1};
    const auto [s, t] = point.coordinates[texture.coordinates == 1 ? 1 : 0];
    const double u = s * texture.scale[0];
    const double v = t * texture.scale[1];
    const double cosine = std::cos(texture.rotation);
    const double sine = std::sin(texture.rotation);
    const double x = (texture.offset[0] + cosine * u + sine * v) * pixels->width - 0.5;
    const double y = (texture.offset[1] - sine * u + cosine * v) * pixels->height - 0.5;
    const double left = std::floor(x);
    const double top = std::floor(y);
    Texel sum{};
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const double weight =
                (dx == 0 ? 1 - (x - left) : x - left) * (dy == 0 ? 1 - (y - top) : y - top);
            const Texel one = texel(
                *pixels, wrapped(static_cast<int>(left) + dx, pixels->width, texture.repeats_u),
                wrapped(static_cast<int>(top) + dy, pixels->height, texture.repeats_v));
            for (int c = 0; c < 4; ++c)
                sum[c] += static_cast<float>(weight) *
                          (is_srgb && c < 3 ? scene::linear_of_srgb(one[c]) : one[c]);
        }
    return sum;
}

/// Component `c` of a value at a point.
class Sampled {
public:
    Sampled(const scene::Scene& scene, const scene::Value& value, const SurfacePoint& point)
        : value_{value}
    {
        if (value.texture) texel_ = sample(scene, *value.texture, point, value.is_srgb);
    }
    double operator[](std::size_t c) const
    {
        const double factor = (value_.low[c] + value_.high[c]) / 2;
        const double of_texture = value_.texture ? texel_[value_.channels[c]] : 1;
        return factor * of_texture + (c < value_.offset.size() ? value_.offset[c] : 0);
    }

private:
    const scene::Value& value_;
    Texel texel_{1, 1, 1, 1};
};

template <class T>
T blend(const Hit& hit, const T& a, const T& b, const T& c)
{
    T out{};
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = a[i] * (1 - hit.u - hit.v) + b[i] * hit.u + c[i] * hit.v;
    return out;
}

std::array<std::uint32_t, 3> corners_of(const scene::Mesh& mesh, const Hit& hit)
{
    const std::uint32_t* const corner = &mesh.triangles[3 * hit.triangle];
    return {corner[0], corner[1], corner[2]};
}

void apply_normal_map(const scene::Scene& scene, SurfacePoint& point)
{
    const scene::Material& material = scene.materials[point.material];
    if (!material.normal_map || !scene.images[material.normal_map->image].pixels) return;
    const Texel stored = sample(scene, *material.normal_map, point, false);
    const auto scale = static_cast<float>(material.normal_scale);
    point.n =
        normalized(point.x * ((2 * stored[0] - 1) * scale) +
                       point.y * ((2 * stored[1] - 1) * scale) + point.n * (2 * stored[2] - 1),
                   point.n);
}

/// x across n again, after n was turned.
void square_up(SurfacePoint& point, float side)
{
    const Vector3 flat = point.x - point.n * dot(point.n, point.x);
    point.x = length(flat) > 0 ? normalized(flat) : across(point.n).x;
    point.y = cross(point.n, point.x) * side;
}

}  // namespace

SurfacePoint surface_point(const scene::Scene& scene, const Geometry& geometry, const Ray& ray,
                           const Hit& hit)
{
    const scene::Instance& instance = scene.instances[hit.instance];
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    const auto [a, b, c] = corners_of(mesh, hit);
    SurfacePoint point;
    point.material = mesh.material;
    point.v = -ray.direction;
    point.position = ray.origin + ray.direction * hit.distance;
    const Vector3 first = geometry.corner(hit, 0);
    point.facet = normalized(
        cross(geometry.corner(hit, 1) - first, geometry.corner(hit, 2) - first), point.v);
    point.n =
        mesh.normals.empty()
            ? point.facet
            : normalized(turned_normal(instance.world, blend(hit, mesh.normals[a], mesh.normals[b],
                                                             mesh.normals[c])),
                         point.facet);
    if (dot(point.facet, point.v) < 0) {
        point.facet = -point.facet;
        if (!mesh.normals.empty()) point.n = -point.n;
    }
    if (mesh.normals.empty()) point.n = point.facet;
    for (std::size_t set = 0; set < 2; ++set)
        if (const auto& all = mesh.coordinates[set]; !all.empty())
            point.coordinates[set] = blend(hit, all[a], all[b], all[c]);
    if (!mesh.colors.empty())
        point.color = blend(hit, mesh.colors[a], mesh.colors[b], mesh.colors[c]);
    float side = 1;
    if (!mesh.tangents.empty()) {
        const auto tangent = blend(hit, mesh.tangents[a], mesh.tangents[b], mesh.tangents[c]);
        point.x = turned(instance.world, {tangent[0], tangent[1], tangent[2]});
        side = tangent[3] < 0 ? -1.0F : 1.0F;
    }
    square_up(point, side);
    apply_normal_map(scene, point);
    square_up(point, side);
    return point;
}

Vector3 shadow_origin(const scene::Scene& scene, const Geometry& geometry, const Hit& hit,
                      const SurfacePoint& point)
{
    const scene::Instance& instance = scene.instances[hit.instance];
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.normals.empty()) return point.position;
    const auto corners = corners_of(mesh, hit);
    std::array<Vector3, 3> on_tangent_plane;
    for (int i = 0; i < 3; ++i) {
        const Vector3 corner = geometry.corner(hit, i);
        Vector3 n = normalized(turned_normal(instance.world, mesh.normals[corners[i]]));
        if (dot(n, point.facet) < 0) n = -n;
        const float above = std::min(0.0F, dot(point.position - corner, n));
        on_tangent_plane[i] = point.position - n * above;
    }
    return blend(hit, on_tangent_plane[0], on_tangent_plane[1], on_tangent_plane[2]);
}

Vector3 emission(const scene::Scene& scene, const SurfacePoint& point)
{
    const scene::Material& material = scene.materials[point.material];
    const auto rgb = [](const Sampled& sampled) {
        return Vector3{static_cast<float>(sampled[0]), static_cast<float>(sampled[1]),
                       static_cast<float>(sampled[2])};
    };
    if (material.is_unlit) {
        const Vector3 color = rgb({scene, material.base_color, point});
        return {color[0] * point.color[0], color[1] * point.color[1], color[2] * point.color[2]};
    }
    if (material.emissive.low.size() != 3) return {};
    return rgb({scene, material.emissive, point});
}

bool is_cut_out(const scene::Scene& scene, const SurfacePoint& point)
{
    const scene::Material& material = scene.materials[point.material];
    if (material.alpha != scene::Material::Alpha::mask) return false;
    return Sampled(scene, material.base_color, point)[3] * point.color[3] < material.alpha_cutoff;
}

// ---- values

namespace {

enum Place : std::size_t {
    base_color = 0,
    metallic = 3,
    specular = 4,
    roughness = 5,
    alpha = 6,
    diffuse_color = 7,
    f0 = 10,
    surface_size = 13
};

}  // namespace

MaterialValues::MaterialValues(const scene::Scene& scene, const ir::Module& module)
    : scene_{scene}, size_{surface_size}
{
    using ir::SurfaceField;
    const std::pair<SurfaceField, std::size_t> fields[]{
        {SurfaceField::base_color, base_color},
        {SurfaceField::metallic, metallic},
        {SurfaceField::specular, specular},
        {SurfaceField::roughness, roughness},
        {SurfaceField::alpha, alpha},
        {SurfaceField::diffuse_color, diffuse_color},
        {SurfaceField::f0, f0}};
    const auto name = [this](std::string_view known, ir::Type type, ir::Quantity quantity,
                             std::size_t first) {
        for (int c = 0; c < ir::components(type); ++c)
            columns_.emplace(std::string{known} + evaluate::component_suffix(type, quantity, c),
                             first + c);
    };
    for (const auto& [field, first] : fields) {
        const ir::FieldFacts& known = ir::facts(field);
        name(known.name, known.type,
             known.type == ir::Type::scalar ? ir::Quantity::number : ir::Quantity::color, first);
    }
    for (const ir::Parameter& parameter : module.parameters) {
        name(parameter.name, parameter.type, parameter.quantity, size_);
        parameters_.push_back({parameter.name, size_, parameter.range, parameter.default_value});
        size_ += static_cast<std::size_t>(ir::components(parameter.type));
    }
    for (const scene::Material& material : scene.materials) {
        const auto in = [](const std::map<std::string, scene::Value>& values,
                           const std::string& wanted) -> const scene::Value* {
            const auto found = values.find(wanted);
            return found == values.end() ? nullptr : &found->second;
        };
        Given given{in(material.extensions, "ior"),
                    in(material.extensions, "specular"),
                    in(material.extensions, "specular_color"),
                    {}};
        for (const Parameter& parameter : parameters_) {
            const scene::Value* const own = in(material.parameters, parameter.name);
            given.parameters.push_back(own != nullptr ? own
                                                      : in(material.extensions, parameter.name));
        }
        given_.push_back(std::move(given));
    }
}

std::optional<std::size_t> MaterialValues::find(std::string_view column) const
{
    const auto found = columns_.find(column);
    if (found == columns_.end()) return std::nullopt;
    return found->second;
}

/// KHR_materials_ior and KHR_materials_specular.
std::array<double, 3> MaterialValues::dielectric_f0(const SurfacePoint& point) const
{
    const Given& given = given_[point.material];
    const auto sampled = [&](const scene::Value* value, std::size_t c, double otherwise) {
        return value == nullptr ? otherwise : Sampled(scene_, *value, point)[c];
    };
    const double ior = sampled(given.ior, 0, 1.5);
    const double strength = sampled(given.specular, 0, 1);
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = analyze::dielectric_f0(ior, sampled(given.specular_color, c, 1), strength);
    return out;
}

void MaterialValues::at(const SurfacePoint& point, std::span<float> out) const
{
    const scene::Material& material = scene_.materials[point.material];
    const auto number = [](double x) { return static_cast<float>(x); };
    const Sampled color{scene_, material.base_color, point};
    const double metal = std::clamp(Sampled(scene_, material.metallic, point)[0], 0.0, 1.0);
    const ir::FieldFacts& limits = ir::facts(ir::SurfaceField::roughness);
    const double rough =
        std::clamp(Sampled(scene_, material.roughness, point)[0], limits.low, limits.high);
    const auto dielectric = dielectric_f0(point);
    for (std::size_t c = 0; c < 3; ++c) {
        const double albedo = std::clamp(color[c] * point.color[c], 0.0, 1.0);
        out[base_color + c] = number(albedo);
        out[diffuse_color + c] = number(albedo * (1 - metal));
        out[f0 + c] = number(dielectric[c] * (1 - metal) + albedo * metal);
    }
    out[metallic] = number(metal);
    out[specular] =
        number(std::min(*std::max_element(dielectric.begin(), dielectric.end()) / 0.08, 1.0));
    out[roughness] = number(rough);
    out[alpha] = number(rough * rough);
    const Given& given = given_[point.material];
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const Parameter& parameter = parameters_[i];
        const scene::Value* const value = given.parameters[i];
        for (std::size_t c = 0; c < parameter.otherwise.size(); ++c)
            out[parameter.first + c] = number(parameter.otherwise[c]);
        if (value == nullptr) continue;
        const Sampled sampled{scene_, *value, point};
        for (std::size_t c = 0; c < parameter.otherwise.size(); ++c) {
            // One number stands for a gray.
            const double x = sampled[value->low.size() == 1 ? 0 : c];
            out[parameter.first + c] =
                number(std::clamp(x, parameter.range.low, parameter.range.high));
        }
    }
}

}  // namespace lobe::render
