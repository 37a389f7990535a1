// What a ray sees of a surface: where it is, how it is turned, and what its material gives there.
#pragma once

#include "ir/module.h"
#include "render/geometry.h"
#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace lobe::render {

struct SurfacePoint {
    Vector3 position{};
    Vector3 facet{};        ///< the triangle's own normal, towards the eye
    Vector3 n{}, x{}, y{};  ///< the shading frame, normal map included; n faces the eye
    Vector3 v{};            ///< to the eye
    std::array<std::array<float, 2>, 2> coordinates{};
    std::array<float, 4> color{1, 1, 1, 1};  ///< of the vertices; base color times it
    std::size_t material = 0;                ///< index into Scene::materials
};

SurfacePoint surface_point(const scene::Scene& scene, const Geometry& geometry, const Ray& ray,
                           const Hit& hit);

/// Where light starts from a point, so that the facets of a smooth surface do not shade themselves:
/// moved onto the curved surface that the normals at the corners tell of.
/// Hanika 2021, Hacking the Shadow Terminator, in Ray Tracing Gems II.
Vector3 shadow_origin(const scene::Scene& scene, const Geometry& geometry, const Hit& hit,
                      const SurfacePoint& point);

/// What shines by itself there, linear. An unlit material does so in its base color.
Vector3 emission(const scene::Scene& scene, const SurfacePoint& point);

/// A masked material's alpha says that nothing is there.
bool is_cut_out(const scene::Scene& scene, const SurfacePoint& point);

/// Everything that a module can ask of a material, by name and component: the surface's fields as
/// engines derive them, glTF's material read as analyze/residual/facts.h reads it, and the module's
/// parameters. A value that game code sets is taken in the middle of its range.
class MaterialValues {
public:
    /// The scene outlives this.
    MaterialValues(const scene::Scene& scene, const ir::Module& module);

    /// Numbers per point.
    std::size_t size() const { return size_; }
    /// Where a column of a tape is among them: `roughness`, `f0.r`; nothing for other names.
    std::optional<std::size_t> find(std::string_view column) const;

    /// `out` has `size()` numbers.
    void at(const SurfacePoint& point, std::span<float> out) const;

private:
    struct Parameter {
        std::string name;
        std::size_t first = 0;
        ir::Range range{};
        std::vector<double> otherwise;
    };
    /// What one material gives; null where it gives nothing.
    struct Given {
        const scene::Value* ior = nullptr;
        const scene::Value* specular = nullptr;
        const scene::Value* specular_color = nullptr;
        std::vector<const scene::Value*> parameters;
    };
    std::array<double, 3> dielectric_f0(const SurfacePoint& point) const;

    const scene::Scene& scene_;
    std::vector<Given> given_;  ///< per material
    std::vector<Parameter> parameters_;
    std::map<std::string, std::size_t, std::less<>> columns_;
    std::size_t size_ = 0;
};

}  // namespace lobe::render
