// `lobec scene`, `lobec specialize` and `lobec ladder` as a user runs them: what they say, what
// they write, and that bad input leaves nothing behind.
#include "command.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;
using nlohmann::json;

namespace {

const std::string scenes = std::string{ROOT} + "/tests/data/scenes/";
const std::string callisto = std::string{ROOT} + "/models/callisto.lobe";

Outcome scene(const Scratch& scratch, const std::string& rest)
{
    return scratch.run("lobec scene " + rest + " --model " + callisto);
}

Outcome specialize(const Scratch& scratch, const std::string& rest)
{
    return scratch.run("lobec specialize " + callisto + " --cache kept --scene " + rest);
}

/// Compares with a file of tests/cli/golden; with LOBE_REWRITE set it is written instead.
void check_golden(const std::string& name, const std::string& text)
{
    const std::string path = std::string{ROOT} + "/tests/cli/golden/" + name;
    if (std::getenv("LOBE_REWRITE") != nullptr) std::ofstream{path, std::ios::binary} << text;
    std::ifstream in{path, std::ios::binary};
    const std::string expected{std::istreambuf_iterator<char>{in}, {}};
    CHECK(text == expected);
}

/// A scene of these materials and no geometry.
std::string document(const json& materials)
{
    return json{{"asset", {{"version", "2.0"}}}, {"materials", materials}}.dump();
}

json material(const json& parameters)
{
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
            {"extras", {{"lobe", {{"parameters", parameters}}}}}};
}

/// The line of a report that has what a run took is not the same twice.
std::string without_times(const std::string& text) { return text.substr(0, text.find("time ")); }

/// The line that starts so.
std::string line_of(const std::string& text, const std::string& start)
{
    const auto at = text.find(start);
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

}  // namespace

TEST_CASE("scene prints the facts")
{
    const Scratch scratch;
    scratch.run("cp " + scenes + "mixed.gltf " + scenes + "sphere.bin .");
    const Outcome text = scene(scratch, "mixed.gltf");
    CAPTURE(text.err);
    REQUIRE(text.status == 0);
    check_golden("mixed_scene.txt", text.out);
    const Outcome data = scene(scratch, "mixed.gltf --json -");
    REQUIRE(data.status == 0);
    check_golden("mixed_scene.json", data.out);
}

TEST_CASE("scene tells ranges of textures and of what the game sets")
{
    const Scratch scratch;
    const Outcome outcome = scene(scratch, scenes + "textured.gltf --json -");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const json all = json::parse(outcome.out);
    const json& moss = all[0]["materials"][1];
    CHECK(moss["inputs"]["smooth_terminator"]["low"][0] == -0.25);
    CHECK(moss["inputs"]["smooth_terminator"]["high"][0] == 0.5);
    CHECK(moss["inputs"]["retroreflection"]["low"][0] >= 1);
    CHECK(moss["inputs"]["retroreflection"]["high"][0] <= 5);
    CHECK(moss["calls"] == json{"Retroreflection", "Smooth Terminator"});
    CHECK(all[0]["materials"][0]["calls"].empty());
}

TEST_CASE("scene takes another model, and says which there are")
{
    const Scratch scratch;
    const Outcome other = scratch.run("lobec scene " + scenes + "base_only.gltf --model " +
                                      callisto + ":callisto_lambert");
    CHECK(other.status == 0);
    CHECK_THAT(other.out, Contains("under model callisto_lambert of callisto"));
    const Outcome none = scratch.run("lobec scene " + scenes + "base_only.gltf --model " +
                                     callisto + ":callisto_lamber");
    CHECK(none.status == 2);
    CHECK_THAT(none.err, Contains("did you mean `callisto_lambert`?"));
}

TEST_CASE("what the model does not take is told at its pointer, and nothing is written")
{
    const Scratch scratch;
    scratch.write("bad.gltf", document({material({{"retroreflection", 300}}),
                                        material({{"retroreflecton", 1}})}));
    const int before = scratch.entries();
    const Outcome outcome = specialize(scratch, "bad.gltf -o out --json all.json");
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err ==
          "bad.gltf#/materials/0/extras/lobe/parameters/retroreflection: error: 300 is outside of "
          "[0, 256]\n"
          "  help: `retroreflection` is declared in [0, 256]; its default is 1\n"
          "bad.gltf#/materials/1/extras/lobe/parameters/retroreflecton: error: `callisto` has no "
          "parameter `retroreflecton`\n"
          "  help: did you mean `retroreflection`?\n");
    CHECK(scratch.entries() == before);
}

