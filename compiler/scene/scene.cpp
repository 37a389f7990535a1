// What a scene shows, and how much of it.
#include "scene/scene.h"

#include <algorithm>
#include <numeric>

namespace lobe::scene {

std::vector<double> Scene::coverage() const
{
    std::vector<double> areas(materials.size());
    for (const Instance& instance : instances)
        areas[meshes[instance.mesh].material] += instance.area;
    if (std::accumulate(areas.begin(), areas.end(), 0.0) > 0) return areas;
    return std::vector<double>(materials.size(), 1);
}

std::vector<std::size_t> Scene::shown_materials() const
{
    std::vector<bool> is_shown(materials.size());
    std::vector<std::size_t> open;
    const auto show = [&](std::size_t material) {
        if (is_shown[material]) return;
        is_shown[material] = true;
        open.push_back(material);
    };
    for (const Instance& instance : instances) show(meshes[instance.mesh].material);
    if (open.empty())
        for (std::size_t material = 0; material < materials.size(); ++material) show(material);
    while (!open.empty()) {
        const Material& material = materials[open.back()];
        open.pop_back();
        for (const Layer& layer : material.layers) show(layer.material);
    }
    std::vector<std::size_t> shown;
    for (std::size_t material = 0; material < materials.size(); ++material)
        if (is_shown[material]) shown.push_back(material);
    return shown;
}

}  // namespace lobe::scene
