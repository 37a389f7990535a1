// The sky as light: which face a direction meets, and that directions are chosen as they say.
#include "analyze/directions.h"
#include "render/sky.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace lobe;
using render::Sky;
using scene::Vector3;

namespace {

constexpr double full_sphere = 4 * std::numbers::pi;

/// Six faces of some texels each, by a function of face, row and column.
template <class Texel>
scene::Scene sky_of(int size, const Texel& texel)
{
    scene::Scene scene;
    scene.environment.emplace();
    std::array<std::size_t, 6> faces{};
    for (std::size_t face = 0; face < 6; ++face) {
        scene::Pixels pixels{size, size, {}};
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vector3 color = texel(face, x, y);
                pixels.rgba.insert(pixels.rgba.end(), {color[0], color[1], color[2], 1});
            }
        faces[face] = scene.images.size();
        scene.images.push_back({});
        scene.images.back().pixels = std::move(pixels);
    }
    scene.environment->specular.push_back(faces);
    scene.environment->specular_size = size;
    return scene;
}

Vector3 anywhere(analyze::Random& random)
{
    const analyze::Vector at = analyze::on_sphere(random);
    return {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
}

struct Mean {
    double sum = 0, squares = 0;
    std::size_t count = 0;

    void add(double x)
    {
        sum += x;
        squares += x * x;
        ++count;
    }
    double value() const { return sum / static_cast<double>(count); }
    /// Of the mean.
    double deviation() const
    {
        const double n = static_cast<double>(count);
        return std::sqrt((squares / n - value() * value()) / n);
    }
};

/// A few bright texels before a dim sky.
scene::Scene sunny()
{
    return sky_of(8, [](std::size_t face, int x, int y) -> Vector3 {
        if (face == 2 && x == 5 && y == 2) return {1, 0.9F, 0.7F};
        if (face == 4 && x < 2) return {0.2F, 0.4F, 0.9F};
        return {0.1F, 0.1F, 0.15F};
    });
}

}  // namespace

TEST_CASE("faces lie on the axes of a cube map, whose z is turned around")
{
    const Sky sky{sky_of(2, [](std::size_t face, int, int) -> Vector3 {
        return {face % 2 == 0 ? 1.0F : 0.0F, face / 2 == 0 ? 1.0F : 0.0F,
                face / 2 == 1 ? 1.0F : 0.0F};
    })};
    const Vector3 axes[]{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (std::size_t face = 0; face < 6; ++face) {
        const Vector3 light = sky.radiance(axes[face]);
        CHECK(light[0] == (face % 2 == 0 ? 1 : 0));
        CHECK(light[1] == (face / 2 == 0 ? 1 : 0));
        CHECK(light[2] == (face / 2 == 1 ? 1 : 0));
    }
}

TEST_CASE("rows run down and columns right, seen from inside")
{
    // Face +z is met toward -z, where x runs to the right and y up.
    const Sky sky{sky_of(2, [](std::size_t face, int x, int y) -> Vector3 {
        return face == 4 && x == 0 && y == 0 ? Vector3{1, 1, 1} : Vector3{0, 0, 0};
    })};
    CHECK(sky.radiance({-0.4F, 0.4F, -0.8F})[0] == 1);
    CHECK(sky.radiance({0.4F, 0.4F, -0.8F})[0] == 0);
    CHECK(sky.radiance({-0.4F, -0.4F, -0.8F})[0] == 0);
}

TEST_CASE("the environment's rotation turns the sky")
{
    scene::Scene scene = sky_of(2, [](std::size_t face, int, int) -> Vector3 {
        return face == 0 ? Vector3{1, 1, 1} : Vector3{0, 0, 0};
    });
    const double half = std::sqrt(0.5);  // a quarter turn around y: +x to -z
    scene.environment->rotation = {0, half, 0, half};
    const Sky sky{scene};
    CHECK(sky.radiance({0, 0, -1})[0] == 1);
    CHECK(sky.radiance({1, 0, 0})[0] == 0);
}

TEST_CASE("densities over the sphere are one")
{
    const Sky sky{sunny()};
    analyze::Random random{1};
    Mean mean;
    for (int i = 0; i < 200'000; ++i) mean.add(full_sphere * sky.density(anywhere(random)));
    CHECK(std::abs(mean.value() - 1) < 5 * mean.deviation());
}

TEST_CASE("directions are chosen in the density that is said of them")
{
    const Sky sky{sunny()};
    analyze::Random random{2};
    Mean solid_angle;  // of everything: the expectation of 1 / density
    Mean toward_the_sun;
    for (int i = 0; i < 200'000; ++i) {
        const Sky::Chosen chosen =
            sky.choose({static_cast<float>(random.unit()), static_cast<float>(random.unit())});
        CHECK(chosen.density == sky.density(chosen.direction));
        solid_angle.add(1 / chosen.density);
        toward_the_sun.add(sky.radiance(chosen.direction)[0] > 0.9F ? 1 / chosen.density : 0);
    }
    CHECK(std::abs(solid_angle.value() - full_sphere) < 5 * solid_angle.deviation());
    Mean sun;
    for (int i = 0; i < 200'000; ++i)
        sun.add(sky.radiance(anywhere(random))[0] > 0.9F ? full_sphere : 0);
    CHECK(std::abs(toward_the_sun.value() - sun.value()) <
          5 * std::hypot(sun.deviation(), toward_the_sun.deviation()));
}

TEST_CASE("no environment and a black one are dark")
{
    CHECK(Sky{scene::Scene{}}.is_dark());
    CHECK(Sky{sky_of(2, [](std::size_t, int, int) -> Vector3 { return {}; })}.is_dark());
    CHECK(Sky{scene::Scene{}}.radiance({0, 0, 1}) == Vector3{});
}

TEST_CASE("the mips of an environment end at a picture that was not read")
{
    scene::Scene scene = sky_of(2, [](std::size_t, int, int) -> Vector3 { return {1, 1, 1}; });
    scene.environment->intensity = 3;
    scene.images.push_back({});
    scene.images.back().pixels = scene::Pixels{1, 1, {1, 1, 1, 0.5F}};
    std::array<std::size_t, 6> faces{};
    faces.fill(scene.images.size() - 1);
    scene.environment->specular.push_back(faces);
    const analyze::CubeMap map = render::environment_map(scene);
    REQUIRE(map.levels.size() == 2);
    CHECK(map.levels[0].size == 2);
    CHECK(map.levels[0].at(0, 0, 0) == analyze::Radiance{3, 3, 3});
    CHECK(map.levels[1].at(5, 0, 0) == analyze::Radiance{6, 6, 6});  // over its alpha

    scene.images.push_back({});
    faces[3] = scene.images.size() - 1;
    scene.environment->specular.push_back(faces);
    CHECK(render::environment_map(scene).levels.size() == 2);
    CHECK(render::environment_map(scene::Scene{}).levels.empty());
}
