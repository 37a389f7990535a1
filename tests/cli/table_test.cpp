// `lobec table` as a user runs it: what is in the files, what errors are said, and bad input.
#include "command.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;
using nlohmann::json;

namespace {

/// Terms whose tables are known by heart.
const std::string terms = R"(module small

param gain : float in [0, 4] = 2

/// Straight: linear interpolation loses nothing.
term plane(x: unit, y: float in [1, 3]) -> float = (x + y) / 4
/// A parabola, between texels off by a quarter of the step squared.
term square(x: unit) -> float = x^2
/// Beyond what a unorm holds, and below.
term wide(x: float in [-1, 1]) -> float = 3 * x
/// Beyond by less than a hundredth.
term nearly(x: unit) -> float = 1.005 * x
/// With a parameter.
term scaled(x: unit) -> float = gain * x / 4
/// Three components.
term three(x: unit) -> float3 = float3(x, 1 - x, x / 2)
/// What a table cannot be of.
term free(x: float) -> float = x / 2
term constant() -> float = 0.25
term three_arguments(x: unit, y: unit, z: unit) -> float = (x + y + z) / 3
term choice(x: unit) -> bool = x > 0.5
term counted(x: unit, count: int in [0, 4]) -> float = x * count / 4
term directed(d: direction) -> float = abs(d.x)
/// Schlick's masking at alpha / 2 is [Karis13] eq 4.
term visibility(alpha: float in [1/4096, 1], g: geometry) -> float =
  0.25 / (lerp(alpha / 2, 1, g.cos_i) * lerp(alpha / 2, 1, g.cos_o))
)";

std::uint32_t little(const std::string& bytes, std::size_t at, int size)
{
    std::uint32_t value = 0;
    for (int i = size; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

std::uint32_t big(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

json errors(const Scratch& scratch, const std::string& options)
{
    const Outcome outcome = scratch.run("lobec table small.lobe " + options + " --json -");
    CAPTURE(options, outcome.err);
    REQUIRE(outcome.status == 0);
    return json::parse(outcome.out);
}

}  // namespace

TEST_CASE("a straight term loses what its format loses, and nothing else")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const json unorm = errors(scratch, "plane --size 5x9 --format r16");
    const json& component = unorm["components"][0];
    CHECK(unorm["width"] == 5);
    CHECK(unorm["height"] == 9);
    CHECK(unorm["bytes"] == 5 * 9 * 2);
    // Rounding of doubles in the interpolation.
    CHECK(component["interpolation"]["worst"] <= 1e-15);
    // Half a step at most, and some texel is that far off or nearly.
    CHECK(component["storage"]["worst"] <= 0.5 / 65535 + 1e-16);
    CHECK(component["storage"]["worst"] >= 0.25 / 65535);
    // Weights of 8 bits are off by 1/512 of a texel, which is 1/16 across and 2/32 down.
    CHECK(component["together"]["worst"] <= 0.5 / 65535 + (1.0 / 16 + 1.0 / 16) / 512 + 1e-15);
    CHECK(errors(scratch, "plane --size 5x9 --format r32f")["components"][0]["storage"]["worst"] <=
          0x1p-25);
}

TEST_CASE("a little beyond a unorm is clamped, and told")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const json nearly = errors(scratch, "nearly --size 9 --format r16");
    CHECK(nearly["components"][0]["storage"]["worst"].get<double>() == Approx(0.005).margin(1e-12));
    CHECK(nearly["components"][0]["interpolation"]["worst"] <= 1e-15);
}

TEST_CASE("between texels a parabola is off by a quarter of a step squared")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const json ends = errors(scratch, "square --size 17 --format float");
    CHECK(ends["components"][0]["interpolation"]["worst"].get<double>() ==
          Approx(1.0 / 16 / 16 / 4).epsilon(1e-9));
    CHECK(ends["axes"][0]["scale"].get<double>() == 16.0 / 17);
    CHECK(ends["axes"][0]["offset"].get<double>() == 0.5 / 17);
    // With texels in the middle of parts, the ends are held: 1 - (1 - 1/32)^2.
    const json centers = errors(scratch, "square --size 16 --format float --texels centers");
    CHECK(centers["components"][0]["interpolation"]["worst"].get<double>() ==
          Approx(1 - std::pow(31.0 / 32, 2)).epsilon(1e-9));
    CHECK(centers["axes"][0]["scale"] == 1.0);
    CHECK(centers["axes"][0]["offset"] == 0.0);
}

