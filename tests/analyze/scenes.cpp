#include "analyze/scenes.h"

#include <fmt/format.h>

namespace lobe::tests {

scene::Value between(const scene::Components& low, const scene::Components& high,
                     const std::string& pointer)
{
    scene::Value value;
    value.offset.resize(low.size());
    value.low = low;
    value.high = high;
    value.pointer = pointer;
    value.is_given = true;
    return value;
}

scene::Value constant(const scene::Components& value, const std::string& pointer)
{
    return between(value, value, pointer);
}

scene::Material plain(const std::string& name)
{
    scene::Material material;
    material.name = name;
    material.base_color = constant({0.5, 0.5, 0.5, 1});
    material.metallic = constant({0});
    material.roughness = constant({0.5});
    material.emissive = constant({0, 0, 0});
    return material;
}

scene::Scene scene_of(std::vector<scene::Material> materials)
{
    scene::Scene scene;
    scene.path = "test.gltf";
    scene.materials = std::move(materials);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        scene.materials[i].pointer = fmt::format("/materials/{}", i);
    return scene;
}

}  // namespace lobe::tests
