// `lobec patch` as a user runs it, on stand-ins for an engine's source tree: what is on the disk
// afterwards, what it says, and that nothing is written where something stands in the way.
#include "command.h"
#include "engine/stand_ins.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

using Catch::Contains;
using lobe::engine::Files;
using lobe::tests::Outcome;
using lobe::tests::Scratch;
namespace fs = std::filesystem;

namespace {

const std::string shaders = lobe::engine::shaders;

const std::string model = R"(/// A small model.
module skin

import ue4_gbuffer { ue4 }

tier base

/// Gain of the diffuse light.
param gain : float in [0, 2] = 1  base  "Gain"
/// Width of the lobe.
param falloff : unit = 0.4        base  "Falloff"
/// How much is reflected.
param shine : unit = 0            base  "Shine"

/// Scale of the falloff.
term scale(x: unit) -> float in [0, 1] = 1 - 0.5 * x

/// Light that the surface scatters and reflects.
model skin(g: geometry, s: surface) {
  diffuse  = s.diffuse_color * g.cos_i * gain * scale(falloff)
  specular = s.f0 * g.cos_i * shine
}

packing skin on ue4 {
  d.r       = gain    : unorm 8 code linear(254/255)
  d.g[4..7] = falloff : unorm 4
  d.a       = shine   : unorm 8
  supports ray_tracing == off
}
)";

