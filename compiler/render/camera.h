// Rays through the pixels of a picture.
#pragma once

#include "render/geometry.h"
#include "scene/scene.h"

namespace lobe::render {

class Camera {
public:
    /// The scene's first camera; or, where there is none, one that sees all of `bounds` from +z,
    /// where glTF's models face.
    Camera(const scene::Scene& scene, const Bounds& bounds, int width, int height);

    /// Through a place of the picture, in pixels from its upper left corner.
    Ray through(float x, float y) const;

private:
    Vector3 origin_;
    Vector3 right_, up_, forward_;  ///< right and up reach from the middle to the picture's edges
    bool parallel_ = false;
    float width_, height_;
};

}  // namespace lobe::render