TEST_CASE("tables are files that say what they hold")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    REQUIRE(
        scratch.run("lobec table small.lobe plane --size 3x2 --format r16g16 -o a.dds").status ==
        0);
    const std::string dds = scratch.read("a.dds");
    REQUIRE(dds.size() == 4 + 124 + 20 + 3 * 2 * 4);
    CHECK(dds.substr(0, 4) == "DDS ");
    CHECK(little(dds, 12, 4) == 2);  // height
    CHECK(little(dds, 16, 4) == 3);  // width
    CHECK(dds.substr(84, 4) == "DX10");
    CHECK(little(dds, 128, 4) == 35);  // DXGI_FORMAT_R16G16_UNORM
    // (0, 1), (1/2, 1), (1, 1), then y = 3; the second channel is empty.
    const std::array<double, 6> values{0.25, 0.375, 0.5, 0.75, 0.875, 1};
    for (std::size_t i = 0; i < values.size(); ++i) {
        CHECK(little(dds, 148 + 4 * i, 2) == std::floor(values[i] * 65535 + 0.5));
        CHECK(little(dds, 150 + 4 * i, 2) == 0);
    }

    REQUIRE(scratch.run("lobec table small.lobe plane --size 3x2 --format r16f -o h.dds").status ==
            0);
    const std::string half = scratch.read("h.dds");
    CHECK(little(half, 128, 4) == 54);
    CHECK(little(half, 148, 2) == 0x3400);  // 0.25
    CHECK(little(half, 158, 2) == 0x3c00);  // 1

    REQUIRE(scratch.run("lobec table small.lobe plane --size 3x2 --format r8 -o a.png").status ==
            0);
    const std::string png = scratch.read("a.png");
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    CHECK(big(png, 16) == 3);
    CHECK(big(png, 20) == 2);
    CHECK(png[24] == 8);  // bits
    CHECK(png[25] == 0);  // gray
    // The signature, IHDR, then IDAT: the zlib header, one stored block of two rows of 1 + 3.
    const std::size_t idat = 8 + 25;
    CHECK(big(png, idat) == 2 + 5 + 8 + 4);
    CHECK(png.substr(idat + 15, 8) == std::string{"\0\x40\x60\x80\0\xbf\xdf\xff", 8});
    // Of a chunk without content the checksum is known: IEND is ae 42 60 82.
    CHECK(png.substr(png.size() - 8) == "IEND\xae\x42\x60\x82");

    REQUIRE(scratch.run("lobec table small.lobe plane --size 3x2 --format float -o a.h").status ==
            0);
    CHECK_THAT(scratch.read("a.h"), Contains("static const float plane[6] = {") &&
                                        Contains("0.25f, 0.375f, 0.5f, 0.75f, 0.875f, 1.0f,") &&
                                        Contains("u = x * 0.666666667 + 0.166666667"));

    const Outcome csv = scratch.run("lobec table small.lobe plane --size 3x2 --format float -o -");
    CHECK(csv.out == "x,y,plane\n0,1,0.25\n0.5,1,0.375\n1,1,0.5\n0,3,0.75\n0.5,3,0.875\n1,3,1\n");
    // Another axis across, a part of a range, and any number of threads.
    CHECK(scratch
              .run("lobec table small.lobe plane --size 2x2 --format float -o - --across y "
                   "--range y=1..2 -j 3")
              .out == "y,x,plane\n1,0,0.25\n2,0,0.5\n1,1,0.5\n2,1,0.75\n");
    // A parameter's default, and another value.
    CHECK(scratch.run("lobec table small.lobe scaled --size 2 --format float -o -").out ==
          "x,scaled\n0,0\n1,0.5\n");
    CHECK(scratch.run("lobec table small.lobe scaled --size 2 --format float -o - --set gain=1")
              .out == "x,scaled\n0,0\n1,0.25\n");
    // Three components take four channels, the last one full.
    REQUIRE(scratch.run("lobec table small.lobe three --size 2 -o t.dds").status == 0);
    const std::string wide = scratch.read("t.dds");
    CHECK(little(wide, 128, 4) == 11);
    CHECK(little(wide, 154, 2) == 65535);
}

