// Textures: which picture, how it repeats, and how a material places it.
#include "scene/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace lobe::scene {
namespace {

/// OpenGL's numbers for the ways to repeat.
constexpr std::size_t clamp_to_edge = 33071;
constexpr std::size_t mirrored_repeat = 33648;
constexpr std::size_t repeat = 10497;

bool repeats(const View& sampler, std::string_view name)
{
    const std::size_t code = sampler.whole(name, repeat, 0, 65535);
    if (code != clamp_to_edge && code != mirrored_repeat && code != repeat)
        sampler.member(name)->error(
            fmt::format("{} is none of {}, {}, {}", code, repeat, mirrored_repeat, clamp_to_edge));
    return code != clamp_to_edge;
}

/// OpenGL's number for taking the texel that is nearest, of the picture itself: levels of detail
/// have averages of it.
constexpr std::size_t nearest_texel = 9728;

bool filters(const View& sampler)
{
    return sampler.whole("magFilter", 0, 0, 65535) != nearest_texel ||
           sampler.whole("minFilter", 0, 0, 65535) != nearest_texel;
}

/// Pictures of kinds that are known but not decoded come by extensions.
constexpr std::array<std::string_view, 3> picture_extensions{
    "KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds"};

constexpr std::size_t most_coordinates = 1000;

}  // namespace

Textures::Textures(const View& root, std::size_t image_count)
{
    std::vector<Entry> samplers;
    if (const auto listed = root.array("samplers"))
        for (std::size_t index = 0; index < listed->size(); ++index) {
            const View sampler = (*listed)[index];
            Entry& entry = samplers.emplace_back();
            if (!sampler.expect_object()) continue;
            entry.repeats_u = repeats(sampler, "wrapS");
            entry.repeats_v = repeats(sampler, "wrapT");
            entry.is_filtered = filters(sampler);
        }
    if (const auto listed = root.array("textures"))
        for (std::size_t index = 0; index < listed->size(); ++index)
            all_.push_back(entry((*listed)[index], image_count, samplers));
    used_.resize(image_count + without_image_.size());
}

Textures::Entry Textures::entry(const View& texture, std::size_t image_count,
                                const std::vector<Entry>& samplers)
{
    Entry entry;
    if (!texture.expect_object()) return entry;
    if (const auto sampler = texture.index("sampler", samplers.size(), "samplers"))
        entry = samplers[*sampler];
    if (texture.member("source")) {
        entry.image = texture.index("source", image_count, "images");
        return entry;
    }
    for (const std::string_view name : picture_extensions)
        if (const auto extension = texture.extension(name)) {
            entry.image = extension->index("source", image_count, "images");
            return entry;
        }
    entry.image = image_count + without_image_.size();
    without_image_.push_back(texture.pointer());
    return entry;
}

std::optional<Texture> Textures::read(const View& reference)
{
    if (!reference.expect_object() || !reference.require("index")) return std::nullopt;
    Texture texture;
    texture.pointer = reference.pointer();
    const auto index = reference.index("index", all_.size(), "textures");
    texture.coordinates = static_cast<int>(reference.whole("texCoord", 0, 0, most_coordinates));
    if (const auto transform = reference.extension("KHR_texture_transform")) {
        const auto offset = transform->numbers("offset", {0, 0});
        const auto scale = transform->numbers("scale", {1, 1});
        texture.offset = {offset[0], offset[1]};
        texture.scale = {scale[0], scale[1]};
        texture.rotation = transform->number("rotation", 0);
        texture.coordinates = static_cast<int>(transform->whole(
            "texCoord", static_cast<std::size_t>(texture.coordinates), 0, most_coordinates));
    }
    if (!index || !all_[*index].image) return std::nullopt;
    const Entry& entry = all_[*index];
    texture.image = *entry.image;
    texture.repeats_u = entry.repeats_u;
    texture.repeats_v = entry.repeats_v;
    texture.is_filtered = entry.is_filtered;
    use(texture.image);
    return texture;
}

}  // namespace lobe::scene
