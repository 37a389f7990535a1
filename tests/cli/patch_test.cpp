// `lobec patch` as a user runs it, on stand-ins for an engine's source tree: what is on the disk
// afterwards, and what it says.
#include "cli/patching.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

using Catch::Contains;
using lobe::engine::Files;
using namespace lobe::tests;
namespace fs = std::filesystem;

namespace {

const std::string shaders = lobe::engine::shaders;

}  // namespace

TEST_CASE("the diff is what git applies, and what --apply does", "[patch]")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    CAPTURE(version);
    const Files tree = lobe::engine::engine_tree(version);
    const Place place{tree};
    const Outcome shown = place.patch("", true);
    CAPTURE(shown.err);
    REQUIRE(shown.status == 0);
    CHECK(place.tree() == tree);
    CHECK_THAT(shown.out,
               Contains("+++ b/" + shaders + "Skin.ush") && Contains("+// BEGIN lobe Skin 1/"));
    CHECK_THAT(shown.err,
               Contains("changed  " + shaders + "ShadingCommon.ush\n") &&
                   Contains("new      " + shaders + "Skin.ush\n") &&
                   Contains("Skin as shading model 12 into an engine " + version + ": "));

    CHECK(place.patch("-o out.patch -q").err.empty());
    CHECK(place.read("out.patch") == shown.out);
    CHECK(place.tree() == tree);
    const Outcome git = place.shell("cd tree && export GIT_CEILING_DIRECTORIES=\"$PWD/..\" && "
                                    "git apply --check ../out.patch && "
                                    "git apply --whitespace=nowarn ../out.patch");
    CAPTURE(git.err);
    REQUIRE(git.status == 0);
    CHECK(place.patch("--check", true).status == 0);

    const Place other{tree};
    const Outcome applied = other.patch("--apply");
    CHECK(applied.status == 0);
    CHECK(applied.out.empty());
    CHECK_THAT(applied.err, Contains("; applied\n"));
    CHECK(other.tree() == place.tree());
}

TEST_CASE("a patched tree is checked, patched again and reverted to the byte", "[patch]")
{
    const auto [version, windows] = GENERATE(table<std::string, bool>(
        {{"4.25", false}, {"4.26", false}, {"4.27", false}, {"4.27", true}}));
    CAPTURE(version, windows);
    const Files lines = lobe::engine::engine_tree(version);
    const Files tree = windows ? lobe::engine::with_crlf(lines) : lines;
    const Place place{tree};
    CHECK(place.patch("--check -q").status == 1);
    REQUIRE(place.patch("--apply", true).status == 0);
    const Files patched = place.tree();
    CHECK(patched.size() > tree.size());
    if (windows)
        for (const auto& [path, text] : patched)
            CHECK(std::ranges::count(text, '\r') == std::ranges::count(text, '\n'));
    const Outcome check = place.patch("--check", true);
    CHECK(check.status == 0);
    CHECK(check.err == "Skin is up to date in the tree\n");

    CHECK(place.patch("--apply").status == 0);
    CHECK(place.tree() == patched);
    CHECK(place.patch().out.empty());

    const Outcome reverted = place.patch("--revert");
    CHECK(reverted.status == 0);
    CHECK_THAT(reverted.err, Contains("removed  " + shaders + "Skin.ush\n") &&
                                 Contains("Skin out of an engine tree: "));
    CHECK(place.tree() == tree);
    const Outcome again = place.patch("--revert");
    CHECK(again.status == 0);
    CHECK(again.err == "nothing of Skin is in the tree\n");
}

