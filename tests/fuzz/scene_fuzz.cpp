// The reader of scenes on any bytes: as a scene, as a picture and as a URI. What must hold:
//
//   - a scene comes out exactly when no complaint is an error, and there are 101 at most;
//   - every index of a scene is in it, every number is finite, and channels are ordered;
//   - a picture has the texels that its size says.
//
// Files that a scene names are zeros, but for pictures, which are the input itself.
#include "scene/gltf.h"
#include "scene/pictures.h"
#include "scene/uri.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

using namespace lobe::scene;

void require(bool condition)
{
    if (!condition) std::abort();
}

template <class Numbers>
void check_finite(const Numbers& numbers)
{
    for (const double number : numbers) require(std::isfinite(number));
}

void check_texture(const Scene& scene, const std::optional<Texture>& texture)
{
    if (texture) require(texture->image < scene.images.size());
}

void check_value(const Scene& scene, const Value& value)
{
    require(!value.low.empty() && value.low.size() == value.high.size() &&
            value.low.size() == value.offset.size());
    check_finite(value.low);
    check_finite(value.high);
    check_finite(value.offset);
    check_texture(scene, value.texture);
    if (value.texture) require(value.channels.size() == value.low.size());
    for (const int channel : value.channels) require(channel >= 0 && channel < 4);
}

void check_materials(const Scene& scene)
{
    require(!scene.materials.empty());
    for (const Material& material : scene.materials) {
        for (const Value* value :
             {&material.base_color, &material.metallic, &material.roughness, &material.emissive})
            check_value(scene, *value);
        for (const auto& [name, value] : material.extensions) check_value(scene, value);
        for (const auto& [name, value] : material.parameters) check_value(scene, value);
        for (const Layer& layer : material.layers) {
            require(layer.material < scene.materials.size());
            check_value(scene, layer.weight);
        }
        check_texture(scene, material.normal_map);
        check_texture(scene, material.occlusion_map);
    }
}

void check_meshes(const Scene& scene)
{
    for (const Mesh& mesh : scene.meshes) {
        const std::size_t count = mesh.positions.size();
        const auto fits = [&](const auto& attribute) {
            return attribute.empty() || attribute.size() == count;
        };
        require(mesh.material < scene.materials.size());
        require(fits(mesh.normals) && fits(mesh.tangents) && fits(mesh.colors) &&
                fits(mesh.coordinates[0]) && fits(mesh.coordinates[1]));
        require(mesh.triangles.size() % 3 == 0);
        for (const std::uint32_t index : mesh.triangles) require(index < count);
        for (const Vector3& position : mesh.positions)
            for (const float component : position) require(std::isfinite(component));
    }
}

void check_scene(const Scene& scene)
{
    check_materials(scene);
    check_meshes(scene);
    for (const Instance& instance : scene.instances) {
        require(instance.mesh < scene.meshes.size());
        require(std::isfinite(instance.area) && instance.area >= 0);
        for (const double element : instance.world) require(std::isfinite(element));
    }
    for (const Image& image : scene.images) {
        for (const ChannelFacts& channel : image.channels) require(channel.low <= channel.high);
        if (image.pixels)
            require(image.pixels->rgba.size() == std::size_t{4} *
                                                     static_cast<unsigned>(image.width) *
                                                     static_cast<unsigned>(image.height));
    }
    if (scene.environment)
        for (const auto& faces : scene.environment->specular)
            for (const std::size_t face : faces) require(face < scene.images.size());
    require(scene.coverage().size() == scene.materials.size());
    check_finite(scene.coverage());
    require(!scene.shown_materials().empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string input{reinterpret_cast<const char*>(data), size};
    const Fetch fetch = [&](const std::string& path) {
        if (path.ends_with(".bin")) return Fetched{std::string(1U << 15U, '\0'), ""};
        if (path.ends_with("g")) return Fetched{input, ""};
        return Fetched{std::nullopt, "no such file"};
    };
    ReadOptions options;
    options.limits = {.file_bytes = 1U << 20U,
                      .materials = 100,
                      .nodes = 1000,
                      .instances = 1000,
                      .vertices = 1U << 14U,
                      .triangles = 1U << 14U,
                      .distorted_triangles = 1U << 16U,
                      .image_texels = 1U << 14U,
                      .all_texels = 1U << 16U,
                      .kept_texels = 1U << 15U};
    options.geometry = size % 4 != 0;
    options.keep_pixels = size % 3 != 0;
    const ReadScene read = read_gltf(input, "fuzz.gltf", fetch, options);
    bool has_errors = false;
    for (const Complaint& complaint : read.complaints) {
        require(!complaint.message.empty());
        require(complaint.pointer.empty() || complaint.pointer.front() == '/');
        has_errors |= complaint.is_error;
    }
    require(read.complaints.size() <= 101);
    require(read.scene.has_value() != has_errors);
    if (read.scene) check_scene(*read.scene);

    const Picture picture = decode(input, options.limits.image_texels);
    require(picture.raster.has_value() == picture.why.empty());
    if (const auto& raster = picture.raster)
        require(raster->bytes.size() == std::size_t{raster->is_wide ? 8U : 4U} *
                                            static_cast<unsigned>(raster->width) *
                                            static_cast<unsigned>(raster->height));
    const auto resolved = resolve(input);
    if (const auto* file = std::get_if<FilePath>(&resolved))
        require(!file->path.empty() && file->path.front() != '/' && file->path != ".." &&
                !file->path.starts_with("../"));
    return 0;
}
