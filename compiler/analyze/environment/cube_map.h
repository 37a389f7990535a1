// A cube map: radiance from every direction, linear RGB, with levels that get coarser.
//
// Faces, their axes and the order of texels are those of glTF, OpenGL, Vulkan and Direct3D: +x -x
// +y -y +z -z, rows from the top. [VulkanSpec] "Cube Map Face Selection"
//
// These axes are left-handed if the faces are pictures as seen from the middle: whoever shows such
// pictures in a right-handed world turns an axis around (render/sky.cpp).
#pragma once

#include "analyze/directions.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lobe::analyze {

/// Linear RGB.
using Radiance = std::array<double, 3>;

struct CubeLevel {
    int size = 0;               ///< texels along an edge of a face
    std::vector<float> texels;  ///< six faces, row by row, three numbers each

    CubeLevel() = default;
    explicit CubeLevel(int edge);

    std::size_t index(int face, int row, int column) const;
    Radiance at(int face, int row, int column) const;
    void set(int face, int row, int column, const Radiance& value);
};

/// Levels from the sharpest; a lookup needs one at least.
struct CubeMap {
    std::vector<CubeLevel> levels;
};

inline constexpr int cube_faces = 6;

/// A point of a face: u to the right and v down, both in [-1, 1].
struct FacePlace {
    int face = 0;
    double u = 0;
    double v = 0;
};

/// Where a direction, which need not have unit length, meets the cube.
FacePlace face_place(const Vector& direction);

/// The point itself, of the cube that reaches from -1 to 1. No unit vector.
Vector cube_point(const FacePlace& place);

/// The row or column of a texel, of `size`, that a v or u lies in.
int texel_at(double place, int size);

/// Where the middle of a texel lies: a unit vector.
Vector texel_direction(const CubeLevel& level, int face, int row, int column);

/// What a texel covers, in steradians; all of a level's add to 4 pi.
double texel_solid_angle(int size, int row, int column);

/// The level with coarser ones behind it, each half the size (rounded down) of the one before and
/// its mean by solid angle, down to one texel per face. Their means over the sphere are equal.
CubeMap with_levels(CubeLevel sharpest);

/// Radiance along a direction, which need not have unit length: linear between texels, across
/// edges too, and between levels. `level` is held in [0, levels - 1].
Radiance look_up(const CubeMap& map, const Vector& direction, double level);

/// A picture of all directions, as they are commonly kept: rows from the top (+y) to the bottom,
/// columns around y, with -z in the middle and +x at three quarters. Linear RGB, row by row.
struct LatLong {
    int width = 0;
    int height = 0;
    std::span<const float> texels;
};

/// The cube map of it; every texel is the mean of `look_up`s that its solid angle holds.
CubeLevel cube_of(const LatLong& picture, int size, unsigned jobs);

}  // namespace lobe::analyze