TEST_CASE("a changed model is out of date in the tree until it is applied", "[patch]")
{
    const Files tree = lobe::engine::engine_tree("4.27");
    const Place place{tree};
    REQUIRE(place.patch("--apply").status == 0);
    const Files patched = place.tree();
    const std::string changed =
        replaced(replaced(patched_model + engine_block, "1 - 0.5 * x", "1 - 0.25 * x"),
                 "\"Gain\"\n  node", "\"Diffuse Gain\"\n  node");
    place.write("skin.lobe", changed);

    const Outcome stale = place.patch("--check");
    CHECK(stale.status == 1);
    CHECK(stale.out.empty());
    CHECK_THAT(stale.err, Contains("changed  " + shaders + "Skin.ush\n"));
    CHECK(place.tree() == patched);
    CHECK(place.patch("--apply").status == 0);
    CHECK(place.patch("--check").status == 0);
    // As if the earlier one had never been there.
    const Place fresh{tree, changed};
    CHECK(fresh.patch("--apply").status == 0);
    CHECK(fresh.tree() == place.tree());

    // Without its node, the node's file goes.
    place.write("skin.lobe", replaced(patched_model + engine_block,
                                      "  node \"SkinParameters\" { falloff, shine }\n", ""));
    const Outcome without = place.patch("--apply");
    CHECK(without.status == 0);
    CHECK_THAT(without.err, Contains("removed  " + lobe::engine::classes +
                                     "Materials/MaterialExpressionSkinParameters.h\n"));
    CHECK(place.patch("--revert").status == 0);
    CHECK(place.tree() == tree);
}

TEST_CASE("local changes stay, and change the shading model's number", "[patch]")
{
    const Files tree = lobe::engine::fork_tree("4.26");
    const Place place{tree};
    const Outcome applied = place.patch("--apply", true);
    CAPTURE(applied.err);
    CHECK(applied.status == 0);
    CHECK_THAT(applied.err, Contains("Skin as shading model 14 into an engine 4.26"));
    CHECK_THAT(place.read("tree/" + shaders + "ShadingCommon.ush"),
               Contains("SHADINGMODELID_SKIN		14") && Contains("SHADINGMODELID_TOON"));
    // What is changed outside of the regions later is kept by the revert.
    place.edit(shaders + "BRDF.ush", "#pragma once", "#pragma once\n// ours");
    place.edit(shaders + "ShadingModels.ush", "#include \"BRDF.ush\"",
               "#include \"BRDF.ush\"\n// ours");
    CHECK(place.patch("--check").status == 0);
    CHECK(place.patch("--revert").status == 0);
    Files kept = tree;
    for (const std::string name : {"BRDF.ush", "ShadingModels.ush"}) {
        const std::string mark = name == "BRDF.ush" ? "#pragma once" : "#include \"BRDF.ush\"";
        kept[shaders + name] = replaced(kept[shaders + name], mark, mark + "\n// ours");
    }
    CHECK(place.tree() == kept);
}

TEST_CASE("JSON says what was found and done", "[patch]")
{
    const Place place;
    const Outcome shown = place.patch("--json report.json", true);
    CHECK(shown.status == 0);
    CHECK_THAT(shown.out, Contains("diff --git"));
    auto report = nlohmann::json::parse(place.read("report.json"));
    CHECK(report["model"] == "Skin");
    CHECK(report["engine"] == "4.27");
    CHECK(report["values"]["next_id"] == "12");
    CHECK(report["applied"] == false);
    CHECK(report["obstacles"].empty());
    REQUIRE(report["shaders"].size() == 3);
    for (const auto& shader : report["shaders"]) CHECK(shader["result"] == "compiles");
    for (const auto& file : report["files"]) {
        const std::string path = file["path"];
        CHECK_THAT(shown.out, Contains("+++ b/" + path + "\n"));
        CHECK(file["change"] == (fs::exists(place.path("tree/" + path)) ? "changed" : "new"));
    }
    CHECK(place.patch("--apply --json -").status == 0);
    report = nlohmann::json::parse(place.patch("--revert --json -").out);
    CHECK(report["reverts"] == true);
    CHECK(report["applied"] == true);
    CHECK(report["files"].size() > 10);
    // With --json - standard output is JSON alone.
    CHECK(nlohmann::json::parse(place.patch("--json -").out)["model"] == "Skin");
}

