#include "render/integrate.h"

#include "analyze/random.h"
#include "analyze/residual/facts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::render {
namespace {

using analyze::Random;

/// Far enough from a surface that rounding does not put its own triangle in the way.
constexpr float lift = 0x1p-12F;

/// Of a meter: what lengths are in where lights are asked, and candela per square of it.
constexpr float centimeters = 100;

/// Unit vectors around n in the density of GGX's half vectors, D cos. Karis 2013, section on image
/// based lighting; Walter et al. 2007, equations 35 and 36.
struct HalfVectors {
    float alpha2;

    explicit HalfVectors(float alpha) : alpha2{alpha * alpha} {}

    Vector3 choose(const SurfacePoint& at, Pair uniform) const
    {
        const float cos2 = (1 - uniform[1]) / (1 + (alpha2 - 1) * uniform[1]);
        const float cosine = std::sqrt(cos2);
        const float sine = std::sqrt(std::max(0.0F, 1 - cos2));
        const float phi = 2 * std::numbers::pi_v<float> * uniform[0];
        return normalized(at.x * (sine * std::cos(phi)) + at.y * (sine * std::sin(phi)) +
                          at.n * cosine);
    }
    /// Of the direction that such an h mirrors v into.
    float density(const SurfacePoint& at, const Vector3& l) const
    {
        const Vector3 sum = l + at.v;
        const float size = length(sum);
        if (!(size > 0)) return 0;
        const Vector3 h = sum * (1 / size);
        const float cosine = dot(at.n, h);
        if (!(cosine > 0)) return 0;
        const float t = cosine * cosine * (alpha2 - 1) + 1;
        const float d = alpha2 / (std::numbers::pi_v<float> * t * t);
        return d * cosine / (4 * std::max(dot(at.v, h), 0x1p-20F));
    }
};

Vector3 result_of(const Batch& batch, std::size_t i)
{
    return {batch.result[0][i], batch.result[1][i], batch.result[2][i]};
}

Vector3 times(const Vector3& a, const Vector3& b)
{
    return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

template <std::size_t Size>
void place(std::array<std::vector<float>, Size>& columns, std::size_t first, std::size_t i,
           const Vector3& vector)
{
    for (std::size_t c = 0; c < 3; ++c) columns[first + c][i] = vector[c];
}

std::size_t alpha_column(const MaterialValues& values) { return *values.find("alpha"); }

}  // namespace

Lighting::Lighting(const scene::Scene& scene, const Geometry& geometry, const Sky& sky,
                   const Shader& shader, const RenderOptions& options)
    : scene_{scene}, geometry_{geometry}, sky_{sky}, directions_{options.directions},
      values_{scene, *shader.module}, radiance_{*shader.module, shader.radiance, values_}
{
    for (const auto& [name, function] : shader.lit)
        lit_.emplace(name, Program{*shader.module, function, values_});
}

std::vector<Vector3> Lighting::light(const std::vector<Seen>& points) const
{
    Batch batch;
    batch.size = points.size();
    batch.values.assign(values_.size(), std::vector<float>(batch.size));
    const auto reserve = [&](auto& columns) {
        for (auto& column : columns) column.resize(batch.size);
    };
    reserve(batch.frame);
    reserve(batch.l);
    reserve(batch.emitter);
    reserve(batch.result);
    std::vector<float> row(values_.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint& at = points[i].point;
        values_.at(at, row);
        for (std::size_t k = 0; k < row.size(); ++k) batch.values[k][i] = row[k];
        place(batch.frame, 0, i, at.n);
        place(batch.frame, 3, i, at.x);
        place(batch.frame, 6, i, at.y);
        place(batch.frame, 9, i, at.v);
    }
    std::vector<Vector3> sum(points.size());
    add_emission(points, sum);
    for (const scene::Light& light : scene_.lights) add_light(light, points, batch, sum);
    add_sky(points, batch, sum);
    if (scene_.lights.empty() && sky_.is_dark()) add_headlight(points, batch, sum);
    return sum;
}

void Lighting::add_emission(const std::vector<Seen>& points, std::vector<Vector3>& sum) const
{
    for (std::size_t i = 0; i < points.size(); ++i)
        sum[i] = sum[i] + emission(scene_, points[i].point);
}

void Lighting::add_headlight(const std::vector<Seen>& points, Batch& batch,
                             std::vector<Vector3>& sum) const
{
    for (std::size_t i = 0; i < points.size(); ++i) place(batch.l, 0, i, points[i].point.v);
    radiance_.run(batch);
    for (std::size_t i = 0; i < points.size(); ++i)
        sum[i] = sum[i] + result_of(batch, i) * std::numbers::pi_v<float>;
}

void Lighting::add_light(const scene::Light& light, const std::vector<Seen>& points, Batch& batch,
                         std::vector<Vector3>& sum) const
{
    const bool far = light.kind == scene::Light::Kind::directional;
    const bool is_tube = light.kind == scene::Light::Kind::tube;
    const Vector3 center = moved(light.world, {0, 0, 0});
    const Vector3 axis =
        normalized(turned(light.world, is_tube ? Vector3{1, 0, 0} : Vector3{0, 0, -1}));
    const auto number = [](double x) { return static_cast<float>(x); };
    const std::array<float, 5> shape{
        number(light.radius), number(light.length / 2), number(light.range.value_or(0)),
        number(std::cos(light.inner_cone)), number(std::cos(light.outer_cone))};
    std::vector<bool> dark(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector3 to_light = far ? -axis : center - points[i].point.position;
        place(batch.emitter, 0, i, far ? to_light : to_light * centimeters);
        place(batch.emitter, 3, i, axis);
        for (std::size_t k = 0; k < shape.size(); ++k) batch.emitter[6 + k][i] = shape[k];
        const Vector3 l = normalized(to_light);
        const float distance = far ? std::numeric_limits<float>::infinity()
                                   : std::max(0.0F, length(to_light) - number(light.radius));
        const float above = lift * (1 + length(points[i].point.position));
        dark[i] =
            dot(points[i].point.n, l) <= 0 ||
            geometry_.blocked({points[i].shadow_from + points[i].point.facet * above, l}, distance);
        // What is below the horizon of the facet alone is lit: the surface is smooth there.
    }
    lit_.at(analyze::light_name(light)).run(batch);
    const Vector3 color =
        Vector3{number(light.color[0]), number(light.color[1]), number(light.color[2])} *
        number(light.intensity);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!dark[i]) sum[i] = sum[i] + times(color, result_of(batch, i));
}

