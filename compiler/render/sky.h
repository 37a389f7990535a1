// The environment of a scene as light: how bright a direction is, and directions chosen by it.
//
// Its faces are pictures as seen from the middle, so the cube's axes (see
// analyze/environment/cube_map.h) are the world's with z turned around, and then turned by the
// environment's rotation.
#pragma once

#include "analyze/environment/cube_map.h"
#include "render/vector.h"
#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <vector>

namespace lobe::render {

/// Uniform on [0, 1)^2.
using Pair = std::array<float, 2>;

/// The mips of a scene's environment, times its intensity, up to the first with a picture that
/// could not be read.
analyze::CubeMap environment_map(const scene::Scene& scene);

class Sky {
public:
    /// Nothing shines where the scene has no environment, or its pictures could not be read; then
    /// `is_dark`.
    explicit Sky(const scene::Scene& scene);

    bool is_dark() const { return below_.empty(); }
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
    std::size_t texel_of(const analyze::FacePlace& place) const;
    Vector3 color_of(std::size_t texel) const;
    Vector3 world_of(const analyze::Vector& cube) const;
    analyze::FacePlace place_of(const Vector3& world) const;

    analyze::CubeLevel texels_;
    std::vector<float> below_;  ///< share of the texels before this one; one more at the end
    std::array<Vector3, 3> rotation_{};  ///< columns
};

}  // namespace lobe::render
