// `lobec pack`: what it shows of a packing, what it searches for, and what it says to bad requests.
#include "command.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sstream>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;

namespace {

const std::string model = R"(/// A small model and the GBuffer of a small engine.
module skin

tier base, more

/// Gain of the diffuse light.
param gain : float in [0, 4] = 1  base  "Gain"
/// Width of the lobe.
param falloff : unit = 0.5        base  "Falloff"
/// How much is reflected.
param shine : unit = 0            more  "Shine"
/// Color of the light.
param tint : color = (1, 1, 1)    base  "Tint"

/// Engine of the test.
gbuffer small {
  setting lighting "r.Lighting" : baked, moving = baked
  target d "Custom" {
    format unorm 8
    channel r "Custom.x" { field "GBuffer.Custom.x" }
    channel g "Custom.y" { field "GBuffer.Custom.y" }
  }
  target e "Extra" {
    format unorm 8
    channel r "Metal" {
      field "GBuffer.Metal"
      holds metal "metalness" lent
    }
    channel g "Normal" { holds normal "the normal" }
  }
}

/// Light that the surface scatters and reflects.
model skin(g: geometry, s: surface) {
  diffuse  = s.diffuse_color * tint * g.cos_i * gain * (1 - falloff * 0.5)
  specular = s.f0 * g.cos_i * shine
}
)";

std::string packed(const std::string& requirements = "")
{
    return model +
           "\npacking skin on small {\n"
           "  d.r[2..7] = gain : unorm 6 code linear(16/63)\n"
           "  d.g[4..7] = falloff : unorm 4 in [0, 0.9375]\n"
           "  d.g[0..2] = shine : unorm 3\n" +
           requirements + "}\n";
}

/// Fewer points than the default: these tests are about words.
const std::string quick = " --points 2048";

std::size_t longest_line(const std::string& text)
{
    std::istringstream in{text};
    std::size_t longest = 0;
    for (std::string line; std::getline(in, line);) longest = std::max(longest, line.size());
    return longest;
}

/// A request that is refused with exit 2, one message, and nothing written.
void refuses(const std::string& options, const std::string& message,
             const std::string& source = packed())
{
    const Scratch scratch;
    scratch.write("skin.lobe", source);
    const Outcome outcome = scratch.run("lobec pack skin.lobe --json out.json " + options + quick);
    CAPTURE(options, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains(message));
    CHECK(outcome.out.empty());
    CHECK(scratch.entries() == 1);
}

}  // namespace

TEST_CASE("pack shows the layout, the fields and the errors", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed("  require radiance error < 300%\n"));
    const Outcome outcome = scratch.run("lobec pack skin.lobe" + quick);
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.err.empty());
    CHECK_THAT(outcome.out, Contains("  +-----------+---+-------+-+-----+\n"
                                     "  |   gain    | . |falloff|.|shine|\n"
                                     "  +-----------+---+-------+-+-----+\n"));
    CHECK_THAT(outcome.out, Contains("|     metal     |    normal     |"));
    CHECK_THAT(outcome.out, Contains("3 of 16 free bits left: d.r[0..1], d.g[3]"));
    CHECK_THAT(outcome.out,
               Contains("gain     d.r[2..7]  linear(16/63)     17  [0, 4]       1 -> 1 "
                        "     0.25 at 0"));
    CHECK_THAT(outcome.out, Contains("all together      13") && Contains(" stored as "));
    CHECK(longest_line(outcome.out.substr(0, outcome.out.find("\nfield"))) <= 80);
    // The same again: nothing depends on the number of threads.
    CHECK(scratch.run("lobec pack skin.lobe -j 3" + quick).out == outcome.out);
}

TEST_CASE("pack writes JSON, SVG and a page", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed());
    const Outcome outcome =
        scratch.run("lobec pack skin.lobe --json out.json --svg out.svg --html out.html" + quick);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    const auto json = nlohmann::json::parse(scratch.read("out.json"));
    CHECK(json["packings"][0]["fields"][0]["codes"] == 17);
    CHECK(json["packings"][0]["errors"]["whole"]["worst"] > 0.1);
    CHECK_THAT(scratch.read("out.svg"), Contains("<svg xmlns=") && Contains(">gain<"));
    CHECK_THAT(scratch.read("out.html"), Contains("<html") && Contains(">gain<"));

    const Outcome piped = scratch.run("lobec pack skin.lobe --json -" + quick);
    CHECK(piped.status == 0);
    CHECK(piped.out == scratch.read("out.json"));
    CHECK(scratch.run("lobec pack skin.lobe -q" + quick).out.empty());
}

TEST_CASE("a radiance requirement that is not met is refused by every command", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed("  require radiance error < 40%\n"));
    const Outcome shown = scratch.run("lobec pack skin.lobe" + quick);
    CHECK(shown.status == 1);
    CHECK_THAT(shown.out, Contains("all together"));
    CHECK_THAT(shown.err, Contains("error[E0612]") && Contains("asks for less than 40 %"));

    for (const char* command : {"build skin.lobe -o out", "check skin.lobe",
                                "verify skin.lobe --judges-only --json out.json"}) {
        const Outcome outcome = scratch.run(fmt::format("lobec {}", command));
        CAPTURE(command, outcome.err);
        CHECK(outcome.status == 1);
        CHECK_THAT(outcome.err, Contains("error[E0612]"));
        CHECK(scratch.entries() == 1);
    }
}

