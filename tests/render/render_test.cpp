// Pictures whose pixels are known: a furnace, a lamp overhead, shadows.
#include "analyze/checked.h"
#include "analyze/packing/radiance_box.h"
#include "compile.h"
#include "render/camera.h"
#include "render/geometry.h"
#include "render/render.h"

#include <catch2/catch.hpp>
#include <png.h>

#include <cmath>
#include <cstring>
#include <numbers>

using namespace lobe;
using scene::Vector3;

namespace {

constexpr scene::Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

scene::Matrix at(double x, double y, double z, double scale = 1)
{
    scene::Matrix m = identity;
    m[0] = m[5] = m[10] = scale;
    m[12] = x;
    m[13] = y;
    m[14] = z;
    return m;
}

scene::Value constant(const scene::Components& value)
{
    scene::Value out;
    out.low = out.high = value;
    out.is_given = true;
    return out;
}

scene::Material material_of(const scene::Components& color)
{
    scene::Material material;
    material.base_color = constant(color);
    material.metallic = constant({0});
    material.roughness = constant({1});
    material.emissive = constant({0, 0, 0});
    return material;
}

/// A square from -1 to 1 that faces +z.
scene::Mesh square()
{
    scene::Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.coordinates[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {0, 1, 2, 0, 2, 3};
    mesh.material = 0;
    return mesh;
}

/// One square, filling the picture of a parallel camera.
scene::Scene one_square(const scene::Components& color)
{
    scene::Scene scene;
    scene.materials.push_back(material_of(color));
    scene.meshes.push_back(square());
    scene.instances.push_back({0, identity});
    scene::Camera camera;
    camera.world = at(0, 0, 2);
    camera.half_height = 1;
    scene.cameras.push_back(camera);
    return scene;
}

void add_uniform_sky(scene::Scene& scene)
{
    scene.environment.emplace();
    scene.images.push_back({});
    scene.images.back().pixels = scene::Pixels{1, 1, {1, 1, 1, 1}};
    std::array<std::size_t, 6> faces{};
    faces.fill(scene.images.size() - 1);
    scene.environment->specular.push_back(faces);
    scene.environment->specular_size = 1;
}

/// A diffuse model, and how it is lit.
struct Lambert {
    Lambert()
    {
        look.shaders.push_back(
            {&module, analyze::radiance_of(module, {module.models[0].outputs[0].function}), {}});
        look.shader_of = {0};
    }
    Lambert(const Lambert&) = delete;
    Lambert& operator=(const Lambert&) = delete;

    ir::Module module = middle(tests::checked_text(R"(module lambert
/// Lambert.
model lambert(g: geometry, s: surface) {
  diffuse = s.diffuse_color / pi * g.cos_i
}
)")
                                   .module);
    render::Look look;
};

render::RenderOptions small()
{
    render::RenderOptions options;
    options.width = options.height = 24;
    return options;
}

}  // namespace

TEST_CASE("a Lambert surface in a furnace reflects its albedo")
{
    Lambert lambert;
    scene::Scene scene = one_square({0.8, 0.5, 0.2, 1});
    add_uniform_sky(scene);
    const render::Picture picture = render::render(scene, lambert.look, small());
    const double albedo[]{0.8, 0.5, 0.2};
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        double squares = 0;
        for (const Vector3& pixel : picture.radiance) {
            sum += pixel[c];
            squares += double{pixel[c]} * pixel[c];
        }
        const double n = static_cast<double>(picture.radiance.size());
        const double mean = sum / n;
        // Pixels are independent estimates: five standard deviations of their mean.
        const double deviation = std::sqrt((squares / n - mean * mean) / n);
        CHECK(std::abs(mean - albedo[c]) < 5 * deviation);
        CHECK(deviation < 0.01 * albedo[c]);
    }
}

TEST_CASE("the picture does not depend on the number of threads")
{
    Lambert lambert;
    scene::Scene scene = one_square({0.8, 0.5, 0.2, 1});
    add_uniform_sky(scene);
    scene.instances.push_back({0, at(0.3, 0.2, 0.5, 0.25)});
    render::RenderOptions options = small();
    options.jobs = 1;
    const render::Picture one = render::render(scene, lambert.look, options);
    options.jobs = 3;
    const render::Picture three = render::render(scene, lambert.look, options);
    CHECK(one.radiance == three.radiance);
}

TEST_CASE("what stands in the way of the sky makes a surface darker, never brighter")
{
    Lambert lambert;
    scene::Scene open = one_square({0.8, 0.8, 0.8, 1});
    add_uniform_sky(open);
    scene::Scene covered = open;
    scene::Mesh roof = square();
    covered.meshes.push_back(roof);
    // Behind the camera, as large as the sky over the middle.
    covered.instances.push_back({1, at(0, 0, 3, 6)});
    const render::Picture a = render::render(open, lambert.look, small());
    const render::Picture b = render::render(covered, lambert.look, small());
    double bright = 0;
    double dark = 0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        CHECK(b.radiance[i][0] <= a.radiance[i][0]);
        bright += a.radiance[i][0];
        dark += b.radiance[i][0];
    }
    // From the middle the roof reaches 6 to the side at 3 above: it leaves at most the share of a
    // cone of slope 2, 1 - sin^2(atan 2) = 1/5, everywhere within 1 of the middle a little more.
    CHECK(dark < 0.3 * bright);
}

