#include "numeric/points.h"

#include <array>
#include <cmath>
#include <random>

namespace lobe::tests {
namespace {

using Vector = std::array<double, 3>;

/// Uniform in [0, 1): the same on every platform, unlike std::uniform_real_distribution.
double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-32; }

double spread(std::mt19937& random, double low, double high)
{
    const std::uint32_t pick = random() % 16;
    const double within = low + (high - low) * uniform(random);
    return pick == 0 ? low : pick == 1 ? high : within;
}

/// A direction at a polar angle whose cosine is z.
Vector direction(double z, double azimuth)
{
    const double s = std::sqrt((1 - z) * (1 + z));
    return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

struct Pair {
    Vector l, v;
};

Pair directions(std::mt19937& random)
{
    constexpr double turn = 6.283185307179586;
    const double azimuth = turn * uniform(random);
    Pair pair{direction(2 * uniform(random) - 1, azimuth),
              direction(2 * uniform(random) - 1, turn * uniform(random))};
    const double grazing = 1e-3 * uniform(random);
    switch (random() % 24) {
    case 0: pair.v = pair.l; break;
    case 1: pair.v = {-pair.l[0], -pair.l[1], pair.l[2]}; break;
    case 2: pair.l = direction(grazing, azimuth); break;
    case 3: pair.v = direction(grazing, azimuth); break;
    case 4: pair.l = pair.v = {0, 0, 1}; break;
    case 5: pair.v = {-pair.l[0], -pair.l[1], -pair.l[2]}; break;
    default:
        // The rest is above the horizon four times out of five.
        if (random() % 5 != 0) {
            pair.l[2] = std::abs(pair.l[2]);
            pair.v[2] = std::abs(pair.v[2]);
        }
    }
    return pair;
}

}  // namespace

Points geometry_points(std::size_t count, std::uint32_t seed)
{
    std::mt19937 random{seed};
    Points points;
    for (const char* name : {"l.x", "l.y", "l.z", "v.x", "v.y", "v.z"})
        points.emplace_back(name, std::vector<double>{});
    for (std::size_t i = 0; i < count; ++i) {
        const Pair pair = directions(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            points[axis].second.push_back(pair.l[axis]);
            points[3 + axis].second.push_back(pair.v[axis]);
        }
    }
    return points;
}

Points material_points(std::size_t count, std::uint32_t seed)
{
    Points points = geometry_points(count, seed);
    points = with(std::move(points), "roughness", 1.0 / 64, 1, seed + 1);
    points = with(std::move(points), "diffuse_color", 0, 1, seed + 2);
    return with(std::move(points), "f0", 0, 1, seed + 3);
}

Points unit_points(const std::vector<std::string>& names, std::size_t count, std::uint32_t seed)
{
    std::mt19937 random{seed};
    Points points;
    for (const std::string& name : names) {
        std::vector<double> column;
        for (std::size_t i = 0; i < count; ++i) column.push_back(spread(random, 0, 1));
        points.emplace_back(name, std::move(column));
    }
    return points;
}

Points with(Points points, const std::string& name, double low, double high, std::uint32_t seed)
{
    std::mt19937 random{seed};
    std::vector<double> column;
    for (std::size_t i = 0; i < points.front().second.size(); ++i)
        column.push_back(spread(random, low, high));
    points.emplace_back(name, std::move(column));
    return points;
}

Points with(Points points, const std::string& name, double value)
{
    points.emplace_back(name, std::vector<double>(points.front().second.size(), value));
    return points;
}

}  // namespace lobe::tests
