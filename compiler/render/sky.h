// The environment of a scene as light: how bright a direction is, and directions chosen by it.
#pragma once

#include "render/vector.h"
#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <vector>

namespace lobe::render {

/// Uniform on [0, 1)^2.
using Pair = std::array<float, 2>;

class Sky {
public:
    /// Nothing shines where the scene has no environment, or its pictures could not be read; then
    /// `is_dark`.
    explicit Sky(const scene::Scene& scene);

    bool is_dark() const { return texels_.empty(); }
    /// Linear RGB in candela per square meter.
    Vector3 radiance(const Vector3& direction) const;

    struct Chosen {
        Vector3 direction;
        float density = 0;  ///< per steradian
    };
    /// A direction, with a density in proportion to the luminance of the texel that it lies in.
    Chosen choose(Pair uniform) const;
    float density(const Vector3& direction) const;

private:
    std::size_t texel_of(const Vector3& direction) const;
    Vector3 world_of(const Vector3& cube) const;
    Vector3 cube_of(const Vector3& world) const;

    int size_ = 0;                 ///< texels along an edge of a face
    std::vector<Vector3> texels_;  ///< six faces, row by row
    std::vector<float> below_;     ///< share of the texels before this one; one more at the end
    std::array<Vector3, 3> rotation_{};  ///< columns
};

}  // namespace lobe::render
