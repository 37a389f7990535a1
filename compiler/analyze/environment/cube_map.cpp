#include "analyze/environment/cube_map.h"

#include "analyze/environment/sampling.h"
#include "analyze/tasks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

/// The middle of a texel on its face, in [-1, 1]; beyond for neighbors' texels.
double middle(int texel, int size) { return (2 * texel + 1.0) / size - 1; }

/// A texel, or what lies beyond the face's edge in its place.
Radiance texel_beyond(const CubeLevel& level, int face, int row, int column)
{
    const auto inside = [&](int texel) { return 0 <= texel && texel < level.size; };
    if (inside(row) && inside(column)) return level.at(face, row, column);
    const FacePlace place =
        face_place(cube_point({face, middle(column, level.size), middle(row, level.size)}));
    return level.at(place.face, texel_at(place.v, level.size), texel_at(place.u, level.size));
}

void add(Radiance& to, const Radiance& value, double weight)
{
    for (std::size_t i = 0; i < value.size(); ++i) to[i] += weight * value[i];
}

Radiance look_up(const CubeLevel& level, const FacePlace& place)
{
    const double x = (place.u + 1) / 2 * level.size - 0.5;
    const double y = (place.v + 1) / 2 * level.size - 0.5;
    const double left = std::floor(x);
    const double top = std::floor(y);
    const double across = x - left;
    const double down = y - top;
    const int column = static_cast<int>(left);
    const int row = static_cast<int>(top);
    Radiance out{};
    add(out, texel_beyond(level, place.face, row, column), (1 - across) * (1 - down));
    add(out, texel_beyond(level, place.face, row, column + 1), across * (1 - down));
    add(out, texel_beyond(level, place.face, row + 1, column), (1 - across) * down);
    add(out, texel_beyond(level, place.face, row + 1, column + 1), across * down);
    return out;
}

/// The solid angle of the part of a face between its middle and (x, y).
double corner(double x, double y) { return std::atan2(x * y, std::sqrt(x * x + y * y + 1)); }

double solid_angle(double left, double right, double top, double bottom)
{
    return corner(right, bottom) - corner(left, bottom) - corner(right, top) + corner(left, top);
}

CubeLevel halved(const CubeLevel& fine)
{
    CubeLevel out{std::max(fine.size / 2, 1)};
    const double ratio = static_cast<double>(fine.size) / out.size;
    const auto edge = [&](double place) { return 2 * place / fine.size - 1; };
    for (int face = 0; face < cube_faces; ++face)
        for (int row = 0; row < out.size; ++row)
            for (int column = 0; column < out.size; ++column) {
                const double left = column * ratio;
                const double top = row * ratio;
                Radiance sum{};
                double whole = 0;
                for (int y = static_cast<int>(top); y < fine.size && y < top + ratio; ++y)
                    for (int x = static_cast<int>(left); x < fine.size && x < left + ratio; ++x) {
                        const double part = solid_angle(
                            edge(std::max<double>(x, left)), edge(std::min(x + 1.0, left + ratio)),
                            edge(std::max<double>(y, top)), edge(std::min(y + 1.0, top + ratio)));
                        add(sum, fine.at(face, y, x), part);
                        whole += part;
                    }
                for (double& channel : sum) channel /= whole;
                out.set(face, row, column, sum);
            }
    return out;
}

/// Linear between texels; around the picture's seam, held at its top and bottom.
Radiance look_up(const LatLong& picture, const Vector& d)
{
    const double turn = std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + 0.5;
    const double fall = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
    const double x = turn * picture.width - 0.5;
    const double y = fall * picture.height - 0.5;
    const double left = std::floor(x);
    const double top = std::floor(y);
    const auto at = [&](double row, double column) {
        const int wrapped =
            (static_cast<int>(column) % picture.width + picture.width) % picture.width;
        const int held = std::clamp(static_cast<int>(row), 0, picture.height - 1);
        const std::size_t first =
            3 * (static_cast<std::size_t>(held) * static_cast<std::size_t>(picture.width) +
                 static_cast<std::size_t>(wrapped));
        return Radiance{picture.texels[first], picture.texels[first + 1],
                        picture.texels[first + 2]};
    };
    Radiance out{};
    add(out, at(top, left), (1 - (x - left)) * (1 - (y - top)));
    add(out, at(top, left + 1), (x - left) * (1 - (y - top)));
    add(out, at(top + 1, left), (1 - (x - left)) * (y - top));
    add(out, at(top + 1, left + 1), (x - left) * (y - top));
    return out;
}

}  // namespace

