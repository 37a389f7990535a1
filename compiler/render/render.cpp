#include "render/render.h"

#include "analyze/random.h"
#include "analyze/tasks.h"
#include "render/camera.h"
#include "render/integrate.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

namespace lobe::render {
namespace {

constexpr int tile = 16;  // pixels along an edge

/// What a ray meets, past what masks cut out of at most so many surfaces.
std::optional<std::pair<Hit, SurfacePoint>> first_seen(const scene::Scene& scene,
                                                       const Geometry& geometry, Ray ray)
{
    constexpr int most = 64;
    for (int i = 0; i < most; ++i) {
        const auto hit = geometry.first(ray);
        if (!hit) return std::nullopt;
        const SurfacePoint point = surface_point(scene, geometry, ray, *hit);
        if (!is_cut_out(scene, point)) return std::pair{*hit, point};
        ray.origin = point.position + ray.direction * (0x1p-12F * (1 + hit->distance));
    }
    return std::nullopt;
}

}  // namespace

Picture render(const scene::Scene& scene, const Look& look, const RenderOptions& options)
{
    const Geometry geometry{scene};
    const Sky sky{scene};
    const Camera camera{scene, geometry.bounds(), options.width, options.height};
    std::vector<Lighting> lighting;
    for (const Shader& shader : look.shaders)
        lighting.emplace_back(scene, geometry, sky, shader, options);

    Picture picture{options.width, options.height, {}};
    picture.radiance.resize(static_cast<std::size_t>(options.width) * options.height);
    const int across_tiles = (options.width + tile - 1) / tile;
    const int down_tiles = (options.height + tile - 1) / tile;
    const int rays = options.rays;
    const float share = 1 / static_cast<float>(rays * rays);
    std::mutex told;
    std::size_t done = 0;

    const auto draw = [&](std::size_t index) {
        std::vector<std::vector<Seen>> seen(lighting.size());
        const int left = static_cast<int>(index) % across_tiles * tile;
        const int top = static_cast<int>(index) / across_tiles * tile;
        for (int y = top; y < std::min(top + tile, options.height); ++y)
            for (int x = left; x < std::min(left + tile, options.width); ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * options.width + x;
                for (int k = 0; k < rays * rays; ++k) {
                    const std::uint64_t seed =
                        pixel * static_cast<unsigned>(rays * rays) + static_cast<unsigned>(k);
                    analyze::Random random{seed};
                    const auto place = [&](int cell, int at) {
                        return static_cast<float>(at) +
                               (static_cast<float>(cell) + static_cast<float>(random.unit())) /
                                   static_cast<float>(rays);
                    };
                    const float across = place(k % rays, x);
                    const Ray ray = camera.through(across, place(k / rays, y));
                    const auto hit = first_seen(scene, geometry, ray);
                    if (!hit) {
                        picture.radiance[pixel] =
                            picture.radiance[pixel] + sky.radiance(ray.direction) * share;
                        continue;
                    }
                    const auto& [where, point] = *hit;
                    if (scene.materials[point.material].is_unlit) {
                        picture.radiance[pixel] =
                            picture.radiance[pixel] + emission(scene, point) * share;
                        continue;
                    }
                    seen[look.shader_of[point.material]].push_back(
                        {point, shadow_origin(scene, geometry, where, point), pixel, ~seed});
                }
            }
        for (std::size_t s = 0; s < lighting.size(); ++s) {
            if (seen[s].empty()) continue;
            const std::vector<Vector3> light = lighting[s].light(seen[s]);
            for (std::size_t i = 0; i < light.size(); ++i) {
                Vector3& pixel = picture.radiance[seen[s][i].pixel];
                pixel = pixel + light[i] * share;
            }
        }
        const std::lock_guard lock{told};
        ++done;
        if (options.progress)
            options.progress(done, static_cast<std::size_t>(across_tiles) * down_tiles);
    };
    analyze::for_each_task(static_cast<std::size_t>(across_tiles) * down_tiles, options.jobs, draw);
    return picture;
}

}  // namespace lobe::render
