// Meshes: primitives with their accessors decoded, as lists of triangles.
#pragma once

#include "scene/accessors.h"

#include <vector>

namespace lobe::scene {

struct Meshes {
    std::vector<Mesh> primitives;
    /// Per mesh of the file, the first of its primitives; and one more, the end of the last.
    std::vector<std::size_t> first{0};
    bool shows_default = false;  ///< a primitive names no material; its index is that count then

    std::size_t size() const { return first.size() - 1; }
};

/// `meshes` of the file. `quantized`: KHR_mesh_quantization is required. Without
/// ReadOptions::geometry only positions and triangles are decoded.
Meshes read_meshes(const View& root, const Accessors& accessors, std::size_t material_count,
                   bool quantized, const ReadOptions& options);

}  // namespace lobe::scene
