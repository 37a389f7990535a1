#include "render/camera.h"

#include <algorithm>

namespace lobe::render {

Camera::Camera(const scene::Scene& scene, const Bounds& bounds, int width, int height)
    : width_{static_cast<float>(width)}, height_{static_cast<float>(height)}
{
    const float aspect = width_ / height_;
    if (scene.cameras.empty()) {
        constexpr float half_angle = 0.35F;  // 40 degrees in all
        const float narrow = std::min(1.0F, aspect);
        const float size = bounds.radius > 0 ? bounds.radius : 1;
        origin_ = bounds.center + Vector3{0, 0, size / (std::sin(half_angle) * narrow)};
        const float reach = std::tan(half_angle);
        right_ = {reach * aspect, 0, 0};
        up_ = {0, reach, 0};
        forward_ = {0, 0, -1};
        return;
    }
    const scene::Camera& camera = scene.cameras.front();
    origin_ = moved(camera.world, {0, 0, 0});
    forward_ = normalized(turned(camera.world, {0, 0, -1}));
    const Vector3 right = normalized(turned(camera.world, {1, 0, 0}));
    const Vector3 up = normalized(turned(camera.world, {0, 1, 0}));
    parallel_ = camera.half_height.has_value();
    // A picture narrower than the camera's own shows as much from left to right.
    float reach = parallel_ ? static_cast<float>(*camera.half_height)
                            : static_cast<float>(std::tan(camera.vertical_field_of_view / 2));
    if (camera.aspect_ratio > aspect) reach *= static_cast<float>(camera.aspect_ratio) / aspect;
    right_ = right * (reach * aspect);
    up_ = up * reach;
}

Ray Camera::through(float x, float y) const
{
    const Vector3 aside = right_ * (2 * x / width_ - 1) + up_ * (1 - 2 * y / height_);
    if (parallel_) return {origin_ + aside, forward_};
    return {origin_, normalized(forward_ + aside)};
}

}  // namespace lobe::render
