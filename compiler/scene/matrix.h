// Affine maps, column-major as glTF has them.
#pragma once

#include "scene/scene.h"

#include <array>
#include <optional>

namespace lobe::scene {

constexpr Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// `first` is applied last.
Matrix multiply(const Matrix& first, const Matrix& second);
/// Scaled, then turned by a unit quaternion (x, y, z, w), then moved.
Matrix compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
               const std::array<double, 3>& scale);
/// The one factor by which a map scales all lengths, to 1e-9 of it; none where it distorts.
std::optional<double> uniform_scale(const Matrix& map);
/// Sum over the triangles of a mesh of their areas after `world`.
double area_of(const Mesh& mesh, const Matrix& world);

}  // namespace lobe::scene
