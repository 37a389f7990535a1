#include "render/sky.h"

#include "scene/color.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace lobe::render {
namespace {

using analyze::cube_faces;
using analyze::CubeLevel;
using analyze::FacePlace;

/// RGBD: a color over its alpha. An alpha of 0, which means nothing, counts as the least of 8 bits.
Vector3 decoded(const scene::Pixels& pixels, std::size_t at)
{
    const float* texel = &pixels.rgba[4 * at];
    const float scale = 1 / std::max(texel[3], 1.0F / 255);
    return Vector3{scene::linear_of_srgb(texel[0]), scene::linear_of_srgb(texel[1]),
                   scene::linear_of_srgb(texel[2])} *
           scale;
}

/// A mip, unless it lacks a picture.
std::optional<CubeLevel> mip_of(const scene::Scene& scene, const std::array<std::size_t, 6>& faces)
{
    for (const std::size_t face : faces) {
        const auto& pixels = scene.images[face].pixels;
        if (!pixels || pixels->width != pixels->height ||
            pixels->width != scene.images[faces[0]].pixels->width)
            return std::nullopt;
    }
    CubeLevel out{scene.images[faces[0]].pixels->width};
    const float intensity = static_cast<float>(scene.environment->intensity);
    const std::size_t count = out.texels.size() / 3 / cube_faces;
    auto to = out.texels.begin();
    for (const std::size_t face : faces)
        for (std::size_t i = 0; i < count; ++i)
            to = std::ranges::copy(decoded(*scene.images[face].pixels, i) * intensity, to).out;
    return out;
}

CubeLevel sharpest(const scene::Scene& scene)
{
    if (!scene.environment || scene.environment->specular.empty()) return {};
    return mip_of(scene, scene.environment->specular.front()).value_or(CubeLevel{});
}

struct TexelPlace {
    int face, row, column;
};

TexelPlace texel_place(std::size_t texel, int size)
{
    const auto edge = static_cast<std::size_t>(size);
    return {static_cast<int>(texel / (edge * edge)), static_cast<int>(texel / edge % edge),
            static_cast<int>(texel % edge)};
}

}  // namespace

analyze::CubeMap environment_map(const scene::Scene& scene)
{
    analyze::CubeMap out;
    if (!scene.environment) return out;
    for (const auto& faces : scene.environment->specular) {
        auto mip = mip_of(scene, faces);
        if (!mip) break;
        out.levels.push_back(std::move(*mip));
    }
    return out;
}

Sky::Sky(const scene::Scene& scene) : texels_{sharpest(scene)}
{
    double total = 0;
    std::vector<double> sums{0};
    for (std::size_t i = 0; i < texels_.texels.size() / 3; ++i) {
        const TexelPlace at = texel_place(i, texels_.size);
        total += scene::luminance(color_of(i)) *
                 analyze::texel_solid_angle(texels_.size, at.row, at.column);
        sums.push_back(total);
    }
    if (!(total > 0)) return;
    for (const double sum : sums) below_.push_back(static_cast<float>(sum / total));

    const auto [x, y, z, w] = scene.environment->rotation;
    const auto column = [](double a, double b, double c) {
        return Vector3{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
    };
    rotation_ = {column(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
                 column(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
                 column(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))};
}

Vector3 Sky::world_of(const analyze::Vector& cube) const
{
    return rotation_[0] * static_cast<float>(cube.x) + rotation_[1] * static_cast<float>(cube.y) +
           rotation_[2] * static_cast<float>(-cube.z);
}

FacePlace Sky::place_of(const Vector3& world) const
{
    return analyze::face_place(
        {dot(rotation_[0], world), dot(rotation_[1], world), -dot(rotation_[2], world)});
}

std::size_t Sky::texel_of(const FacePlace& place) const
{
    return texels_.index(place.face, analyze::texel_at(place.v, texels_.size),
                         analyze::texel_at(place.u, texels_.size)) /
           3;
}

Vector3 Sky::color_of(std::size_t texel) const
{
    const float* const rgb = &texels_.texels[3 * texel];
    return {rgb[0], rgb[1], rgb[2]};
}

Vector3 Sky::radiance(const Vector3& direction) const
{
    if (is_dark()) return {};
    return color_of(texel_of(place_of(direction)));
}

float Sky::density(const Vector3& direction) const
{
    if (is_dark()) return 0;
    const FacePlace place = place_of(direction);
    const std::size_t texel = texel_of(place);
    // Uniform over the texel's square of the cube; a point of it that is r away from the middle
    // shows 1 / r^3 of its area.
    const double r2 = 1 + place.u * place.u + place.v * place.v;
    const double squares = texels_.size * texels_.size / 4.0;
    return (below_[texel + 1] - below_[texel]) * static_cast<float>(squares * r2 * std::sqrt(r2));
}

Sky::Chosen Sky::choose(Pair uniform) const
{
    const auto after = std::ranges::upper_bound(below_, uniform[0]);
    const std::size_t texel = std::clamp<std::ptrdiff_t>(std::distance(below_.begin(), after) - 1,
                                                         0, std::ssize(below_) - 2);
    const float share = below_[texel + 1] - below_[texel];
    // What is left of the number that chose the texel is uniform again.
    const float left = share > 0 ? (uniform[0] - below_[texel]) / share : 0.5F;
    const TexelPlace at = texel_place(texel, texels_.size);
    const double edge = texels_.size;
    const double column = at.column + static_cast<double>(std::clamp(left, 0.0F, 1.0F));
    const double row = at.row + static_cast<double>(uniform[1]);
    const double u = column / edge * 2 - 1;
    const double v = row / edge * 2 - 1;
    const Vector3 direction = normalized(world_of(analyze::cube_point({at.face, u, v})));
    return {direction, density(direction)};
}

}  // namespace lobe::render
