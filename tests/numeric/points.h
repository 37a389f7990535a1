// Points to try a promise at: random ones from a fixed seed, with the hard places among them.
#pragma once

#include "numeric/library.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe::tests {

/// Unit vectors l.x .. v.z over the whole sphere, the normal being z. A quarter of the points is
/// special: l = v, mirrored, grazing, along the normal, opposite.
Points geometry_points(std::size_t count, std::uint32_t seed);

/// `geometry_points` with roughness, diffuse_color and f0; an eighth of them at the ends of their
/// ranges.
Points material_points(std::size_t count, std::uint32_t seed);

/// Independent columns in [0, 1]; an eighth of the values is 0 or 1.
Points unit_points(const std::vector<std::string>& names, std::size_t count, std::uint32_t seed);

/// The same points with one more column.
Points with(Points points, const std::string& name, double low, double high, std::uint32_t seed);
/// The same points with one more column of one value.
Points with(Points points, const std::string& name, double value);

}  // namespace lobe::tests
