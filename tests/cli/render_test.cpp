// `lobec render` as a user runs it.
#include "cli/command.h"

#include <catch2/catch.hpp>
#include <png.h>

using namespace lobe;
using Catch::Matchers::Contains;

namespace {

const std::string scenes = std::string{ROOT} + "/tests/data/scenes/";
const std::string model = std::string{" --model "} + ROOT + "/models/callisto.lobe";

/// Width and height of a PNG's text; 0 where it is none.
std::pair<unsigned, unsigned> size_of(const std::string& bytes)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return {0, 0};
    const std::pair size{image.width, image.height};
    png_image_free(&image);
    return size;
}

}  // namespace

TEST_CASE("a scene becomes a picture of the size that was asked for")
{
    const tests::Scratch scratch;
    const auto outcome = scratch.run("lobec render " + scenes + "mixed.gltf" + model +
                                     " --size 48x32 -o picture.png");
    CHECK(outcome.status == 0);
    CHECK(outcome.err.empty());
    CHECK_THAT(outcome.out, Contains("picture.png: 48 x 32"));
    CHECK(size_of(scratch.read("picture.png")) == std::pair{48U, 32U});
}

TEST_CASE("every kind of light and the sky can be drawn, the same on any number of threads")
{
    const tests::Scratch scratch;
    for (const std::string name : {"lights.gltf", "environment.gltf", "textured.glb"}) {
        const std::string command = "lobec render " + scenes + name + model + " --size 40x40 -o ";
        REQUIRE(scratch.run(command + "one.png -j 1").status == 0);
        REQUIRE(scratch.run(command + "three.png -j 3").status == 0);
        CHECK(scratch.read("one.png") == scratch.read("three.png"));
    }
}

TEST_CASE("an environment's mips and coefficients are held against its sharpest mip")
{
    const tests::Scratch scratch;
    const auto told = [&](const std::string& name) {
        const auto outcome =
            scratch.run("lobec render " + scenes + name + model + " --size 8x8 -o a.png");
        CHECK(outcome.status == 0);
        return outcome.out;
    };
    const std::string line =
        "environment: against the sharpest mip, irradiance is off by 0.2 %, coarser mips by ";
    CHECK_THAT(told("environment.gltf"), Contains(line));
    CHECK_THAT(told("lights.gltf"), !Contains("environment:"));
}

TEST_CASE("what specialize leaves looks like the whole model")
{
    const tests::Scratch scratch;
    const auto outcome = scratch.run("lobec render " + scenes + "mixed.gltf" + model +
                                     " --size 64x64 --compare general -o compare.png");
    REQUIRE(outcome.status == 0);
    CHECK(size_of(scratch.read("compare.png")) == std::pair{192U, 64U});
    CHECK_THAT(outcome.out, Contains("left: residual"));
    // The two are one function, differently rounded: a value on the border between two codes may
    // fall on either side.
    const bool close = outcome.out.find("by at most 0 of 255") != std::string::npos ||
                       outcome.out.find("by at most 1 of 255") != std::string::npos;
    CHECK(close);
}

TEST_CASE("a picture can be piped")
{
    const tests::Scratch scratch;
    const auto outcome = scratch.run("lobec render " + scenes + "base_only.gltf" + model +
                                     " --size 8x8 -o - > piped.png");
    CHECK(outcome.status == 0);
    CHECK(size_of(scratch.read("piped.png")) == std::pair{8U, 8U});
}

TEST_CASE("bad requests leave nothing behind")
{
    const tests::Scratch scratch;
    const std::string scene = scenes + "base_only.gltf";
    const auto refused = [&](const std::string& arguments, const std::string& why) {
        const auto outcome = scratch.run("lobec render " + arguments);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains(why));
        CHECK(scratch.entries() == 0);
    };
    refused(scene + model + " -o a.png --size 0x10", "--size takes WIDTHxHEIGHT");
    refused(scene + model + " -o a.png --size 10", "--size takes WIDTHxHEIGHT");
    refused(scene + model + " -o a.png --size 99999x1", "--size takes WIDTHxHEIGHT");
    refused(scene + model + " -o missing/folder/a.png --exposure 0", "--exposure");
    refused(scene + model + ":nonsense -o a.png", "nonsense");
    refused("absent.gltf" + model + " -o a.png", "absent.gltf");
    refused(scene + " --model absent.lobe -o a.png", "absent.lobe");
    refused(scene + model, "--output");
}
