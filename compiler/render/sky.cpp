#include "render/sky.h"

#include <algorithm>
#include <iterator>

namespace lobe::render {
namespace {

/// The extension stores a color divided by its greatest channel's excess: RGBD, decoded from sRGB.
Vector3 decoded(const scene::Pixels& pixels, std::size_t at)
{
    const auto linear = [](float x) {
        return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
    };
    const float* texel = &pixels.rgba[4 * at];
    const float scale = 1 / std::max(texel[3], 1.0F / 255);
    return Vector3{linear(texel[0]), linear(texel[1]), linear(texel[2])} * scale;
}

float luminance(const Vector3& c) { return 0.2126F * c[0] + 0.7152F * c[1] + 0.0722F * c[2]; }

struct OnCube {
    int face = 0;
    float s = 0, t = 0;  ///< in [-1, 1], as a cube map's rows and columns run
    float major = 1;     ///< the largest component's size
};

/// Faces +x -x +y -y +z -z, seen from inside, as OpenGL numbers and orients them (OpenGL 4.6 core
/// specification, table 8.19).
OnCube on_cube(const Vector3& d)
{
    const float x = std::abs(d[0]);
    const float y = std::abs(d[1]);
    const float z = std::abs(d[2]);
    if (x >= y && x >= z)
        return d[0] > 0 ? OnCube{0, -d[2] / x, -d[1] / x, x} : OnCube{1, d[2] / x, -d[1] / x, x};
    if (y >= z)
        return d[1] > 0 ? OnCube{2, d[0] / y, d[2] / y, y} : OnCube{3, d[0] / y, -d[2] / y, y};
    return d[2] > 0 ? OnCube{4, d[0] / z, -d[1] / z, z} : OnCube{5, -d[0] / z, -d[1] / z, z};
}

Vector3 from_cube(int face, float s, float t)
{
    switch (face) {
    case 0: return {1, -t, -s};
    case 1: return {-1, -t, s};
    case 2: return {s, 1, t};
    case 3: return {s, -1, -t};
    case 4: return {s, -t, 1};
    default: return {-s, -t, -1};
    }
}

}  // namespace

Sky::Sky(const scene::Scene& scene)
{
    if (!scene.environment || scene.environment->specular.empty()) return;
    const scene::Environment& environment = *scene.environment;
    const auto& faces = environment.specular.front();
    for (const std::size_t face : faces) {
        const auto& pixels = scene.images[face].pixels;
        if (!pixels || pixels->width != pixels->height ||
            pixels->width != scene.images[faces[0]].pixels->width)
            return;
    }
    size_ = scene.images[faces[0]].pixels->width;
    const auto count = static_cast<std::size_t>(size_) * size_;
    const float edge = static_cast<float>(size_);
    const float intensity = static_cast<float>(environment.intensity);
    for (const std::size_t face : faces)
        for (std::size_t i = 0; i < count; ++i)
            texels_.push_back(decoded(*scene.images[face].pixels, i) * intensity);

    double total = 0;
    std::vector<double> sums{0};
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        const std::size_t in_face = i % count;
        const float s = (2 * static_cast<float>(in_face % size_) + 1) / edge - 1;
        const float t = (2 * static_cast<float>(in_face / size_) + 1) / edge - 1;
        const float cube = 1 + s * s + t * t;  // a texel covers (2 / size)^2 / cube^(3/2)
        total += luminance(texels_[i]) / (cube * std::sqrt(cube));
        sums.push_back(total);
    }
    if (!(total > 0)) {
        texels_.clear();
        return;
    }
    for (const double sum : sums) below_.push_back(static_cast<float>(sum / total));

    const auto [x, y, z, w] = environment.rotation;
    const auto column = [](double a, double b, double c) {
        return Vector3{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
    };
    rotation_ = {column(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
                 column(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
                 column(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))};
}

Vector3 Sky::world_of(const Vector3& cube) const
{
    return rotation_[0] * cube[0] + rotation_[1] * cube[1] + rotation_[2] * cube[2];
}

Vector3 Sky::cube_of(const Vector3& world) const
{
    return {dot(rotation_[0], world), dot(rotation_[1], world), dot(rotation_[2], world)};
}

std::size_t Sky::texel_of(const Vector3& cube) const
{
    const OnCube at = on_cube(cube);
    const auto place = [this](float x) {
        return std::clamp(static_cast<int>((x + 1) / 2 * static_cast<float>(size_)), 0, size_ - 1);
    };
    return (static_cast<std::size_t>(at.face) * size_ + place(at.t)) * size_ + place(at.s);
}

Vector3 Sky::radiance(const Vector3& direction) const
{
    if (is_dark()) return {};
    return texels_[texel_of(cube_of(direction))];
}

float Sky::density(const Vector3& direction) const
{
    if (is_dark()) return 0;
    const Vector3 cube = cube_of(direction);
    const std::size_t texel = texel_of(cube);
    const float major = on_cube(normalized(cube)).major;
    // Uniform over the texel's square, whose element of solid angle is major^3.
    const float share = below_[texel + 1] - below_[texel];
    const float edge = static_cast<float>(size_);
    const float texels = edge * edge / 4;
    return share * texels / (major * major * major);
}

Sky::Chosen Sky::choose(Pair uniform) const
{
    const auto after = std::ranges::upper_bound(below_, uniform[0]);
    const std::size_t texel = std::clamp<std::ptrdiff_t>(std::distance(below_.begin(), after) - 1,
                                                         0, std::ssize(texels_) - 1);
    const float share = below_[texel + 1] - below_[texel];
    // What is left of the number that chose the texel is uniform again.
    const float left = share > 0 ? (uniform[0] - below_[texel]) / share : 0.5F;
    const float edge = static_cast<float>(size_);
    const std::size_t in_face = texel % (static_cast<std::size_t>(size_) * size_);
    const auto face = static_cast<int>(texel / (static_cast<std::size_t>(size_) * size_));
    const float s =
        2 * (static_cast<float>(in_face % size_) + std::clamp(left, 0.0F, 1.0F)) / edge - 1;
    const float t = 2 * (static_cast<float>(in_face / size_) + uniform[1]) / edge - 1;
    const Vector3 direction = normalized(world_of(from_cube(face, s, t)));
    return {direction, density(direction)};
}

}  // namespace lobe::render
