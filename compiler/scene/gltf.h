// glTF 2.0 to a Scene: `.gltf` and `.glb`, with the ratified KHR_materials_*, KHR_lights_punctual,
// KHR_texture_transform, KHR_mesh_quantization and EXT_lights_image_based.
//
// Text and bytes in, a value or a list of complaints out; other files are read through a callback.
// A file is untrusted: sizes are checked before anything is allocated, numbers must be finite, and
// every complaint names the JSON pointer of what it is about.
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::scene {

/// What is wrong with a scene, or worth knowing of it.
struct Complaint {
    bool is_error = true;
    Pointer pointer;  ///< empty: the file as a whole
    std::string message;
    std::string help;  ///< may be empty
};

/// What one scene may ask of the machine. Above a limit is an error that names it.
struct Limits {
    std::size_t file_bytes = std::size_t{1} << 30;  ///< of the file, and of each that it names
    std::size_t materials = 100'000;
    std::size_t nodes = 1'000'000;
    std::size_t instances = std::size_t{1} << 22;  ///< primitives that nodes show
    std::size_t vertices = std::size_t{1} << 25;   ///< of all meshes together
    std::size_t triangles = std::size_t{1} << 26;  ///< likewise
    /// Shown under scales that differ by axis, instances counted: each has to be measured.
    std::size_t distorted_triangles = std::size_t{1} << 30;
    std::size_t image_texels = std::size_t{1} << 26;  ///< of one picture
    std::size_t all_texels = std::size_t{1} << 30;    ///< that are decoded
    std::size_t kept_texels = std::size_t{1} << 28;   ///< of all pictures whose pixels are kept
};

/// The bytes of a file that the scene names, by its URI relative to the scene (percent-decoded), or
/// nothing and why.
struct Fetched {
    std::optional<std::string> bytes;
    std::string why;
};
using Fetch = std::function<Fetched(const std::string& uri)>;

struct ReadScene {
    std::optional<Scene> scene;  ///< none where a complaint is an error
    std::vector<Complaint>
        complaints;  ///< in the order of the file; at most 100, then how many more
};

struct ReadOptions {
    Limits limits{};
    bool geometry = true;     ///< false: accessors are checked but not decoded but for areas
    bool keep_pixels = true;  ///< false: only what channels hold
};

/// `path` is for messages. `.glb` is known by its first bytes.
ReadScene read_gltf(std::string_view bytes, const std::string& path, const Fetch& fetch,
                    const ReadOptions& options = {});

}  // namespace lobe::scene
