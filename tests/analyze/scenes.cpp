#include "analyze/scenes.h"

#include <fmt/format.h>

namespace lobe::tests {

scene::Value between(std::vector<double> low, std::vector<double> high, const std::string& pointer)
{
    scene::Value value;
    value.offset.assign(low.size(), 0);
    value.low = std::move(low);
    value.high = std::move(high);
    value.pointer = pointer;
    value.is_given = true;
    return value;
}

scene::Value constant(std::vector<double> value, const std::string& pointer)
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