TEST_CASE("the split sum is exact where its samples are not")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const std::string split = "visibility --split-sum --size 8x8 --format float --points 1024";
    const Outcome exact = scratch.run("lobec table small.lobe " + split +
                                      " --range cos_o=0.25..1 --range roughness=0.25..1 -o -");
    CAPTURE(exact.err);
    REQUIRE(exact.status == 0);
    // karis.csv: roughness 0.25, n.v 0.25 has a bias of 0.17334749148373; roughness 1, n.v 1 of
    // 3.3614294725618e-05.
    std::istringstream rows{exact.out};
    std::string row;
    std::getline(rows, row);
    CHECK(row == "cos_o,roughness,scale,bias");
    std::getline(rows, row);
    CHECK(std::stod(row.substr(row.rfind(',') + 1)) == Approx(0.17334749148373).epsilon(0x1p-24));
    for (int i = 1; i < 64; ++i) std::getline(rows, row);
    CHECK(std::stod(row.substr(row.rfind(',') + 1)) ==
          Approx(3.3614294725618e-05).epsilon(0x1p-24));

    // Sums come nearer with samples.
    const auto values = [&](const std::string& options) {
        std::istringstream cells{
            scratch.run("lobec table small.lobe " + split + options + " -o -").out};
        std::vector<double> out;
        std::string line;
        std::getline(cells, line);
        while (std::getline(cells, line))
            out.push_back(std::stod(line.substr(line.rfind(',') + 1)));
        REQUIRE(out.size() == 64);
        return out;
    };
    const auto integrals = values("");
    const auto off = [&](const std::string& options) {
        const auto sums = values(options);
        double worst = 0;
        for (std::size_t i = 0; i < sums.size(); ++i)
            worst = std::max(worst, std::fabs(sums[i] - integrals[i]));
        return worst;
    };
    const double few = off(" --samples 64");
    const double many = off(" --samples 4096");
    CHECK(few > 2 * many);
    CHECK(many > 0);
    const json sampled = errors(scratch, split + " --samples 64");
    CHECK_THAT(sampled["values_by"].get<std::string>(), Contains("64 importance samples"));
}

TEST_CASE("fits are shown beside the published one")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const json found = errors(scratch, "visibility --split-sum --fit");
    REQUIRE(found["fits"].size() == 3);
    const auto error = [&](std::size_t i, const char* which) {
        return found["fits"][i]["error"][which].get<double>();
    };
    CHECK(found["fits"][0]["name"] == "published");
    CHECK(error(1, "root_mean_square") < error(0, "root_mean_square"));
    CHECK(error(2, "reflected") < error(1, "reflected"));
    CHECK(error(2, "reflected") < error(0, "reflected"));
    const Outcome text = scratch.run("lobec table small.lobe visibility --split-sum --fit -j 1");
    CHECK_THAT(text.out, Contains("least mean square") && Contains("let a = min(x^2, 2^("));
    CHECK(text.out == scratch.run("lobec table small.lobe visibility --split-sum --fit -j 3").out);
    // What is printed can be pasted.
    const std::size_t body = text.out.rfind("  let x");
    scratch.write("pasted.lobe",
                  "module pasted\n/// A fit.\nterm fit(roughness: float in [1/64, 1], cos_o: unit) "
                  "-> float2 {\n" +
                      text.out.substr(body) + "}\n");
    CHECK(scratch.run("lobec table pasted.lobe fit --format half").status == 0);
}