TEST_CASE("scenes that are none are refused with nothing written")
{
    const Scratch scratch;
    const std::vector<std::string> texts{
        "",
        "{",
        "[]",
        "{\"asset\":{\"version\":\"1.0\"}}",
        document(json::array()),
        R"({"asset":{"version":"2.0"},"materials":[{"pbrMetallicRoughness":{"metallicFactor":1e999}}]})",
        R"({"asset":{"version":"2.0"},"materials":[{}],"extensionsRequired":["VENDOR_magic"]})",
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"gone.bin"}]})"};
    for (const std::string& text : texts) {
        scratch.write("bad.gltf", text);
        const int before = scratch.entries();
        const Outcome outcome = specialize(scratch, "bad.gltf -o out");
        CAPTURE(text, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains("error: "));
        CHECK(scratch.entries() == before);
    }
    CHECK(specialize(scratch, "nowhere.gltf -o out").status == 2);
    CHECK(specialize(scratch, "bad.gltf --epsilon tiny").status == 2);
    CHECK(specialize(scratch, "bad.gltf --variants 0").status == 2);
}

TEST_CASE("a scene of the base alone gives the base, certified")
{
    const Scratch scratch;
    const Outcome outcome = specialize(
        scratch, scenes + "base_only.gltf -o out -t glsl450 --points 512 --certificate c.json");
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    const std::string shader = scratch.read("out/callisto_base/glsl450/callisto_base.glsl");
    CHECK_THAT(shader, Contains("lobec specialize callisto.lobe --scene base_only.gltf"));
    CHECK_THAT(shader, Contains("For base_only.gltf: 3 of 3 materials, all of the picture: clay, "
                                "plastic, copper."));
    CHECK_THAT(shader, Contains("Off, and not in the code: Diffuse Fresnel, Retroreflection"));
    CHECK_THAT(shader, !Contains("parameters"));
    const json certificate = json::parse(scratch.read("c.json"));
    CHECK(certificate["ok"] == true);
    REQUIRE(certificate["shaders"][0]["outputs"].size() == 3);
    CHECK(certificate["shaders"][0]["outputs"][2]["output"] == "under directional");
    for (const json& output : certificate["shaders"][0]["outputs"]) {
        CHECK(output["same_graph"] == true);
        CHECK(output["outside"] == 0);
        CHECK(output["points"] == 128);  // a quarter of them: both are one graph
    }
}

TEST_CASE("a mixed scene gives a shader for each set of effects, or as many as asked for")
{
    const Scratch scratch;
    const std::string fast = " -t glsl450 --no-certificate --json all.json -o ";
    const Outcome all = specialize(scratch, scenes + "mixed.gltf" + fast + "all");
    CAPTURE(all.out, all.err);
    REQUIRE(all.status == 0);
    const json shaders = json::parse(scratch.read("all.json"))["shaders"];
    CHECK(shaders.size() == 6);
    for (const json& shader : shaders) {
        CHECK(shader["materials"].size() == 1);
        CHECK(shader["off"].size() >= 4);
    }
    CHECK_THAT(scratch.read("all/callisto_retroreflection/glsl450/callisto_retroreflection.glsl"),
               Contains("On: Retroreflection (retroreflection = 3, dust)."));

    const Outcome two = specialize(scratch, scenes + "mixed.gltf --variants 2" + fast + "two");
    REQUIRE(two.status == 0);
    const json few = json::parse(scratch.read("all.json"));
    CHECK(few["shaders"].size() == 2);
    CHECK(few["proved_cheapest"] == true);
    std::size_t served = 0;
    for (const json& shader : few["shaders"]) served += shader["materials"].size();
    CHECK(served == 6);
}

TEST_CASE("the same scene gives the same files, whatever the number of threads")
{
    const Scratch scratch;
    const std::string rest =
        scenes + "mixed.gltf --points 128 --no-execution --json all.json -t ue4,glsl450 -o out";
    const Outcome one = specialize(scratch, rest + " -j 1");
    REQUIRE(one.status == 0);
    const std::string before = scratch.read("all.json");
    const Outcome four = specialize(scratch, rest + " -j 4");
    REQUIRE(four.status == 0);
    CHECK(scratch.read("all.json") == before);
    CHECK_THAT(four.out, Contains(": 0 written,"));
    CHECK(without_times(one.out).substr(0, one.out.find("files of")) ==
          without_times(four.out).substr(0, four.out.find("files of")));
}

TEST_CASE("per material the surface is in the shader")
{
    const Scratch scratch;
    const Outcome outcome =
        specialize(scratch, scenes + "base_only.gltf --per-material --no-certificate -t glsl450 "
                                     "-o out");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(scratch.read("out/callisto_clay/glsl450/callisto_clay.glsl"),
               Contains("Constants: diffuse_color = (0.6, 0.3, 0.2)") &&
                   !Contains("Surface surface"));
}