TEST_CASE("a scene without light is lit from the camera")
{
    Lambert lambert;
    const scene::Scene scene = one_square({0.8, 0.5, 0.2, 1});
    const render::Picture picture = render::render(scene, lambert.look, small());
    // pi times albedo / pi, seen and lit along the normal; three roundings of a product, one of a
    // division, and the sums over 4 rays.
    for (const Vector3& pixel : picture.radiance) CHECK(std::abs(pixel[0] - 0.8F) <= 8 * 0x1p-24F);
}

TEST_CASE("what emits is seen, and a miss is black without a sky")
{
    Lambert lambert;
    scene::Scene scene = one_square({0, 0, 0, 1});
    scene.materials[0].emissive = constant({2, 3, 4});
    scene.instances[0].world = at(0, 0, 0, 0.5);
    const render::Picture picture = render::render(scene, lambert.look, small());
    CHECK(picture.radiance[12 * 24 + 12] == Vector3{2, 3, 4});
    CHECK(picture.radiance[0] == Vector3{});
}

TEST_CASE("an unlit material shows its color, a masked one what is behind its holes")
{
    Lambert lambert;
    scene::Scene scene = one_square({0.25, 0.5, 0.75, 1});
    scene.materials[0].is_unlit = true;
    scene.materials.push_back(material_of({1, 0, 0, 0.25}));
    scene.materials[1].is_unlit = true;
    scene.materials[1].alpha = scene::Material::Alpha::mask;
    scene.meshes.push_back(square());
    scene.meshes[1].material = 1;
    scene.instances.push_back({1, at(0, 0, 0.5)});
    lambert.look.shader_of = {0, 0};
    const std::size_t middle_pixel = 12 * 24 + 12;
    CHECK(render::render(scene, lambert.look, small()).radiance[middle_pixel] ==
          Vector3{0.25F, 0.5F, 0.75F});
    scene.materials[1].alpha_cutoff = 0.25;
    CHECK(render::render(scene, lambert.look, small()).radiance[middle_pixel] == Vector3{1, 0, 0});
}

TEST_CASE("without a camera everything is in the picture")
{
    scene::Scene scene = one_square({1, 1, 1, 1});
    scene.cameras.clear();
    scene.instances[0].world = at(5, -3, 2, 0.7);
    const render::Geometry geometry{scene};
    for (const int width : {100, 50, 200}) {
        const render::Camera camera{scene, geometry.bounds(), width, 100};
        CHECK(geometry.first(camera.through(static_cast<float>(width) / 2, 50)));
        for (const float x : {0.0F, static_cast<float>(width)})
            for (const float y : {0.0F, 100.0F}) CHECK_FALSE(geometry.first(camera.through(x, y)));
    }
}

TEST_CASE("textures are read where their coordinates say")
{
    Lambert lambert;
    scene::Scene scene = one_square({1, 1, 1, 1});
    scene.images.push_back({});
    // Left half black, right half white; rows run down.
    scene.images[0].pixels = scene::Pixels{2, 1, {0, 0, 0, 1, 1, 1, 1, 1}};
    scene::Texture texture;
    texture.repeats_u = texture.repeats_v = false;
    scene.materials[0].base_color.texture = texture;
    scene.materials[0].base_color.channels = {0, 1, 2, 3};
    const render::Picture picture = render::render(scene, lambert.look, small());
    CHECK(picture.radiance[12 * 24 + 1][0] == 0);
    CHECK(picture.radiance[12 * 24 + 22][0] > 0.99F);
}

TEST_CASE("a PNG holds the bytes that it was given")
{
    const render::Panel panel{2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
    const std::string bytes = render::png(panel, 2);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0);
    image.format = PNG_FORMAT_RGB;
    REQUIRE(image.width == 2);
    REQUIRE(image.height == 2);
    std::vector<std::uint8_t> rgb(12);
    REQUIRE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr) != 0);
    CHECK(rgb == panel.rgb);
}

TEST_CASE("middle gray is shown as middle gray")
{
    const render::Picture gray{2, 1, {{0.3F, 0.3F, 0.3F}, {0.3F, 0.3F, 0.3F}}};
    const float factor = render::exposure(gray);
    CHECK(std::abs(factor * 0.3F - 0.18F) < 1e-6F);
    // 0.18 / 1.18 (1 + 0.18 / 16) = 0.15426, encoded 0.4292 * 255.
    CHECK(render::displayed(gray, factor) == std::vector<std::uint8_t>(6, 109));
    CHECK(render::difference({10, 20}, {10, 18}, 16) == std::vector<std::uint8_t>{128, 160});
}
