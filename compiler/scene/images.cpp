// Pictures: where their bytes are, and what their channels hold.
#include "scene/images.h"

#include "scene/color.h"
#include "scene/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lobe::scene {
namespace {

/// Calls `each(texel, channel, code)` for all codes of a picture.
template <typename Each>
void for_each_code(const Raster& raster, Each each)
{
    const std::size_t codes = raster.is_wide ? raster.bytes.size() / 2 : raster.bytes.size();
    for (std::size_t at = 0; at < codes; ++at) {
        const std::uint32_t code = raster.is_wide
                                       ? raster.bytes[2 * at] * 256U + raster.bytes[2 * at + 1]
                                       : raster.bytes[at];
        each(at / 4, at % 4, code);
    }
}

float most_of(const Raster& raster) { return raster.is_wide ? 65535.0F : 255.0F; }

void find_channels(const Raster& raster, Image& image)
{
    const auto most = static_cast<std::uint32_t>(most_of(raster));
    std::array<std::uint32_t, 4> low{most, most, most, most};
    std::array<std::uint32_t, 4> high{};
    std::array<bool, 4> has_between{};
    for_each_code(raster, [&](std::size_t, std::size_t channel, std::uint32_t code) {
        low[channel] = std::min(low[channel], code);
        high[channel] = std::max(high[channel], code);
        has_between[channel] |= code != 0 && code != most;
    });
    for (std::size_t channel = 0; channel < 4; ++channel)
        image.channels[channel] = {static_cast<float>(low[channel]) / most_of(raster),
                                   static_cast<float>(high[channel]) / most_of(raster),
                                   !has_between[channel]};
    // The curve rises, so ends go to ends, and it keeps 0 and 1.
    for (std::size_t channel = 0; channel < 3; ++channel)
        image.linear[channel] = {linear_of_srgb(image.channels[channel].low),
                                 linear_of_srgb(image.channels[channel].high),
                                 image.channels[channel].only_ends};
}

Pixels to_pixels(const Raster& raster)
{
    Pixels pixels{raster.width, raster.height, {}};
    pixels.rgba.resize(raster.is_wide ? raster.bytes.size() / 2 : raster.bytes.size());
    const float most = most_of(raster);
    for_each_code(raster, [&](std::size_t texel, std::size_t channel, std::uint32_t code) {
        pixels.rgba[4 * texel + channel] = static_cast<float>(code) / most;
    });
    return pixels;
}

/// What reading pictures has cost so far.
struct Spent {
    std::size_t texels = 0;
    std::size_t kept = 0;
};

void leave_unread(const View& view, std::string why, Image& image)
{
    view.complaints().note(
        image.pointer,
        fmt::format("this picture is not read, so any value counts as in it: {}", why));
    image.why = std::move(why);
}

void read_image(const View& view, std::string_view bytes, const ReadOptions& options, Spent& spent,
                Image& image)
{
    const Limits& limits = options.limits;
    Picture picture =
        decode(bytes, std::min(limits.image_texels, limits.all_texels - spent.texels));
    if (picture.is_above_limit) {
        view.error(spent.texels == 0 ? picture.why
                                     : fmt::format("{}, after {} texels of other pictures",
                                                   picture.why, spent.texels));
        return;
    }
    if (!picture.raster) {
        leave_unread(view, std::move(picture.why), image);
        return;
    }
    const Raster& raster = *picture.raster;
    find_channels(raster, image);
    image.width = raster.width;
    image.height = raster.height;
    const std::size_t texels =
        static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
    spent.texels += texels;
    if (!options.keep_pixels) return;
    spent.kept += texels;
    if (spent.kept > limits.kept_texels)
        view.error(fmt::format("{} texels of all pictures are above the limit of {}", spent.kept,
                               limits.kept_texels));
    else
        image.pixels = to_pixels(raster);
}

}  // namespace

std::vector<Image> list_images(const View& root)
{
    std::vector<Image> images;
    if (const auto listed = root.array("images"))
        for (std::size_t index = 0; index < listed->size(); ++index) {
            const View view = (*listed)[index];
            Image& image = images.emplace_back();
            image.pointer = view.pointer();
            image.why = "nothing shows it";
            if (!view.expect_object()) continue;
            image.name = view.text("name");
            const bool has_uri = view.member("uri").has_value();
            if (has_uri == view.member("bufferView").has_value())
                view.error(has_uri ? "`uri` and `bufferView` are given"
                                   : "one of `uri` and `bufferView` is missing");
        }
    return images;
}

void read_images(const View& root, const std::vector<bool>& used, const Buffers& buffers,
                 const Fetch& fetch, const ReadOptions& options, std::vector<Image>& images)
{
    const auto listed = root.member("images");
    const std::size_t of_file = listed ? listed->size() : 0;
    Spent spent;
    for (std::size_t index = 0; index < images.size(); ++index) {
        Image& image = images[index];
        if (index >= of_file) {
            if (used[index]) leave_unread(root, image.why, image);
            continue;
        }
        const View view = (*listed)[index];
        const auto uri = view.member("uri");
        const auto window = view.index("bufferView", buffers.window_count(), "bufferViews");
        if (!used[index]) continue;
        image.why.clear();
        if (uri) {
            Resource resource = read_resource(*uri, fetch, options.limits);
            if (resource.bytes)
                read_image(view, *resource.bytes, options, spent, image);
            else if (!resource.is_broken)
                leave_unread(view, std::move(resource.why), image);
        } else if (window && buffers.window(*window)) {
            read_image(view, buffers.window(*window)->bytes, options, spent, image);
        }
    }
}

}  // namespace lobe::scene