TEST_CASE("an epsilon drops what it may, and the banner has the bound")
{
    const Scratch scratch;
    scratch.write("faint.gltf", document(json::array({material({{"retroreflection", 1.0001}})})));
    const Outcome kept = specialize(scratch, "faint.gltf --no-certificate -t glsl450 -o kept_out");
    REQUIRE(kept.status == 0);
    CHECK_THAT(scratch.read("kept_out/callisto_retroreflection/glsl450/"
                            "callisto_retroreflection.glsl"),
               Contains("On: Retroreflection"));
    const Outcome outcome = specialize(
        scratch, "faint.gltf --epsilon 0.1% --points 256 -t glsl450 -o out --certificate c.json");
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(scratch.read("out/callisto_base/glsl450/callisto_base.glsl"),
               Contains("Left out for an epsilon of 0.1 %: Retroreflection, which changes"));
    const json dropped = json::parse(scratch.read("c.json"))["shaders"][0]["left_out"];
    REQUIRE(dropped.size() == 1);
    CHECK(dropped[0]["bound"] < 0.001);
    CHECK(dropped[0]["observed"] <= dropped[0]["bound"]);
}

TEST_CASE("what an epsilon does not let go is listed with its bound")
{
    const Scratch scratch;
    json some = material({{"retroreflection", 3}, {"dual_specular_opacity", 0.001}});
    some["pbrMetallicRoughness"]["roughnessFactor"] = 0.4;
    scratch.write("some.gltf", document(json::array({some})));
    const Outcome outcome =
        specialize(scratch, "some.gltf --epsilon 2% --points 64 --no-execution -t glsl450 -o out "
                            "--certificate c.json --html page.html");
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    const json shader = json::parse(scratch.read("c.json"))["shaders"][0];
    CHECK(shader["left_out"].empty());
    const json& kept = shader["kept"];
    REQUIRE(kept.size() == 2);
    CHECK(kept[0]["effect"] == "Retroreflection");
    CHECK(kept[0]["observed"] > 0.02);
    CHECK(kept[0]["bound"] == "inf");  // none is looked for where more was found
    CHECK(kept[1]["effect"] == "Dual Specular");
    CHECK(kept[1]["observed"] < 0.02);
    CHECK(kept[1]["bound"] >= 0.02);
    CHECK_THAT(outcome.out, Contains("changes radiance by more than 2 %") &&
                                Contains("no bound below 2 % is proved"));
    CHECK_THAT(scratch.read("page.html"), Contains("What an epsilon does not let go"));
}

TEST_CASE("layered materials say what shading once is off by")
{
    const Scratch scratch;
    const Outcome outcome = scene(scratch, scenes + "layers.gltf --json all.json");
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("it shows: shade every layer") && Contains("worst of muddy"));
    const json layered = json::parse(scratch.read("all.json"))[0]["layered"];
    REQUIRE(layered["measured"].size() == 1);
    CHECK(layered["not_measured"] == 0);
    const json& muddy = layered["measured"][0];
    CHECK(muddy["layers"] == 2);
    CHECK(muddy["one_shading_is_enough"] == false);
    const double once = muddy["witness"]["shaded_once"];
    const double by_layers = muddy["witness"]["shaded_by_layers"];
    CHECK(muddy["worst"] >= std::abs(once - by_layers) / by_layers * (1 - 0x1p-50));
    CHECK(muddy["witness"]["inputs"].contains("muddy layer 2 weight"));

    const Outcome none = scene(scratch, scenes + "base_only.gltf --json -");
    CHECK(json::parse(none.out)[0]["layered"]["measured"].empty());
}