TEST_CASE("one of several engine blocks is chosen by its shading model", "[patch]")
{
    std::string other = replaced(engine_block, "\"Skin\"", "\"Nose\"");
    other = replaced(other, "SkinParameters", "NoseParameters");
    const Place place{lobe::engine::engine_tree("4.27"), patched_model + engine_block + other};
    CHECK_THAT(refuses(place, "--apply", 2),
               Contains("skin.lobe has several shading models, choose one with --model: Skin, "
                        "Nose"));
    const Outcome outcome = place.patch("--apply --model Nose", true);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Contains("Nose as shading model 12 into"));

    // Both are in one file, which the patch of the first has brought.
    CHECK_THAT(refuses(place, "--apply --model Skin", 1),
               Contains("error: this file belongs to the patch of another shading model\n  --> " +
                        shaders + "Skin.ush:1\n  = help: revert that one first"));
    CHECK(place.patch("--revert --model Nose").status == 0);
    CHECK(place.patch("--apply --model Skin").status == 0);
}

TEST_CASE("a model of another file is patched in with that file's shaders", "[patch]")
{
    // A layout of one's own for a model that ships.
    const Place place{lobe::engine::engine_tree("4.27"), R"(module game

import callisto { callisto }
import ue4_gbuffer { ue4 }

packing callisto on ue4 {
  d.r = diffuse_fresnel : unorm 8 code power(8, 127/255)
  supports ray_tracing == off
}

engine ue4 for callisto {
  shading_model "Game"
  pin custom_data0 = diffuse_fresnel
}
)"};
    for (const std::string name : {"callisto.lobe", "microfacet.lobe"})
        fs::copy_file(ROOT "/models/" + name, place.path(name));
    const Outcome outcome = place.patch("--apply", true);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, !Contains("warning"));
    CHECK_THAT(place.read("tree/" + shaders + "Callisto.ush"), Contains("CallistoBxDF("));
    CHECK_THAT(place.read("tree/" + shaders + "GamePacking.ush"),
               Contains("#define CALLISTO_PARAMETERS("));
    CHECK_FALSE(fs::exists(place.path("tree/" + shaders + "CallistoPacking.ush")));
    CHECK(place.patch("--check", true).status == 0);
    CHECK(place.patch("--revert").status == 0);
    CHECK(place.tree() == lobe::engine::engine_tree("4.27"));
}

TEST_CASE("the guide tells what the patch of the shipped model does", "[patch]")
{
    std::ifstream in{ROOT "/docs/unreal.md", std::ios::binary};
    const std::string guide{std::istreambuf_iterator<char>{in}, {}};
    for (const auto& file : lobe::engine::shipped_list().files) {
        const std::string name = fs::path{file.path}.filename().string();
        const bool is_source = name == "PixelInspectorResult.cpp";  // named by its ending
        CHECK_THAT(guide, Contains(is_source ? "`PixelInspectorResult.h`, `.cpp`" : name));
    }

    const Place place;
    const Outcome outcome =
        place.shell("lobec patch '" ROOT "/models/callisto.lobe' --engine tree --skip-shaders");
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.err, Contains("18 changed files, 3 new, 0 removed, 29 marked regions"));
    CHECK_THAT(guide, Contains("changes 18 files of a 4.27 tree in 29 places and adds 3"));
    const auto begin = guide.find("// BEGIN lobe");
    const auto end = guide.find("\n```", begin);
    REQUIRE(begin < end);
    std::string region = "+" + guide.substr(begin, end - begin) + "\n";
    for (auto at = region.find('\n'); at + 1 < region.size(); at = region.find('\n', at + 1))
        region.insert(at + 1, "+");
    CHECK_THAT(outcome.out, Contains(region));
}

TEST_CASE("a tree that the stand-ins do not fit is patched with a warning", "[patch]")
{
    const Place place;
    place.edit(shaders + "BRDF.ush", "float3 Diffuse_Lambert",
               "float Foreign(FForeign X)\n{\n\treturn X.Y;\n}\n\nfloat3 Diffuse_Lambert");
    const Outcome outcome = place.patch("--apply --json report.json", true);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Contains("warning: the lighting shader was not checked: our stand-ins "
                                     "do not fit this tree") &&
                                Contains("= glslang: ERROR: BRDF.ush:") && Contains("; applied\n"));
    const auto report = nlohmann::json::parse(place.read("report.json"));
    CHECK(report["shaders"][0]["result"] == "unknown");
    CHECK(report["applied"] == true);
    CHECK(place.patch("--check", true).status == 0);
}