TEST_CASE("what cannot be tabulated is said")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const int before = scratch.entries();
    const std::vector<std::pair<std::string, std::string>> refused{
        {"plain", "no term `plain`; did you mean `plane`?"},
        {"constant", "`constant` depends on nothing"},
        {"three_arguments", "`three_arguments` depends on x, y, z, and a table is over one or two"},
        {"free", "`x` has no range"},
        {"choice", "true or false"},
        {"counted", "`counted` depends on `count`, and a table is over one or two real numbers"},
        {"directed", "`directed` depends on `d`"},
        {"wide", "`wide` reaches 3, and R16_UNORM holds 0 to 1"},
        {"three --format r16g16", "`three` has 3 components, and R16G16_UNORM holds 2"},
        {"plane --format r12", "unknown format `r12`; there are r8, "},
        {"plane --size 0x4", "2 to 4096 texels along a side, not 0"},
        {"plane --size 4x1", "2 to 4096 texels along a side, not 1"},
        {"plane --size 100000x4", "2 to 4096 texels along a side, not 100000"},
        {"plane --size 4096x4096", "at most 4194304 texels"},
        {"plane --size 99999999999999999999x4", "is no size"},
        {"plane --size 4", "depends on x and y: write WIDTHxHEIGHT"},
        {"plane --size -4x4", "is no size"},
        {"plane --size fourxfour", "is no size"},
        {"square --size 4x4", "depends on x alone: write WIDTH"},
        {"plane --texels middle", "middle"},
        {"plane --across z", "depends on x and y, not on `z`"},
        {"plane --range z=0..1", "depends on x and y, not on `z`"},
        {"plane --range x=1..0", "is no range"},
        {"plane --range x", "is no range"},
        {"plane --range x=nan..1", "is no range"},
        {"plane --range x=2..3", "lies outside of what `x` can be"},
        {"plane --points 1", "--points"},
        {"plane --samples 4", "--samples goes with --split-sum"},
        {"plane --fit", "--fit goes with --split-sum"},
        {"visibility --split-sum --samples 0", "--samples"},
        {"visibility --split-sum --fit -o lut.dds", "--fit makes no table"},
        {"plane --split-sum", "`plane` depends on `x`, and a visibility only on"},
        {"three --split-sum", "more than one number"},
        {"plane -o lut", "`lut` says no kind of file"},
        {"plane -o lut.tga", "says no kind of file"},
        {"plane --as tga -o lut", "tga"},
        {"plane --format half -o lut.png", "a PNG holds unorm values"},
        {"plane -o - --json -", "only one of --output, --json"},
        {"plane -o small.lobe/lut.dds", "cannot write"},
        {"plane --set gian=1", "gian"},
    };
    for (const auto& [options, message] : refused) {
        const Outcome outcome = scratch.run("lobec table small.lobe " + options);
        CAPTURE(options, outcome.out, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains(message));
    }
    CHECK(scratch.run("lobec table missing.lobe plane").status == 2);
    CHECK(scratch.run("lobec table .").status == 2);
    scratch.write("broken.lobe", "module broken\nterm t(x: unit) = 1 / x\n");
    CHECK(scratch.run("lobec table broken.lobe t").status == 1);
    // Nothing half-written.
    CHECK(scratch.entries() == before + 1);
}

TEST_CASE("the help has an example that runs")
{
    const Scratch scratch;
    const Outcome help = scratch.run("lobec table --help");
    CHECK(help.status == 0);
    CHECK_THAT(help.out, Contains("--split-sum --format r16g16 -o lut.dds"));
    const Outcome run = scratch.run(fmt::format(
        "lobec table {}/models/microfacet.lobe V_SmithGGX --split-sum --format r16g16 -o lut.dds "
        "--size 8x8 --points 64",
        ROOT));
    CAPTURE(run.err);
    CHECK(run.status == 0);
    CHECK(scratch.read("lut.dds").size() == 148 + 8 * 8 * 4);
}
