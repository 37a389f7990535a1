// Pictures: what their channels hold, and what happens to those that cannot be read.
#include "scene/pictures.h"
#include "scene/png.h"
#include "scene/reading.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using namespace lobe::tests;
using nlohmann::json;
using scene::Image;

namespace {

/// The one picture of a scene whose material shows it.
scene::ReadScene show(const std::string& bytes, const scene::ReadOptions& options = {})
{
    json document = empty_document();
    document["images"] = {{{"uri", "one.png"}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"] = json::parse(R"([{"emissiveTexture": {"index": 0}}])");
    return read(document, {{"one.png", bytes}}, options);
}

Image image(const std::string& bytes)
{
    const auto result = show(bytes);
    REQUIRE(told(result.complaints) == "");
    return result.scene->images.at(0);
}

std::vector<float> texels(const std::string& bytes) { return image(bytes).pixels->rgba; }

using Floats = std::vector<float>;

}  // namespace

TEST_CASE("every kind of PNG becomes four channels, as stored")
{
    CHECK(texels(png({.width = 2, .color = PngColor::rgba}, {255, 0, 51, 0, 102, 153, 204, 255})) ==
          Floats{1, 0, 0.2F, 0, 0.4F, 0.6F, 0.8F, 1});
    CHECK(texels(png({.color = PngColor::rgb}, {255, 0, 51})) == Floats{1, 0, 0.2F, 1});
    CHECK(texels(png({.color = PngColor::gray}, {51})) == Floats{0.2F, 0.2F, 0.2F, 1});
    CHECK(texels(png({.color = PngColor::gray_alpha}, {51, 102})) ==
          Floats{0.2F, 0.2F, 0.2F, 0.4F});
    CHECK(texels(png({.width = 2, .bits = 1, .color = PngColor::gray}, {0x40})) ==
          Floats{0, 0, 0, 1, 1, 1, 1, 1});
    CHECK(texels(png({.width = 2,
                      .color = PngColor::palette,
                      .palette = {0, 0, 0, 51, 102, 153},
                      .transparency = {255, 0}},
                     {1, 0})) == Floats{0.2F, 0.4F, 0.6F, 0, 0, 0, 0, 1});
    CHECK(texels(png({.color = PngColor::rgb, .transparency = {0, 7, 0, 8, 0, 9}}, {7, 8, 9}))[3] ==
          0);
}

TEST_CASE("what is written as a PNG is read again, packed or not")
{
    std::vector<std::uint8_t> bytes;
    for (int at = 0; at < 2 * 3 * 4 * 2; ++at) bytes.push_back(static_cast<std::uint8_t>(37 * at));
    for (const int components : {1, 3, 4})
        for (const bool is_wide : {false, true})
            for (const bool is_packed : {false, true}) {
                CAPTURE(components, is_wide, is_packed);
                const std::size_t size = is_wide ? 2 : 1;
                scene::PngTexels texels{2, 3, components, is_wide, bytes};
                texels.bytes.resize(6 * components * size);
                const scene::Picture back = scene::decode(encode_png(texels, is_packed), 6);
                REQUIRE(back.raster);
                CHECK(back.raster->width == 2);
                CHECK(back.raster->height == 3);
                CHECK(back.raster->is_wide == is_wide);
                for (std::size_t texel = 0; texel < 6; ++texel)
                    for (std::size_t byte = 0; byte < components * size; ++byte)
                        CHECK(back.raster->bytes[4 * size * texel + byte] ==
                              texels.bytes[components * size * texel + byte]);
            }
    // Rows that are not packed stand in the file as they are.
    const scene::PngTexels row{3, 1, 1, false, {'r', 'o', 'w'}};
    CHECK(encode_png(row, false).find("row") != std::string::npos);
}

TEST_CASE("sixteen bits are kept")
{
    const auto wide = texels(png({.bits = 16, .color = PngColor::rgba},
                                 {0xFF, 0xFF, 0x00, 0x01, 0x80, 0x00, 0x33, 0x33}));
    CHECK(wide == Floats{1, 1.0F / 65535, 32768.0F / 65535, 0.2F});
}

TEST_CASE("channels have their least and greatest value, also decoded")
{
    const auto shown =
        image(png({.width = 3, .color = PngColor::rgb}, {51, 0, 0, 102, 255, 0, 51, 0, 0}));
    CHECK(shown.channels[0].low == 0.2F);
    CHECK(shown.channels[0].high == 0.4F);
    CHECK_FALSE(shown.channels[0].only_ends);
    CHECK(shown.channels[1].low == 0);
    CHECK(shown.channels[1].high == 1);
    CHECK(shown.channels[1].only_ends);
    CHECK(shown.channels[2].high == 0);
    CHECK(shown.channels[2].only_ends);
    CHECK(shown.channels[3].low == 1);
    // One rounding of the power and four around it, in float.
    CHECK(shown.linear[0].low == Approx(std::pow((0.2 + 0.055) / 1.055, 2.4)).epsilon(1e-6));
    CHECK(shown.linear[1].low == 0);
    CHECK(shown.linear[1].high == 1);
    CHECK(shown.linear[1].only_ends);
    CHECK(shown.width == 3);
    CHECK(shown.height == 1);
}

TEST_CASE("a JPEG is read")
{
    const auto shown = image(slurp("moss_color.jpg"));
    CHECK(shown.width == 16);
    CHECK(shown.channels[3].low == 1);
    // It was made of red from 0.25 to 0.45 and blue of 0.2. Halved chroma and quality 85 blur that,
    // but no channel leaves the half of the range that it was in.
    CHECK(shown.channels[0].low > 0.15F);
    CHECK(shown.channels[0].high < 0.55F);
    CHECK(shown.channels[2].high < 0.4F);
    float low = 1;
    for (std::size_t texel = 0; texel < 256; ++texel)
        low = std::min(low, shown.pixels->rgba[4 * texel]);
    CHECK(low == shown.channels[0].low);
}

TEST_CASE("without pixels the channels are the same")
{
    const auto bytes = slurp("moss_gain.png");
    const auto facts = show(bytes, {.keep_pixels = false}).scene->images.at(0);
    CHECK_FALSE(facts.pixels);
    CHECK(facts.channels[0].low == image(bytes).channels[0].low);
    CHECK(facts.channels[0].high == image(bytes).channels[0].high);
    CHECK(facts.width == 16);
}

TEST_CASE("a picture that cannot be read has the full range, and a note says why")
{
    const std::string begin =
        "note /images/0: this picture is not read, so any value counts as in it: ";
    const auto check = [&](const std::string& bytes, const std::string& why) {
        const auto result = show(bytes);
        CHECK(told(result.complaints) == begin + why + "\n");
        REQUIRE(result.scene);
        const Image& unread = result.scene->images.at(0);
        CHECK(unread.why == why);
        CHECK_FALSE(unread.pixels);
        CHECK(unread.channels[0].low == 0);
        CHECK(unread.channels[0].high == 1);
        CHECK_FALSE(unread.channels[0].only_ends);
        CHECK(unread.linear[0].high == 1);
    };
    check("\xABKTX 20\xBB\r\n\x1A\n", "KTX2 is not decoded");
    check(std::string{"RIFF\0\0\0\0WEBPVP8 ", 16}, "WebP is not decoded");
    check("DDS |", "DDS is not decoded");
    check("", "these bytes are neither PNG nor JPEG");
    const std::string whole = png({.color = PngColor::gray}, {51});
    check(whole.substr(0, 30), "PNG: the file is cut off");
    std::string changed = whole;
    changed[16] ^= 1;  // the width: its chunk's check sum is another now
    check(changed, "PNG: IHDR: CRC error");
    const std::string jpeg = slurp("moss_color.jpg");
    check(jpeg.substr(0, jpeg.size() - 20), "JPEG: Premature end of JPEG file");
}

TEST_CASE("a missing picture is a note, a missing texture source too")
{
    json document = empty_document();
    document["images"] = {{{"uri", "none.png"}}, {{"uri", "unused.png"}}};
    document["textures"] = json::parse(R"([{"source": 0}, {}, {}])");
    document["materials"] =
        json::parse(R"([{"emissiveTexture": {"index": 0}, "normalTexture": {"index": 2}}])");
    const auto result = read(document);
    const std::string begin = ": this picture is not read, so any value counts as in it: ";
    CHECK(told(result.complaints) == "note /images/0" + begin + "`none.png`: no such file\n" +
                                         "note /textures/2" + begin +
                                         "this texture names no picture\n");
    REQUIRE(result.scene);
    CHECK(result.scene->materials[0].normal_map->image == 3);
    CHECK(result.scene->images.size() == 4);
}

TEST_CASE("pictures of other kinds come by extensions")
{
    json document = empty_document();
    document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_texture_basisu"};
    document["images"] = {{{"uri", "a.ktx2"}}};
    document["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
    document["materials"] = json::parse(R"([{"emissiveTexture": {"index": 0}}])");
    const auto result = read(document, {{"a.ktx2", "\xABKTX 20\xBB\r\n\x1A\n"}});
    REQUIRE(result.scene);
    CHECK(result.scene->images.at(0).why == "KTX2 is not decoded");
}

TEST_CASE("a texture bomb is refused by its header")
{
    // 40,000 x 40,000 texels, and a byte for each row.
    const std::string bomb = png({.width = 40'000, .height = 40'000, .color = PngColor::rgba}, {});
    const auto result = show(bomb);
    CHECK(told(result.complaints) ==
          "error /images/0: 40000 x 40000 texels are above the limit of 67108864\n");
    const auto line =
        show(png({.width = 70'000, .color = PngColor::gray}, std::vector<std::uint8_t>(70'000)));
    CHECK(told(line.complaints) ==
          "error /images/0: 70000 x 1 texels are above the limit of 67108864\n");
}

TEST_CASE("limits hold for one picture, for all, and for those that are kept")
{
    const auto two = [](const scene::Limits& limits, bool keep_pixels) {
        json document = empty_document();
        document["images"] = {{{"uri", "one.png"}}, {{"uri", "one.png"}}};
        document["textures"] = json::parse(R"([{"source": 0}, {"source": 1}])");
        document["materials"] =
            json::parse(R"([{"emissiveTexture": {"index": 0}, "normalTexture": {"index": 1}}])");
        const auto bytes = png({.width = 4, .color = PngColor::gray}, {0, 1, 2, 3});
        return told(
            read(document, {{"one.png", bytes}}, {.limits = limits, .keep_pixels = keep_pixels})
                .complaints);
    };
    scene::Limits limits;
    limits.image_texels = 4;
    limits.all_texels = 8;
    limits.kept_texels = 8;
    CHECK(two(limits, true) == "");
    limits.kept_texels = 7;
    CHECK(two(limits, false) == "");
    CHECK(two(limits, true) ==
          "error /images/1: 8 texels of all pictures are above the limit of 7\n");
    limits.all_texels = 7;
    CHECK(two(limits, false) == "error /images/1: 4 x 1 texels are above the limit of 3, after 4 "
                                "texels of other pictures\n");
    limits.image_texels = 3;
    CHECK(two(limits, false) == "error /images/0: 4 x 1 texels are above the limit of 3\n"
                                "error /images/1: 4 x 1 texels are above the limit of 3\n");
}
