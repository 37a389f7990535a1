// glTF 2.0 to a Scene: the parts of the file in the order in which they need each other.
#include "scene/gltf.h"

#include "scene/container.h"
#include "scene/images.h"
#include "scene/lights.h"
#include "scene/materials.h"
#include "scene/matrix.h"
#include "scene/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace lobe::scene {
namespace {

/// What a file may require. Pictures of the last three kinds are not decoded, and count as any.
constexpr std::array<std::string_view, 20> known_extensions{"EXT_lights_image_based",
                                                            "KHR_lights_punctual",
                                                            "KHR_materials_anisotropy",
                                                            "KHR_materials_clearcoat",
                                                            "KHR_materials_diffuse_transmission",
                                                            "KHR_materials_dispersion",
                                                            "KHR_materials_emissive_strength",
                                                            "KHR_materials_ior",
                                                            "KHR_materials_iridescence",
                                                            "KHR_materials_sheen",
                                                            "KHR_materials_specular",
                                                            "KHR_materials_transmission",
                                                            "KHR_materials_unlit",
                                                            "KHR_materials_variants",
                                                            "KHR_materials_volume",
                                                            "KHR_mesh_quantization",
                                                            "KHR_texture_transform",
                                                            "EXT_texture_webp",
                                                            "KHR_texture_basisu",
                                                            "MSFT_texture_dds"};

/// Major version of `2.0`; 0 where the text is no version.
int major_version(const std::string& text)
{
    const std::size_t dot = text.find('.');
    const auto is_number = [](std::string_view part) {
        return !part.empty() && part.size() < 4 &&
               std::ranges::all_of(part, [](char digit) { return digit >= '0' && digit <= '9'; });
    };
    if (dot == text.npos || !is_number(std::string_view{text}.substr(0, dot)) ||
        !is_number(std::string_view{text}.substr(dot + 1)))
        return 0;
    return std::stoi(text.substr(0, dot));
}

void check_asset(const View& root)
{
    if (!root.require("asset")) return;
    const auto asset = root.object("asset");
    if (!asset || !asset->require("version")) return;
    const std::string version = asset->text("version", "2.0");
    if (major_version(version) != 2)
        asset->member("version")->error(fmt::format("glTF 2 is read, this is `{}`", version));
    const std::string least = asset->text("minVersion", "2.0");
    if (least != "2.0")
        asset->member("minVersion")->error(fmt::format("glTF 2.0 is read, `{}` is needed", least));
}

/// True if `KHR_mesh_quantization` is required.
bool check_extensions(const View& root)
{
    std::vector<std::string_view> used;
    if (const auto listed = root.array("extensionsUsed"))
        for (std::size_t index = 0; index < listed->size(); ++index)
            if (const auto name = (*listed)[index].text()) used.push_back(*name);
    bool quantized = false;
    if (const auto listed = root.array("extensionsRequired"))
        for (std::size_t index = 0; index < listed->size(); ++index) {
            const View view = (*listed)[index];
            const auto name = view.text();
            if (!name) continue;
            quantized |= *name == "KHR_mesh_quantization";
            if (std::ranges::find(known_extensions, *name) == known_extensions.end())
                view.error(fmt::format("extension `{}` is required, and not known", *name));
            else if (std::ranges::find(used, *name) == used.end())
                view.error(fmt::format("extension `{}` is missing in `extensionsUsed`", *name));
        }
    return quantized;
}

/// Areas of what is shown. One per mesh is enough where nodes do not distort it.
void measure(const Limits& limits, Complaints& complaints, Scene& scene)
{
    std::vector<double> local(scene.meshes.size(), -1);
    std::size_t distorted = 0;
    for (Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (const auto scale = uniform_scale(instance.world)) {
            double& area = local[instance.mesh];
            if (area < 0) area = area_of(mesh, identity);
            instance.area = area * *scale * *scale;
            continue;
        }
        distorted += mesh.triangles.size() / 3;
        if (distorted > limits.distorted_triangles) {
            complaints.error("", fmt::format("more than {} triangles are shown under scales that "
                                             "differ by axis",
                                             limits.distorted_triangles));
            return;
        }
        instance.area = area_of(mesh, instance.world);
    }
}

Scene read_scene(const View& root, std::optional<std::string_view> binary, const Fetch& fetch,
                 const ReadOptions& options)
{
    Scene scene;
    check_asset(root);
    const bool quantized = check_extensions(root);
    const Buffers buffers{root, binary, fetch, options.limits};
    const Accessors accessors{root, buffers};
    scene.images = list_images(root);
    const std::size_t image_count = scene.images.size();
    Textures textures{root, image_count};
    for (const Pointer& pointer : textures.without_image()) {
        Image& image = scene.images.emplace_back();
        image.pointer = pointer;
        image.why = "this texture names no picture";
    }
    auto materials = read_materials(root, textures, options.limits);
    if (!materials) return scene;  // what refers to them would be wrong for no reason of its own
    scene.materials = std::move(*materials);
    const std::vector<Light> lights = read_lights(root);
    const std::vector<Environment> environments = read_environments(root, image_count, textures);
    read_images(root, textures.used(), buffers, fetch, options, scene.images);
    check_faces(environments, scene.images, root.complaints());
    Meshes meshes = read_meshes(root, accessors, scene.materials.size(), quantized, options);
    if (meshes.shows_default || scene.materials.empty())
        scene.materials.push_back(default_material());
    place_nodes(root, {meshes, lights, environments}, options.limits, scene);
    scene.meshes = std::move(meshes.primitives);
    if (!root.complaints().has_errors()) measure(options.limits, root.complaints(), scene);
    if (!options.geometry)
        for (Mesh& mesh : scene.meshes) {
            mesh.positions = {};
            mesh.triangles = {};
        }
    return scene;
}

}  // namespace

ReadScene read_gltf(std::string_view bytes, const std::string& path, const Fetch& fetch,
                    const ReadOptions& options)
{
    Complaints complaints;
    std::optional<Scene> scene;
    if (bytes.size() > options.limits.file_bytes) {
        complaints.error("", fmt::format("{} bytes are above the limit of {}", bytes.size(),
                                         options.limits.file_bytes));
    } else if (const auto container = open_container(bytes, complaints)) {
        if (const auto json = parse_json(container->json, complaints)) {
            const View root{json->root(), complaints};
            if (root.expect_object()) {
                scene = read_scene(root, container->binary, fetch, options);
                scene->path = path;
            }
        }
    }
    if (complaints.has_errors()) scene.reset();
    return {std::move(scene), complaints.take()};
}

}  // namespace lobe::scene
