// The triangles of a scene, as rays meet them. Embree does the work; this hides it.
//
// In: a scene whose meshes were read. Out: what a ray meets first, and whether anything stands
// between two points. Built by one thread, so that equal scenes are equal trees.
#pragma once

#include "render/vector.h"
#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

namespace lobe::render {

struct Ray {
    Vector3 origin;
    Vector3 direction;  ///< a unit vector
};

/// Where a ray meets a triangle: its corners weigh 1 - u - v, u and v.
struct Hit {
    std::size_t instance = 0;  ///< index into Scene::instances
    std::size_t triangle = 0;
    float u = 0;
    float v = 0;
    float distance = 0;
};

/// A sphere that holds everything.
struct Bounds {
    Vector3 center{};
    float radius = 0;  ///< 0: there is nothing
};

class Geometry {
public:
    /// `scene` outlives this.
    explicit Geometry(const scene::Scene& scene);
    ~Geometry();
    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;

    std::optional<Hit> first(const Ray& ray) const;
    /// Something is met before `distance`.
    bool blocked(const Ray& ray, float distance) const;
    Bounds bounds() const;
    /// A corner of a triangle, in the world.
    Vector3 corner(const Hit& hit, int index) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace lobe::render
