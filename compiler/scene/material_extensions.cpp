// The ratified KHR_materials_*: one row of a table per number that they give.
#include "scene/materials.h"

#include <numbers>
#include <string>
#include <utility>

namespace lobe::scene {
namespace {

struct Row {
    std::string_view extension;
    std::string_view key;  ///< in Material::extensions
    Factor factor;
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Sources are the extensions' own texts: default, bounds, and the texture's channels.
const std::vector<Row>& rows()
{
    static const std::vector<Row> all{
        {"KHR_materials_anisotropy",
         "anisotropy",
         {"anisotropyStrength", {0}, unit_bounds, "anisotropyTexture", {2}}},
        {"KHR_materials_anisotropy", "anisotropy_rotation", {"anisotropyRotation", {0}, {}}},
        {"KHR_materials_clearcoat",
         "clearcoat",
         {"clearcoatFactor", {0}, unit_bounds, "clearcoatTexture", {0}}},
        {"KHR_materials_clearcoat",
         "clearcoat_roughness",
         {"clearcoatRoughnessFactor", {0}, unit_bounds, "clearcoatRoughnessTexture", {1}}},
        {"KHR_materials_diffuse_transmission",
         "diffuse_transmission",
         {"diffuseTransmissionFactor", {0}, unit_bounds, "diffuseTransmissionTexture", {3}}},
        {"KHR_materials_diffuse_transmission",
         "diffuse_transmission_color",
         {"diffuseTransmissionColorFactor",
          {1, 1, 1},
          unit_bounds,
          "diffuseTransmissionColorTexture",
          {0, 1, 2},
          true}},
        {"KHR_materials_dispersion", "dispersion", {"dispersion", {0}, not_negative}},
        {"KHR_materials_ior", "ior", {"ior", {1.5}, not_negative}},
        {"KHR_materials_iridescence",
         "iridescence",
         {"iridescenceFactor", {0}, unit_bounds, "iridescenceTexture", {0}}},
        {"KHR_materials_iridescence", "iridescence_ior", {"iridescenceIor", {1.3}, Bounds{1}}},
        {"KHR_materials_iridescence",
         "iridescence_thickness_minimum",
         {"iridescenceThicknessMinimum", {100}, not_negative}},
        {"KHR_materials_iridescence",
         "iridescence_thickness_maximum",
         {"iridescenceThicknessMaximum", {400}, not_negative}},
        {"KHR_materials_sheen",
         "sheen_color",
         {"sheenColorFactor", {0, 0, 0}, unit_bounds, "sheenColorTexture", {0, 1, 2}, true}},
        {"KHR_materials_sheen",
         "sheen_roughness",
         {"sheenRoughnessFactor", {0}, unit_bounds, "sheenRoughnessTexture", {3}}},
        {"KHR_materials_specular",
         "specular",
         {"specularFactor", {1}, unit_bounds, "specularTexture", {3}}},
        {"KHR_materials_specular",
         "specular_color",
         {"specularColorFactor", {1, 1, 1}, not_negative, "specularColorTexture", {0, 1, 2}, true}},
        {"KHR_materials_transmission",
         "transmission",
         {"transmissionFactor", {0}, unit_bounds, "transmissionTexture", {0}}},
        {"KHR_materials_volume",
         "thickness",
         {"thicknessFactor", {0}, not_negative, "thicknessTexture", {1}}},
        {"KHR_materials_volume",
         "attenuation_distance",
         {"attenuationDistance", {infinity}, positive}},
        {"KHR_materials_volume", "attenuation_color", {"attenuationColor", {1, 1, 1}}},
    };
    return all;
}

/// Textures that give no number of their own but have to be there.
constexpr std::pair<std::string_view, std::string_view> further_textures[] = {
    {"KHR_materials_clearcoat", "clearcoatNormalTexture"},
    {"KHR_materials_iridescence", "iridescenceThicknessTexture"},
};

}  // namespace

void read_extensions(const View& view, Textures& textures, Material& material)
{
    const auto extensions = view.object("extensions");
    if (!extensions) return;
    for (const std::string_view name : extensions->names()) extensions->object(name);
    const auto find = [&](std::string_view name) {  // what is no object was complained of
        auto found = extensions->member(name);
        return found && found->is_object() ? found : std::nullopt;
    };
    material.is_unlit = find("KHR_materials_unlit").has_value();
    for (const Row& row : rows()) {
        const auto extension = find(row.extension);
        if (!extension) continue;
        Value value = read_factor(*extension, row.factor, textures);
        if (value.is_given || value.high[0] < infinity)
            material.extensions.emplace(row.key, std::move(value));
    }
    for (const auto& [name, member] : further_textures)
        if (const auto extension = find(name))
            if (const auto reference = extension->object(member)) textures.read(*reference);

    if (const auto ior = material.extensions.find("ior"); ior != material.extensions.end()) {
        const double index = ior->second.low[0];
        if (index > 0 && index < 1)
            view.complaints().error(ior->second.pointer,
                                    "an index of refraction is at least 1, or 0 for none");
    }
    // The texture turns the direction by any angle.
    if (const auto anisotropy = material.extensions.find("anisotropy");
        anisotropy != material.extensions.end() && anisotropy->second.texture) {
        Value& rotation = material.extensions.at("anisotropy_rotation");
        rotation.low[0] -= std::numbers::pi;
        rotation.high[0] += std::numbers::pi;
        rotation.is_given = true;
    }
    if (const auto emissive = find("KHR_materials_emissive_strength")) {
        const double strength = emissive->number("emissiveStrength", 1, not_negative);
        for (double& component : material.emissive.low) component *= strength;
        material.emissive.high = material.emissive.low;
    }
}

}  // namespace lobe::scene