TEST_CASE("a packing that does not check gives diagnostics and nothing else", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed("  e.g = tint.r : unorm 8\n"));
    for (const char* options : {"", " --suggest"}) {
        const Outcome outcome =
            scratch.run(fmt::format("lobec pack skin.lobe --json out.json{}", options));
        CHECK(outcome.status == 1);
        CHECK(outcome.out.empty());
        CHECK_THAT(outcome.err, Contains("error[E0604]"));
        CHECK(scratch.entries() == 1);
    }
}

TEST_CASE("--suggest prints a packing that checks when it is pasted", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed());
    const Outcome outcome =
        scratch.run("lobec pack skin.lobe --suggest --json out.json --html out.html" + quick);
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("skin on small, suggested"));
    CHECK_THAT(outcome.out, Contains("worst error, % at bits"));
    CHECK_THAT(outcome.out, Contains("8 linear bits for each, 24 bits"));
    CHECK_THAT(outcome.out, Contains("the packing in the source, 13 bits"));
    CHECK_THAT(outcome.out, Contains("to gain more, give up") && Contains("`without metal`"));
    CHECK_THAT(outcome.out, Contains("worst radiance error by bits"));

    const std::string text = [&] {
        const std::size_t begin = outcome.out.find("\npacking skin on small {");
        return outcome.out.substr(begin, outcome.out.find("\n}\n", begin) + 3 - begin);
    }();
    scratch.write("skin.lobe", model + text);
    const Outcome pasted = scratch.run("lobec pack skin.lobe --json pasted.json" + quick);
    CAPTURE(pasted.err);
    REQUIRE(pasted.status == 0);
    const auto json = nlohmann::json::parse(scratch.read("out.json"));
    const auto again = nlohmann::json::parse(scratch.read("pasted.json"));
    CHECK(again["packings"][0]["errors"] == json["packings"][0]["errors"]);
    CHECK(again["packings"][0]["layout"] == json["packings"][0]["layout"]);
    CHECK(json["packings"][0]["suggestion"]["text"].get<std::string>().find("packing skin") !=
          std::string::npos);
}

TEST_CASE("--suggest keeps to the parameters, channels and bits it is given", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed());
    const auto search = [&](const std::string& options) {
        const Outcome outcome =
            scratch.run("lobec pack skin.lobe --suggest --json - " + options + quick);
        CAPTURE(options, outcome.err);
        REQUIRE(outcome.status == 0);
        return nlohmann::json::parse(outcome.out)["packings"][0];
    };
    const auto names = [](const nlohmann::json& packing) {
        std::string out;
        for (const auto& field : packing["fields"]) out += field["name"].get<std::string>() + " ";
        return out;
    };
    const auto channels = search("--parameters gain,shine --channels d.g");
    CHECK(channels["layout"]["bits"] == 8);
    CHECK_THAT(names(channels), Contains("gain") && Contains("shine") && !Contains("falloff"));
    const auto bits = search("--tier base --bits 9");
    CHECK(bits["layout"]["bits"] == 9);
    CHECK_THAT(names(bits), Contains("gain") && Contains("falloff") && !Contains("shine"));
    const auto taken = search("--without metal");
    CHECK(taken["layout"]["bits"] == 24);
    // Fewest bits for an error: fewer than there are, and below it.
    const auto fewest = search("--max-error 60%");
    CHECK(fewest["errors"]["whole"]["worst"] < 0.6);
    CHECK(fewest["layout"]["bits_left"] > 0);
}

TEST_CASE("--suggest packs a model that no packing names", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", model);
    const Outcome outcome = scratch.run("lobec pack skin.lobe --suggest --on small" + quick);
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("packing skin on small {") && Contains("= gain ") &&
                                Contains("= falloff ") && Contains("= shine ") &&
                                !Contains("= tint "));
}

TEST_CASE("--suggest says when nothing fits", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed());
    const Outcome outcome =
        scratch.run("lobec pack skin.lobe --suggest --max-error 0.001% --json out.json" + quick);
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.out, Contains("give up"));
    const auto json = nlohmann::json::parse(scratch.read("out.json"));
    CHECK(json["ok"] == false);
}

TEST_CASE("a file without a packing", "[pack]")
{
    refuses("", "no packing in skin.lobe", model);
    refuses("--packing skn", "no packing of a model `skn`; did you mean `skin`?");
}

TEST_CASE("names that pack does not know", "[pack]")
{
    refuses("--suggest --parameters gain,shin", "no parameter `shin`; did you mean `shine`?");
    refuses("--suggest --tier bse", "no tier `bse`; did you mean `base`?");
    refuses("--suggest --channels d.x", "no channel `d.x`; did you mean `d.r`?");
    refuses("--suggest --channels e.r", "channel `e.r` is not free");
    refuses("--suggest --without mettal", "did you mean `metal`?");
    refuses("--suggest --on smal", "no gbuffer `smal`; did you mean `small`?");
    refuses("--suggest --packing skn", "no model `skn`; did you mean `skin`?");
}

TEST_CASE("requests that make no sense", "[pack]")
{
    refuses("--suggest --bits 0", "--bits");
    refuses("--suggest --bits 17", "more than the 16 there are");
    refuses("--suggest --max-error 0.1", "takes a percentage above 0");
    refuses("--suggest --max-error 0%", "takes a percentage above 0");
    refuses("--suggest --tier base --parameters gain", "--parameters");
    refuses("--bits 8", "--bits only says something to --suggest");
    refuses("--html - --svg -", "only one of");
}

TEST_CASE("an output that cannot be written leaves nothing", "[pack]")
{
    const Scratch scratch;
    scratch.write("skin.lobe", packed());
    const Outcome outcome =
        scratch.run("lobec pack skin.lobe --json out.json --svg skin.lobe/out.svg" + quick);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("error: cannot"));
    CHECK(scratch.entries() == 1);
}