void Lighting::add_sky(const std::vector<Seen>& points, Batch& batch,
                       std::vector<Vector3>& sum) const
{
    if (sky_.is_dark()) return;
    // Half of the directions by the sky's brightness, half by the highlight, each weighed by the
    // density of both together: the balance heuristic. Veach and Guibas 1995, equation 5.
    const auto half = std::max(1, directions_ / 2);
    const std::size_t alpha = alpha_column(values_);
    std::vector<Random> random;
    for (const Seen& seen : points) random.emplace_back(seen.seed);
    std::vector<Vector3> brightness(points.size());
    for (int direction = 0; direction < 2 * half; ++direction) {
        const bool by_sky = direction < half;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SurfacePoint& at = points[i].point;
            // Strata along the first axis.
            const float stratum = static_cast<float>(direction % half);
            const Pair uniform{(stratum + static_cast<float>(random[i].unit())) /
                                   static_cast<float>(half),
                               static_cast<float>(random[i].unit())};
            const HalfVectors highlight{batch.values[alpha][i]};
            Vector3 l;
            if (by_sky) {
                l = sky_.choose(uniform).direction;
            } else {
                const Vector3 h = highlight.choose(at, uniform);
                l = normalized(h * (2 * dot(at.v, h)) - at.v);
            }
            const float density = sky_.density(l) + highlight.density(at, l);
            const bool visible =
                dot(at.n, l) > 0 && density > 0 &&
                !geometry_.blocked(
                    {points[i].shadow_from + at.facet * (lift * (1 + length(at.position))), l},
                    std::numeric_limits<float>::infinity());
            brightness[i] =
                visible ? sky_.radiance(l) * (1 / (static_cast<float>(half) * density)) : Vector3{};
            place(batch.l, 0, i, l);
        }
        radiance_.run(batch);
        for (std::size_t i = 0; i < points.size(); ++i)
            sum[i] = sum[i] + times(brightness[i], result_of(batch, i));
    }
}

}  // namespace lobe::render