FacePlace face_place(const Vector& d)
{
    const double x = std::fabs(d.x);
    const double y = std::fabs(d.y);
    const double z = std::fabs(d.z);
    if (x >= y && x >= z) {
        if (d.x >= 0) return {0, -d.z / x, -d.y / x};
        return {1, d.z / x, -d.y / x};
    }
    if (y >= z) {
        if (d.y >= 0) return {2, d.x / y, d.z / y};
        return {3, d.x / y, -d.z / y};
    }
    if (d.z >= 0) return {4, d.x / z, -d.y / z};
    return {5, -d.x / z, -d.y / z};
}

Vector cube_point(const FacePlace& place)
{
    const auto [face, u, v] = place;
    switch (face) {
    case 0: return {1, -v, -u};
    case 1: return {-1, -v, u};
    case 2: return {u, 1, v};
    case 3: return {u, -1, -v};
    case 4: return {u, -v, 1};
    default: return {-u, -v, -1};
    }
}

int texel_at(double place, int size)
{
    return std::clamp(static_cast<int>(std::floor((place + 1) / 2 * size)), 0, size - 1);
}

CubeLevel::CubeLevel(int edge)
    : size(edge), texels(std::size_t{3} * cube_faces * static_cast<std::size_t>(edge) *
                         static_cast<std::size_t>(edge))
{
}

std::size_t CubeLevel::index(int face, int row, int column) const
{
    return 3 * static_cast<std::size_t>((face * size + row) * size + column);
}

Radiance CubeLevel::at(int face, int row, int column) const
{
    const float* const texel = &texels[index(face, row, column)];
    return {texel[0], texel[1], texel[2]};
}

void CubeLevel::set(int face, int row, int column, const Radiance& value)
{
    float* const texel = &texels[index(face, row, column)];
    for (std::size_t i = 0; i < value.size(); ++i) texel[i] = static_cast<float>(value[i]);
}

Vector texel_direction(const CubeLevel& level, int face, int row, int column)
{
    return normalized(cube_point({face, middle(column, level.size), middle(row, level.size)}));
}

double texel_solid_angle(int size, int row, int column)
{
    const auto edge = [size](int texel) { return 2.0 * texel / size - 1; };
    return solid_angle(edge(column), edge(column + 1), edge(row), edge(row + 1));
}

CubeMap with_levels(CubeLevel sharpest)
{
    CubeMap out;
    out.levels.push_back(std::move(sharpest));
    while (out.levels.back().size > 1) out.levels.push_back(halved(out.levels.back()));
    return out;
}

Radiance look_up(const CubeMap& map, const Vector& direction, double level)
{
    assert(!map.levels.empty());
    const double held = std::clamp(level, 0.0, static_cast<double>(map.levels.size() - 1));
    const auto sharper = static_cast<std::size_t>(held);
    const double between = held - static_cast<double>(sharper);
    const FacePlace place = face_place(direction);
    Radiance out{};
    add(out, look_up(map.levels[sharper], place), 1 - between);
    if (between > 0) add(out, look_up(map.levels[sharper + 1], place), between);
    return out;
}

CubeLevel cube_of(const LatLong& picture, int size, unsigned jobs)
{
    // As many places per texel as the picture has texels there, within reason.
    const int across = std::clamp(picture.width / (4 * size) + 1, 2, 16);
    CubeLevel out{size};
    for_each_task(static_cast<std::size_t>(cube_faces * size), jobs, [&](std::size_t task) {
        const int face = static_cast<int>(task) / size;
        const int row = static_cast<int>(task) % size;
        const auto place = [&](int texel, int part) {
            return 2 * (texel + (part + 0.5) / across) / size - 1;
        };
        for (int column = 0; column < size; ++column) {
            Radiance sum{};
            double whole = 0;
            for (int y = 0; y < across; ++y)
                for (int x = 0; x < across; ++x) {
                    const Vector at = cube_point({face, place(column, x), place(row, y)});
                    // The solid angle of equal parts of a face's plane.
                    const double weight = std::pow(dot(at, at), -1.5);
                    add(sum, look_up(picture, normalized(at)), weight);
                    whole += weight;
                }
            for (double& channel : sum) channel /= whole;
            out.set(face, row, column, sum);
        }
    });
    return out;
}

}  // namespace lobe::analyze