TEST_CASE("a hundred thousand materials are grouped, not listed")
{
    const Scratch scratch;
    json materials = json::array();
    for (int i = 0; i < 100'000; ++i)
        materials.push_back(material({{"retroreflection", 1 + i % 200}}));
    scratch.write("many.gltf", document(materials));
    const Outcome outcome =
        specialize(scratch, "many.gltf --no-certificate -t glsl450 -o out --json all.json");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const json all = json::parse(scratch.read("all.json"));
    REQUIRE(all["shaders"].size() == 2);
    CHECK(all["facts"]["materials"].size() == 100'000);
    CHECK(all["shaders"][0]["materials"].size() == 99'500);
    CHECK(all["shaders"][1]["materials"].size() == 500);
}

TEST_CASE("the lights of a scene come with its shaders, and no others")
{
    const Scratch scratch;
    const std::string rest = scenes + "lights.gltf --no-certificate -t glsl450 -o ";
    const Outcome outcome = specialize(scratch, rest + "out");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const std::string lights = scratch.read("out/callisto_base/glsl450/callisto_base_lights.glsl");
    CHECK_THAT(lights, Contains("shade_callisto_base_punctual") &&
                           Contains("shade_callisto_base_sphere") && Contains("spot"));
    // The spheres of the scene have no range, and so no window.
    CHECK_THAT(lights, !Contains("float window("));
    CHECK_THAT(lights, Contains("// Lights, lengths in centimeters: capsule (half_length"));
    REQUIRE(
        specialize(scratch, scenes + "base_only.gltf --no-certificate -t glsl450 -o one").status ==
        0);
    CHECK_THAT(scratch.read("one/callisto_base/glsl450/callisto_base_lights.glsl"),
               Contains("shade_callisto_base_directional") && !Contains("sphere"));
    REQUIRE(specialize(scratch, rest + "dark --no-lights").status == 0);
    CHECK(scratch.run("ls dark/*/*/*lights*").status != 0);
}

TEST_CASE("the ladder has a row for each scene, beside the shader for everything")
{
    const Scratch scratch;
    std::string files;
    for (const char* name :
         {"base_only", "retroreflection", "smooth_terminator", "mixed", "everything"})
        files += " " + scenes + name + ".gltf";
    const Outcome outcome = scratch.run("lobec ladder " + callisto + files +
                                        " --cache kept --json all.json --markdown table.md");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const json all = json::parse(scratch.read("all.json"));
    REQUIRE(all["scenes"].size() == 5);
    CHECK(all["scenes"][0]["effects"].empty());
    CHECK(all["scenes"][4]["effects"].size() == 5);
    // Whatever a scene leaves out is no instruction of its shader.
    CHECK(all["scenes"][0]["spirv_instructions"] < all["scenes"][1]["spirv_instructions"]);
    CHECK(all["scenes"][3]["spirv_instructions"] <= all["general"]["spirv_instructions"]);
    CHECK_THAT(scratch.read("table.md"), Contains("| base_only | none |"));
    if (all["general"]["families"].empty()) {
        WARN("RADV is not installed: " << outcome.out);
        return;
    }
    // The figure that is promised: everything against the base alone, on RDNA2.
    const double base = all["scenes"][0]["families"]["rdna2"]["issue_cycles"];
    const double general = all["general"]["families"]["rdna2"]["issue_cycles"];
    CHECK(general / base >= 2);
}

TEST_CASE("a base that a person wrote costs what the scene's does")
{
    const Scratch scratch;
    scratch.run(
        fmt::format("cp {0}/tests/data/residual/base.lobe {0}/models/microfacet.lobe .", ROOT));
    const Outcome outcome = scratch.run("lobec ladder " + callisto + " " + scenes +
                                        "base_only.gltf --beside base.lobe --cache kept --json -");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const json all = json::parse(outcome.out);
    const json& hand = all["references"][0];
    CHECK(all["scenes"][0]["spirv_instructions"] == hand["spirv_instructions"]);
    for (const auto& [family, cost] : hand["families"].items()) {
        const double ratio = all["scenes"][0]["families"][family]["issue_cycles"].get<double>() /
                             cost["issue_cycles"].get<double>();
        CAPTURE(family, ratio);
        CHECK(std::abs(ratio - 1) <= 0.02);
    }
}

TEST_CASE("more shaders per material than anyone wants are refused")
{
    const Scratch scratch;
    json materials = json::array();
    for (int i = 0; i < 1001; ++i)
        materials.push_back(material({{"retroreflection", 2 + i * 0.125}}));
    scratch.write("many.gltf", document(materials));
    const Outcome outcome = specialize(scratch, "many.gltf --per-material -o out");
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("--per-material would make 1001 shaders"));
}

TEST_CASE("a page shows everything without another file")
{
    const Scratch scratch;
    const Outcome outcome = specialize(
        scratch, scenes + "mixed.gltf --points 64 --no-execution -t ue4 -o out --html page.html");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const std::string page = scratch.read("page.html");
    CHECK_THAT(page, Contains("6 materials in 6 shaders") && Contains("The certificate holds.") &&
                         Contains("callisto_dual_specular"));
    CHECK_THAT(page, !Contains("<script src") && !Contains("http://"));
}

TEST_CASE("a report can be piped, one at a time")
{
    const Scratch scratch;
    CHECK(specialize(scratch, scenes + "base_only.gltf --json - --certificate -").status == 2);
    const Outcome outcome =
        specialize(scratch, scenes + "base_only.gltf --no-certificate -o out -t ue4 --json -");
    REQUIRE(outcome.status == 0);
    CHECK(json::parse(outcome.out)["shaders"].size() == 1);
    CHECK(line_of(outcome.out, "time ").empty());
}
