// Materials: the metallic-roughness model, the ratified extensions, and what `extras.lobe` says of
// a model's own parameters and of layers.
#pragma once

#include "scene/textures.h"

#include <optional>
#include <vector>

namespace lobe::scene {

/// `materials` of the file; nothing where there are too many.
std::optional<std::vector<Material>> read_materials(const View& root, Textures& textures,
                                                    const Limits& limits);
/// What glTF gives a primitive that names none.
Material default_material();

/// A member that is a factor, and the texture beside it that is multiplied in.
struct Factor {
    std::string_view name;  ///< of the member
    Components otherwise;   ///< per component
    Bounds bounds = unit_bounds;
    std::string_view texture = {};  ///< of the member with the texture; empty: there is none
    std::vector<int> channels = {};
    bool is_srgb = false;
};
Value read_factor(const View& holder, const Factor& factor, Textures& textures);

/// Material::extensions, `is_unlit` and the strength of `emissive`.
void read_extensions(const View& view, Textures& textures, Material& material);
/// `extras.lobe` of a material; `material_count` is for layers.
void read_parameters(const View& extras, Textures& textures, std::size_t material_count,
                     Material& material);

}  // namespace lobe::scene