const std::string block = R"(
engine ue4 for skin {
  shading_model "Skin"
  pin custom_data0 = gain "Gain"
  node "SkinParameters" { falloff, shine }
  color (0.5, 0.25, 0.125)
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// A folder with a model, the GBuffer and an engine's tree.
class Place {
public:
    explicit Place(const Files& tree = lobe::engine::engine_tree("4.27"),
                   const std::string& source = model + block)
    {
        fs::copy_file(ROOT "/models/ue4_gbuffer.lobe", scratch_.path() / "ue4_gbuffer.lobe");
        write("skin.lobe", source);
        for (const auto& [path, text] : tree) write("tree/" + path, text);
    }

    void write(const std::string& name, const std::string& text) const
    {
        fs::create_directories((scratch_.path() / name).parent_path());
        scratch_.write(name, text);
    }

    std::string read(const std::string& name) const { return scratch_.read(name); }
    fs::path path(const std::string& name) const { return scratch_.path() / name; }
    Outcome shell(const std::string& command) const { return scratch_.run(command); }

    /// Most of these tests are not about shaders, whose check takes most of the time.
    Outcome patch(const std::string& options = "", bool check_shaders = false) const
    {
        return shell("lobec patch skin.lobe --engine tree " + options +
                     (check_shaders ? "" : " --skip-shaders"));
    }

    /// All files of the tree as they are now.
    Files tree() const
    {
        Files files;
        const fs::path root = path("tree");
        for (const auto& entry : fs::recursive_directory_iterator{root})
            if (!entry.is_directory()) {
                const std::string name = entry.path().lexically_relative(root).generic_string();
                files[name] = read("tree/" + name);
            }
        return files;
    }

    /// One text for another in a file of the tree.
    void edit(const std::string& name, const std::string& from, const std::string& to) const
    {
        write("tree/" + name, replaced(read("tree/" + name), from, to));
    }

private:
    Scratch scratch_;
};

/// A run that changes nothing and says why. Gives what it says.
std::string refuses(const Place& place, const std::string& options, int status,
                    bool check_shaders = false)
{
    const Files before = place.tree();
    const Outcome outcome = place.patch(options, check_shaders);
    CAPTURE(options, outcome.err);
    CHECK(outcome.status == status);
    CHECK(outcome.out.empty());
    CHECK_FALSE(outcome.err.empty());
    CHECK(place.tree() == before);
    return outcome.err;
}

/// An obstacle, met by the diff, the check and the change alike.
std::string meets_obstacle(const Place& place)
{
    const std::string said = refuses(place, "", 1);
    CHECK(refuses(place, "--apply", 1) == said);
    CHECK(refuses(place, "--check", 1) == said);
    CHECK(refuses(place, "-o out.patch", 1) == said);
    CHECK_FALSE(fs::exists(place.path("out.patch")));
    return said;
}

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
    const std::string changed = replaced(replaced(model + block, "1 - 0.5 * x", "1 - 0.25 * x"),
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
    place.write("skin.lobe",
                replaced(model + block, "  node \"SkinParameters\" { falloff, shine }\n", ""));
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

TEST_CASE("a region that was edited by hand is not overwritten", "[patch]")
{
    const Place place;
    REQUIRE(place.patch("--apply").status == 0);
    place.edit(shaders + "Definitions.usf", "MATERIAL_SHADINGMODEL_SKIN 0",
               "MATERIAL_SHADINGMODEL_SKIN 1");
    const std::string said = meets_obstacle(place);
    CHECK_THAT(said, Contains("error: the generated region in lines ") &&
                         Contains(" was edited by hand\n  --> " + shaders + "Definitions.usf:") &&
                         Contains("= edit: material_define_default\n") &&
                         Contains("= help: undo that edit"));
    CHECK(refuses(place, "--revert", 1) == said);

    // A new file that was edited is another one.
    place.edit(shaders + "Skin.ush", "#pragma once", "#pragma once // ours");
    const std::string both = meets_obstacle(place);
    CHECK_THAT(both, Contains("this generated file was edited by hand\n  --> " + shaders +
                              "Skin.ush:1\n") &&
                         Contains("2 obstacles; nothing was written\n"));
}

TEST_CASE("a patch that is there in half is reverted, then applied", "[patch]")
{
    const Files tree = lobe::engine::engine_tree("4.27");
    const Place place{tree};
    REQUIRE(place.patch("--apply").status == 0);
    const Files patched = place.tree();
    const std::string file = shaders + "ShadingModels.ush";
    place.write("tree/" + file, tree.at(file));
    CHECK_THAT(meets_obstacle(place), Contains("error: a patch of Skin was applied in half: ") &&
                                          Contains("  --> " + file + "\n") &&
                                          Contains("= help: revert it"));
    CHECK(place.patch("--revert").status == 0);
    CHECK(place.tree() == tree);
    CHECK(place.patch("--apply").status == 0);
    CHECK(place.tree() == patched);
}

TEST_CASE("every obstacle is told at once, with its file, anchor and a way out", "[patch]")
{
    const Place place;
    place.edit(shaders + "Definitions.usf", "#ifndef MATERIAL_SINGLE_SHADINGMODEL",
               "#ifndef MATERIAL_ONE_SHADINGMODEL");
    fs::remove(place.path("tree/" + shaders + "TiledDeferredLightShaders.usf"));
    place.edit(shaders + "ShadingCommon.ush", "#define SHADINGMODELID_NUM",
               "#define SHADINGMODELID_SKIN 3\n#define SHADINGMODELID_NUM");
    place.write("tree/" + shaders + "Skin.ush", "// ours\n");
    const fs::path locked = place.path("tree/" + shaders + "BasePassCommon.ush");
    fs::permissions(locked, fs::perms::owner_read | fs::perms::group_read);
    const std::string said = meets_obstacle(place);
    CHECK_THAT(said, Contains("error: the anchor does not hit\n  --> " + shaders +
                              "Definitions.usf\n  = edit: material_define_default\n"
                              "  = anchor: ^[ \\t]*#ifndef[ \\t]+MATERIAL_SINGLE_SHADINGMODEL\\b\n"
                              "  = help: find out what became of that line"));
    CHECK_THAT(said, Contains("error: this file is not in the tree\n  --> " + shaders +
                              "TiledDeferredLightShaders.usf\n  = help: "));
    CHECK_THAT(said, Contains("error: the tree has a shading model of this name: "
                              "`SHADINGMODELID_SKIN` is taken, in line ") &&
                         Contains("  --> " + shaders + "ShadingCommon.ush:"));
    CHECK_THAT(said, Contains("error: the engine has a file of this name already\n  --> " +
                              shaders + "Skin.ush:1\n"));
    CHECK_THAT(said, Contains("error: this file cannot be written: the file is read-only; check "
                              "it out of version control first\n  --> " +
                              shaders + "BasePassCommon.ush\n"));
    CHECK_THAT(said, Contains("the list of edits is templates/ue4/engine.edits\n"
                              "5 obstacles; nothing was written\n"));

    const Outcome json = place.patch("--json -");
    CHECK(json.status == 1);
    CHECK(json.err == said);
    const auto report = nlohmann::json::parse(json.out);
    REQUIRE(report["obstacles"].size() == 5);
    CHECK(report["files"].empty());
    CHECK(report["applied"] == false);
    for (const auto& obstacle : report["obstacles"]) {
        CAPTURE(obstacle.dump());
        CHECK_THAT(obstacle["file"].get<std::string>(), Contains("Engine/Shaders/Private/"));
        CHECK_FALSE(obstacle["help"].get<std::string>().empty());
        CHECK_THAT(said, Contains(obstacle["what"].get<std::string>()));
    }
}

TEST_CASE("a tree that is no engine, or one that is not known, is one obstacle", "[patch]")
{
    const Place empty{Files{{"README", "x\n"}}};
    CHECK_THAT(meets_obstacle(empty), Contains("error: this is no engine's tree: it lacks ") &&
                                          Contains("= help: name the folder that has Engine/") &&
                                          Contains("1 obstacle; nothing was written\n"));
    const Place old;
    old.edit("Engine/Build/Build.version", "27", "24");
    CHECK_THAT(meets_obstacle(old),
               Contains("error: this is engine 4.24\n  --> Engine/Build/Build.version:") &&
                   Contains("patches are known for 4.25 to 4.27"));
}

TEST_CASE("what is wrong with the command itself is exit 2", "[patch]")
{
    const Place place;
    const std::string exclusive = "--apply, --revert, --check and -o exclude each other";
    CHECK_THAT(refuses(place, "--apply --revert", 2), Contains(exclusive));
    CHECK_THAT(refuses(place, "--apply --check", 2), Contains(exclusive));
    CHECK_THAT(refuses(place, "--revert -o out.patch", 2), Contains(exclusive));
    CHECK_THAT(refuses(place, "-o - --json -", 2), Contains("only one of -o, --json"));
    CHECK_THAT(refuses(place, "--model Nose", 2),
               Contains("skin.lobe has no shading model `Nose`; it has Skin"));
    CHECK(place.patch("--model Skin --check -q").status == 1);
    CHECK_THAT(place.shell("lobec patch skin.lobe --engine nowhere").err,
               Contains("nowhere is no folder"));
    CHECK(place.shell("lobec patch skin.lobe --engine nowhere").status == 2);
    CHECK(place.shell("lobec patch skin.lobe").status == 2);
    CHECK(place.shell("lobec patch nothing.lobe --engine tree").status == 2);
    CHECK_THAT(refuses(place, "-o no/such/\"$(printf 'x%.0s' $(seq 300))\"", 2),
               Contains("error: cannot "));

    place.write("skin.lobe", model);
    CHECK_THAT(refuses(place, "--apply", 2),
               Contains("skin.lobe has no `engine` block, so there is nothing to patch"));
    // A model that is wrong is a finding, like everywhere.
    place.write("skin.lobe", replaced(model + block, "scale(falloff)", "scale(fallof)"));
    CHECK_THAT(refuses(place, "--apply", 1), Contains("`fallof`"));
}

TEST_CASE("what a packing asks of an engine that cannot do it is refused", "[patch]")
{
    // GBufferF's alpha is written by a pass of its own from 4.26 on.
    const std::string source =
        replaced(replaced(replaced(model + block, "d.a       = shine   : unorm 8",
                                   "f.a       = shine   : unorm 8"),
                          "ray_tracing == off",
                          "ray_tracing == off\n  supports version == v4_26, v4_27\n  supports "
                          "anisotropic_materials == on\n  supports anisotropic_platform == yes\n  "
                          "supports format == force8, standard\n  without "
                          "anisotropy"),
                 "node \"SkinParameters\" { falloff, shine }",
                 "pin anisotropy = shine \"Shine\"\n  node \"SkinParameters\" { falloff }");
    const Place old{lobe::engine::engine_tree("4.25"), source};
    CHECK_THAT(meets_obstacle(old),
               Contains("4.25 writes GBufferF in the base pass") &&
                   Contains("error: this is engine 4.25, and the packing supports 4.26, 4.27\n"
                            "  = help: widen `supports version` in the packing"));
    const Place place{lobe::engine::engine_tree("4.26"), source};
    const Outcome outcome = place.patch("--apply", true);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
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

TEST_CASE("a change that was interrupted is finished before anything else", "[patch]")
{
    const Files tree = lobe::engine::engine_tree("4.27");
    const Place done{tree};
    REQUIRE(done.patch("--apply").status == 0);
    const Files patched = done.tree();

    // As a kill behind the first of the files leaves it.
    const Place place{tree};
    std::string journal = "lobec journal 1\n";
    int steps = 0;
    for (const auto& [path, text] : patched) {
        const auto before = tree.find(path);
        if (before != tree.end() && before->second == text) continue;
        journal += "put " + place.path("tree/" + path).string() + "\n";
        place.write("tree/" + path + (++steps == 1 ? "" : ".lobec-new"), text);
    }
    REQUIRE(steps > 10);
    place.write("tree/.lobec-journal", journal + "end\n");

    for (const std::string options : {"", "--check", "-o out.patch"})
        CHECK_THAT(refuses(place, options, 2),
                   Contains("a change of tree was interrupted; run `lobec patch` with --apply"));
    const Outcome applied = place.patch("--apply");
    CHECK(applied.status == 0);
    CHECK(applied.err == "Skin is up to date in the tree\n");
    CHECK(place.tree() == patched);

    place.write("tree/.lobec-journal", "something else\n");
    CHECK_THAT(refuses(place, "--apply", 2), Contains("is no journal of lobec"));
}

TEST_CASE("a folder in the place of a new file leaves the tree as it was", "[patch]")
{
    const Place place;
    fs::create_directories(place.path("tree/" + shaders + "Skin.ush"));
    CHECK_THAT(refuses(place, "--apply", 2),
               Contains("Skin.ush stands where a file has to be; the tree is as it was"));
}

TEST_CASE("one of several engine blocks is chosen by its shading model", "[patch]")
{
    std::string other = replaced(block, "\"Skin\"", "\"Nose\"");
    other = replaced(other, "SkinParameters", "NoseParameters");
    const Place place{lobe::engine::engine_tree("4.27"), model + block + other};
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

TEST_CASE("a patch whose shaders do not compile is refused", "[patch]")
{
    const Place place;
    place.edit(shaders + "BRDF.ush", "float3 Diffuse_Lambert",
               "float Skin_Scale( float X )\n{\n\treturn X;\n}\n\nfloat3 Diffuse_Lambert");
    for (const std::string options : {"", "--apply", "--check"}) {
        const std::string said = refuses(place, options, 1, true);
        CHECK_THAT(said, Contains("error: the patched lighting shader does not compile, and the "
                                  "tree's own does\n  = glslang: ERROR: ") &&
                             Contains("Skin_Scale") && Contains("nothing was written\n"));
    }
    const auto report = nlohmann::json::parse(place.patch("--json -", true).out);
    CHECK(report["shaders"][0]["result"] == "broken");
    CHECK(place.patch("--apply").status == 0);
    // In a tree that has it already the check says so too, and the revert asks no shader.
    CHECK(place.patch("--check", true).status == 1);
    CHECK(place.patch("--revert", true).status == 0);
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
