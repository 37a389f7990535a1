// What `lobec patch` refuses, and that nothing is written then: trees that something stands in the
// way of, and commands that are wrong.
#include "cli/patching.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using Catch::Contains;
using lobe::engine::Files;
using namespace lobe::tests;
namespace fs = std::filesystem;

namespace {

const std::string shaders = lobe::engine::shaders;

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

    place.write("skin.lobe", patched_model);
    CHECK_THAT(refuses(place, "--apply", 2),
               Contains("skin.lobe has no `engine` block, so there is nothing to patch"));
    // A model that is wrong is a finding, like everywhere.
    place.write("skin.lobe",
                replaced(patched_model + engine_block, "scale(falloff)", "scale(fallof)"));
    CHECK_THAT(refuses(place, "--apply", 1), Contains("`fallof`"));
}

TEST_CASE("what a packing asks of an engine that cannot do it is refused", "[patch]")
{
    // GBufferF's alpha is written by a pass of its own from 4.26 on.
    const std::string source =
        replaced(replaced(replaced(patched_model + engine_block, "d.a       = shine   : unorm 8",
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
