// Lights: KHR_lights_punctual and EXT_lights_image_based.
#include "scene/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace lobe::scene {
namespace {

void read_cones(const View& view, Light& light)
{
    const auto spot = view.object("spot");
    if (!spot) {
        view.require("spot");
        return;
    }
    constexpr double right_angle = std::numbers::pi / 2;
    // Half a right angle in 64 bits may be above what the file can say of it in decimals.
    light.outer_cone =
        spot->number("outerConeAngle", std::numbers::pi / 4, {0, right_angle * (1 + 1e-6), true});
    light.outer_cone = std::min(light.outer_cone, right_angle);
    light.inner_cone = spot->number("innerConeAngle", 0, not_negative);
    if (light.inner_cone >= light.outer_cone)
        spot->error(fmt::format("the inner cone's angle {} is not below the outer one's {}",
                                light.inner_cone, light.outer_cone));
}

/// `extras.lobe` of a light: its size.
void read_size(const View& view, Light& light)
{
    const auto extras = view.extras();
    if (!extras) return;
    extras->allow_only({"length", "radius"});
    const bool has_length = extras->member("length").has_value();
    if (light.kind != Light::Kind::point) {
        extras->error("only a point light has a size");
        return;
    }
    if (!extras->require("radius")) return;
    light.radius = extras->number("radius", 0, positive);
    light.length = extras->number("length", 0, positive);
    light.kind = has_length ? Light::Kind::tube : Light::Kind::sphere;
}

Light read_light(const View& view)
{
    Light light;
    light.pointer = view.pointer();
    if (!view.expect_object() || !view.require("type")) return light;
    light.name = view.text("name");
    const auto kind = view.choice("type", {"directional", "point", "spot"});
    if (!kind) return light;
    light.kind = static_cast<Light::Kind>(*kind);
    const auto color = view.numbers("color", {1, 1, 1}, unit_bounds);
    light.color = {color[0], color[1], color[2]};
    light.intensity = view.number("intensity", 1, not_negative);
    if (view.member("range")) {
        light.range = view.number("range", 1, positive);
        if (light.kind == Light::Kind::directional)
            view.member("range")->error("a directional light has no range");
    }
    if (light.kind == Light::Kind::spot) read_cones(view, light);
    read_size(view, light);
    return light;
}

Environment read_environment(const View& view, std::size_t image_count, Textures& textures)
{
    Environment environment;
    environment.pointer = view.pointer();
    if (!view.expect_object()) return environment;
    environment.name = view.text("name");
    environment.intensity = view.number("intensity", 1, not_negative);
    environment.rotation = view.rotation("rotation");
    const bool is_whole = view.require("irradianceCoefficients") &&
                          view.require("specularImages") && view.require("specularImageSize");
    if (!is_whole) return environment;
    if (const auto coefficients = view.array("irradianceCoefficients")) {
        if (coefficients->size() != environment.irradiance.size())
            coefficients->error(fmt::format("{} coefficients; bands 0 to 2 have {}",
                                            coefficients->size(), environment.irradiance.size()));
        else
            for (std::size_t index = 0; index < coefficients->size(); ++index) {
                const auto color = (*coefficients)[index].numbers({0, 0, 0});
                environment.irradiance[index] = {color[0], color[1], color[2]};
            }
    }
    constexpr std::size_t largest = 65536;
    environment.specular_size = static_cast<int>(view.whole("specularImageSize", 1, 1, largest));
    const auto mips = view.array("specularImages");
    for (std::size_t mip = 0; mips && mip < mips->size(); ++mip) {
        const View faces = (*mips)[mip];
        if (!faces.is_array() || faces.size() != 6) {
            faces.error("a mip has six faces");
            continue;
        }
        std::array<std::size_t, 6> indices{};
        bool is_good = true;
        for (std::size_t face = 0; face < indices.size(); ++face) {
            const auto image = faces[face].index(image_count, "images");
            is_good &= image.has_value();
            if (!image) continue;
            indices[face] = *image;
            textures.use(*image);
        }
        if (is_good) environment.specular.push_back(indices);
    }
    return environment;
}

}  // namespace

std::vector<Light> read_lights(const View& root)
{
    std::vector<Light> lights;
    const auto extension = root.extension("KHR_lights_punctual");
    if (!extension || !extension->require("lights")) return lights;
    if (const auto listed = extension->array("lights"))
        for (std::size_t index = 0; index < listed->size(); ++index)
            lights.push_back(read_light((*listed)[index]));
    return lights;
}

std::vector<Environment> read_environments(const View& root, std::size_t image_count,
                                           Textures& textures)
{
    std::vector<Environment> environments;
    const auto extension = root.extension("EXT_lights_image_based");
    if (!extension || !extension->require("lights")) return environments;
    if (const auto listed = extension->array("lights"))
        for (std::size_t index = 0; index < listed->size(); ++index)
            environments.push_back(read_environment((*listed)[index], image_count, textures));
    return environments;
}

void check_faces(const std::vector<Environment>& environments, const std::vector<Image>& images,
                 Complaints& complaints)
{
    for (const Environment& environment : environments)
        for (std::size_t mip = 0; mip < environment.specular.size(); ++mip) {
            const int size = mip < 31 ? std::max(environment.specular_size >> mip, 1) : 1;
            for (std::size_t face = 0; face < 6; ++face) {
                const Image& image = images[environment.specular[mip][face]];
                if (image.width == 0 || (image.width == size && image.height == size)) continue;
                complaints.error(
                    environment.pointer / "specularImages" / mip / face,
                    fmt::format("this picture has {} x {} texels; a face of mip {} has {} x {}",
                                image.width, image.height, mip, size, size));
            }
        }
}

}  // namespace lobe::scene
