#include "analyze/corners/directions.h"

#include <array>
#include <cmath>
#include <span>

namespace lobe::analyze {
namespace {

/// A unit vector's part along the normal, and the rest.
struct Elevation {
    double sine = 0;
    double cosine = 0;
};

Elevation near_normal(double sine) { return {sine, std::sqrt(1 - sine * sine)}; }
Elevation near_horizon(double cosine) { return {std::sqrt(1 - cosine * cosine), cosine}; }

std::vector<Elevation> all_elevations()
{
    std::vector<Elevation> out{{0, 1}};
    // Sines whose squares are subnormal, vanish beside 1, or are a narrow highlight's.
    for (const double sine : {0x1p-75, 0x1p-64, 0x1p-24, 1e-4, 0x1p-12})
        out.push_back(near_normal(sine));
    out.push_back({std::sqrt(0.5), std::sqrt(0.5)});
    // Cosines whose fourth power, square or self is at 2^-64 or becomes subnormal; both neighbors
    // of 2^-64; the horizon and the least float above it.
    for (const double cosine : {1e-4, 0x1p-16, 0x1p-24, 0x1p-32, 0x1.000002p-64, 0x1p-64,
                                0x1.fffffep-65, 1e-38, 0x1p-126, 0x1p-149, 0.0})
        out.push_back(near_horizon(cosine));
    for (const double cosine : {-0x1p-149, -0x1p-126, -0x1p-64, -0x1p-24, -1e-4})
        out.push_back(near_horizon(cosine));
    out.push_back({std::sqrt(0.5), -std::sqrt(0.5)});
    out.push_back({0, -1});
    return out;
}

std::vector<Elevation> few_elevations()
{
    return {{0, 1},
            near_normal(1e-4),
            {0.8, 0.6},
            near_horizon(1e-4),
            near_horizon(0x1p-64),
            near_horizon(0x1p-149),
            near_horizon(0),
            near_horizon(-0x1p-24),
            {0.6, -0.8}};
}

std::vector<Elevation> core_elevations()
{
    return {{0, 1}, {0.8, 0.6}, near_horizon(1e-4), near_horizon(0), {0.6, -0.8}};
}

/// Around the normal; exact, but for 45 degrees.
struct Azimuth {
    double x = 1;
    double y = 0;
};
struct Azimuths {
    Azimuth l, v;
};

/// In one half-plane, at right angles, in opposite ones, in general; and with the light off the
/// tangent frame's first axis.
constexpr std::array all_azimuths{Azimuths{{1, 0}, {1, 0}},    Azimuths{{1, 0}, {0, 1}},
                                  Azimuths{{1, 0}, {-1, 0}},   Azimuths{{1, 0}, {.8, .6}},
                                  Azimuths{{0, 1}, {0, -1}},   Azimuths{{.6, .8}, {-.6, -.8}},
                                  Azimuths{{.6, .8}, {.6, .8}}};
constexpr std::size_t few_azimuths = 4;

/// Axes, where mirror images are exact in floats, and two normals of general position.
const std::array<Basis, 5>& frames()
{
    static const std::array<Basis, 5> all{
        Basis{}, Basis{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, Basis{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        Basis{{2. / 3, -2. / 3, 1. / 3}, {2. / 3, 1. / 3, -2. / 3}, {1. / 3, 2. / 3, 2. / 3}},
        Basis{{.8, -.6, 0}, {.48, .64, -.6}, {.36, .48, .8}}};
    return all;
}

Vector direction(const Basis& basis, const Elevation& elevation, const Azimuth& azimuth)
{
    return basis(elevation.sine * azimuth.x, elevation.sine * azimuth.y, elevation.cosine);
}

void add_pairs(const Basis& basis, std::span<const Elevation> elevations,
               std::span<const Azimuths> azimuths, std::vector<Directional>& out)
{
    for (const Elevation& l : elevations)
        for (const Elevation& v : elevations)
            for (std::size_t i = 0; i < azimuths.size(); ++i) {
                // Along the normal there is no azimuth.
                if (i > 0 && l.sine == 0 && v.sine == 0) continue;
                out.push_back({basis, direction(basis, l, azimuths[i].l),
                               direction(basis, v, azimuths[i].v)});
            }
}

Vector off(const Vector& from, double distance, const Vector& towards)
{
    const Vector moved{from.x + distance * towards.x, from.y + distance * towards.y,
                       from.z + distance * towards.z};
    const double length = std::sqrt(moved.x * moved.x + moved.y * moved.y + moved.z * moved.z);
    return {moved.x / length, moved.y / length, moved.z / length};
}

/// v at, and some distance from, l, its opposite and its mirror image.
void add_relations(std::span<const Elevation> elevations, std::vector<Directional>& out)
{
    const Basis axes;
    constexpr std::array distances{0.0, 0x1p-40, 0x1p-24, 0x1p-13, 1e-4, 0x1p-6};
    constexpr std::array sides{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{.48, .64, -.6}};
    for (const Elevation& elevation : elevations) {
        const Vector l = direction(axes, elevation, {.8, .6});
        const std::array partners{l, Vector{-l.x, -l.y, -l.z}, Vector{-l.x, -l.y, l.z}};
        for (const Vector& partner : partners)
            for (const double distance : distances)
                for (const Vector& side : sides)
                    out.push_back({axes, l, off(partner, distance, side)});
    }
}

}  // namespace

std::vector<Directional> corner_directions()
{
    std::vector<Directional> out;
    add_pairs(frames().front(), all_elevations(), all_azimuths, out);
    const std::span few = std::span{all_azimuths}.first(few_azimuths);
    for (const Basis& basis : std::span{frames()}.subspan(1))
        add_pairs(basis, few_elevations(), few, out);
    add_relations(few_elevations(), out);
    return out;
}

std::vector<Directional> core_directions()
{
    std::vector<Directional> out;
    add_pairs(frames().front(), core_elevations(), std::span{all_azimuths}.first(3), out);
    return out;
}

}  // namespace lobe::analyze
