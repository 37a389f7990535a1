// Materials: the metallic-roughness model, and the walk over all of them.
#include "scene/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lobe::scene {
namespace {

Material read_material(const View& view, Textures& textures, std::size_t material_count)
{
    static const Factor base_color{.name = "baseColorFactor",
                                   .otherwise = {1, 1, 1, 1},
                                   .texture = "baseColorTexture",
                                   .channels = {0, 1, 2, 3},
                                   .is_srgb = true};
    static const Factor metallic{.name = "metallicFactor",
                                 .otherwise = {1},
                                 .texture = "metallicRoughnessTexture",
                                 .channels = {2}};
    static const Factor roughness{.name = "roughnessFactor", .otherwise = {1}};
    static const Factor emissive{.name = "emissiveFactor",
                                 .otherwise = {0, 0, 0},
                                 .texture = "emissiveTexture",
                                 .channels = {0, 1, 2},
                                 .is_srgb = true};

    if (!view.expect_object()) return default_material();
    Material material;
    material.pointer = view.pointer();
    material.name = view.text("name");
    const View base = view.object_or_empty("pbrMetallicRoughness");
    material.base_color = read_factor(base, base_color, textures);
    material.metallic = read_factor(base, metallic, textures);
    material.roughness = read_factor(base, roughness, textures);
    // Both values are of one texture: what is wrong with it is said once.
    if (material.metallic.texture) {
        material.roughness.texture = material.metallic.texture;
        material.roughness.channels = {1};
        if (!material.roughness.is_given)
            material.roughness.pointer = material.metallic.texture->pointer;
        material.roughness.is_given = true;
    }
    material.emissive = read_factor(view, emissive, textures);
    if (const auto normal = view.object("normalTexture")) {
        material.normal_map = textures.read(*normal);
        material.normal_scale = normal->number("scale", 1);
    }
    if (const auto occlusion = view.object("occlusionTexture")) {
        material.occlusion_map = textures.read(*occlusion);
        occlusion->number("strength", 1, unit_bounds);
    }
    material.double_sided = view.flag("doubleSided", false);
    material.alpha = static_cast<Material::Alpha>(
        view.choice("alphaMode", {"OPAQUE", "MASK", "BLEND"}).value_or(0));
    material.alpha_cutoff = view.number("alphaCutoff", 0.5, not_negative);
    read_extensions(view, textures, material);
    if (const auto extras = view.extras())
        read_parameters(*extras, textures, material_count, material);
    return material;
}

/// Layers of layers are fine, as long as no material lies over itself. Kahn's order: materials
/// whose layers are all done leave; what is left at the end is in a ring or above one.
void refuse_rings(const View& root, const std::vector<Material>& materials)
{
    std::vector<std::size_t> open(materials.size());
    std::vector<std::vector<std::size_t>> bases(materials.size());
    std::vector<std::size_t> done;
    for (std::size_t index = 0; index < materials.size(); ++index) {
        open[index] = materials[index].layers.size();
        for (const Layer& layer : materials[index].layers) bases[layer.material].push_back(index);
        if (open[index] == 0) done.push_back(index);
    }
    std::size_t left = materials.size() - done.size();
    while (!done.empty()) {
        const std::size_t layer = done.back();
        done.pop_back();
        for (const std::size_t base : bases[layer])
            if (--open[base] == 0) {
                done.push_back(base);
                --left;
            }
    }
    if (left == 0) return;
    const auto first = std::ranges::find_if(open, [](std::size_t count) { return count > 0; });
    const auto index = static_cast<std::size_t>(first - open.begin());
    root.complaints().error(materials[index].pointer / "extras" / "lobe" / "layers",
                            "these layers lead to a material that lies over itself");
}

}  // namespace

Value read_factor(const View& holder, const Factor& factor, Textures& textures)
{
    Value value;
    value.pointer = holder.pointer();
    if (const auto given = holder.member(factor.name)) {
        value.pointer = given->pointer();
        value.is_given = true;
        if (factor.otherwise.size() == 1)
            value.low = {given->number(factor.otherwise[0], factor.bounds)};
        else
            value.low = holder.numbers(factor.name, factor.otherwise, factor.bounds);
    } else {
        value.low = factor.otherwise;
    }
    value.high = value.low;
    value.offset.resize(value.low.size());
    if (factor.texture.empty()) return value;
    const auto reference = holder.object(factor.texture);
    if (!reference) return value;
    value.texture = textures.read(*reference);
    value.channels = factor.channels;
    value.is_srgb = factor.is_srgb;
    if (!value.is_given) value.pointer = reference->pointer();
    value.is_given = true;
    return value;
}

Material default_material()
{
    const auto constant = [](const Components& components) {
        Value value;
        value.low = value.high = components;
        value.offset.resize(components.size());
        return value;
    };
    Material material;
    material.base_color = constant({1, 1, 1, 1});
    material.metallic = constant({1});
    material.roughness = constant({1});
    material.emissive = constant({0, 0, 0});
    return material;
}

std::optional<std::vector<Material>> read_materials(const View& root, Textures& textures,
                                                    const Limits& limits)
{
    std::vector<Material> materials;
    const auto listed = root.array("materials");
    if (!listed) return materials;
    if (listed->size() > limits.materials) {
        listed->error(fmt::format("{} materials are above the limit of {}", listed->size(),
                                  limits.materials));
        return std::nullopt;
    }
    materials.reserve(listed->size());
    for (std::size_t index = 0; index < listed->size(); ++index)
        materials.push_back(read_material((*listed)[index], textures, listed->size()));
    refuse_rings(root, materials);
    return materials;
}

}  // namespace lobe::scene
