// Light at points of a surface: a batch of them under every light and under the sky.
#pragma once

#include "render/geometry.h"
#include "render/program.h"
#include "render/render.h"
#include "render/sky.h"

#include <cstdint>
#include <vector>

namespace lobe::render {

/// A point to be lit, and the pixel that it is seen in.
struct Seen {
    SurfacePoint point;
    Vector3 shadow_from{};
    std::size_t pixel = 0;
    std::uint64_t seed = 0;  ///< its own random numbers
};

/// A shader, ready to run.
class Lighting {
public:
    Lighting(const scene::Scene& scene, const Geometry& geometry, const Sky& sky,
             const Shader& shader, const RenderOptions& options);

    /// Radiance towards the eye, one per point.
    std::vector<Vector3> light(const std::vector<Seen>& points) const;

private:
    void add_light(const scene::Light& light, const std::vector<Seen>& points, Batch& batch,
                   std::vector<Vector3>& sum) const;
    void add_sky(const std::vector<Seen>& points, Batch& batch, std::vector<Vector3>& sum) const;
    void add_headlight(const std::vector<Seen>& points, Batch& batch,
                       std::vector<Vector3>& sum) const;
    void add_emission(const std::vector<Seen>& points, std::vector<Vector3>& sum) const;

    const scene::Scene& scene_;
    const Geometry& geometry_;
    const Sky& sky_;
    int directions_;
    MaterialValues values_;
    Program radiance_;
    std::map<std::string, Program> lit_;
};

}  // namespace lobe::render
