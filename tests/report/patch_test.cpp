// What `lobec patch` says: every word of it, and JSON whatever bytes a tree has.
#include "report/patch.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace lobe;
using Result = analyze::EngineShaderVerdict::Result;

namespace {

report::PatchReport sample()
{
    report::PatchReport report;
    report.model = "Skin";
    report.plan.version = "4.27";
    report.plan.regions = 3;
    report.plan.read = {{"models", "14"}, {"next_id", "12"}};
    report.plan.changes = {{"Shaders/Common.ush", "a\n", "b\n"},
                           {"Shaders/Old.ush", "a\n", std::nullopt},
                           {"Shaders/Skin.ush", std::nullopt, "b\n"}};
    return report;
}

report::PatchReport refused()
{
    report::PatchReport report;
    report.model = "Skin";
    report.plan.version = "4.26";
    report.plan.obstacles = {
        {"Shaders/Common.ush", 7, "shading_model_id", "^#define NUM\\b", "the anchor does not hit",
         "change the anchor of the edit in line 4 of the list"},
        {"Source/Types.h", 0, "", "", "this file cannot be written", "check it out"},
        {"", 0, "", "", "this is no engine's tree", "name the folder that has Engine/ in it"}};
    return report;
}

}  // namespace

TEST_CASE("a patch is summed up by file", "[patch]")
{
    report::PatchReport report = sample();
    CHECK(report.ok());
    CHECK(report::patch_obstacles(report, {}).empty());
    CHECK(report::patch_shaders(report, {}).empty());
    const std::string files = "changed  Shaders/Common.ush\n"
                              "removed  Shaders/Old.ush\n"
                              "new      Shaders/Skin.ush\n";
    CHECK(report::patch_summary(report, {}) ==
          files + "Skin as shading model 12 into an engine 4.27: 1 changed file, 1 new, 1 removed, "
                  "3 marked regions\n");
    report.applied = true;
    report.plan.regions = 1;
    report.plan.changes[1].after = "c\n";
    CHECK(report::patch_summary(report, {}) ==
          "changed  Shaders/Common.ush\n"
          "changed  Shaders/Old.ush\n"
          "new      Shaders/Skin.ush\n"
          "Skin as shading model 12 into an engine 4.27: 2 changed files, 1 new, 0 removed, "
          "1 marked region; applied\n");
    CHECK(report::patch_summary(report, {.color = true, .width = 0}).find("\x1b[") !=
          std::string::npos);

    report = sample();
    report.reverts = true;
    report.plan.version.clear();
    CHECK(report::patch_summary(report, {}) ==
          files + "Skin out of an engine tree: 1 changed file, 1 new, 1 removed\n");
    report.plan.changes.clear();
    CHECK(report::patch_summary(report, {}) == "nothing of Skin is in the tree\n");
    report.reverts = false;
    CHECK(report::patch_summary(report, {}) == "Skin is up to date in the tree\n");
}

TEST_CASE("obstacles say where, what was looked for and what to do", "[patch]")
{
    report::PatchReport report = refused();
    CHECK_FALSE(report.ok());
    CHECK(report::patch_obstacles(report, {}) ==
          "error: the anchor does not hit\n"
          "  --> Shaders/Common.ush:7\n"
          "  = edit: shading_model_id\n"
          "  = anchor: ^#define NUM\\b\n"
          "  = help: change the anchor of the edit in line 4 of the list\n"
          "\n"
          "error: this file cannot be written\n"
          "  --> Source/Types.h\n"
          "  = help: check it out\n"
          "\n"
          "error: this is no engine's tree\n"
          "  = help: name the folder that has Engine/ in it\n"
          "\n"
          "the list of edits is templates/ue4/engine.edits\n"
          "3 obstacles; nothing was written\n");
    report.plan.obstacles.erase(report.plan.obstacles.begin(), report.plan.obstacles.end() - 1);
    CHECK(report::patch_obstacles(report, {}) ==
          "error: this is no engine's tree\n"
          "  = help: name the folder that has Engine/ in it\n"
          "\n"
          "1 obstacle; nothing was written\n");
}

TEST_CASE("a broken shader is an error, one that is not known a warning", "[patch]")
{
    report::PatchReport report = sample();
    report.shaders = {{"lighting", Result::compiles, ""},
                      {"base pass", Result::unknown, "ERROR: A.ush:1: 'x' : unknown"}};
    const std::string warning =
        "warning: the base pass shader was not checked: our stand-ins do not fit this tree, whose "
        "own does not compile with them either\n"
        "  = glslang: ERROR: A.ush:1: 'x' : unknown\n";
    CHECK(report.ok());
    CHECK(report::patch_shaders(report, {}) == warning);

    report.shaders[0] = {"lighting", Result::broken, "ERROR: B.ush:2: 'y' : redefinition"};
    CHECK_FALSE(report.ok());
    CHECK(report::patch_shaders(report, {}) ==
          "error: the patched lighting shader does not compile, and the tree's own does\n"
          "  = glslang: ERROR: B.ush:2: 'y' : redefinition\n"
          "  = help: --skip-shaders makes the patch all the same\n" +
              warning + "\nnothing was written\n");
}

TEST_CASE("the patch as JSON, to the byte", "[patch]")
{
    report::PatchReport report = sample();
    report.applied = true;
    report.shaders = {{"lighting", Result::compiles, ""}};
    CHECK(report::patch_json(report) == R"({
  "model": "Skin",
  "engine": "4.27",
  "reverts": false,
  "applied": true,
  "regions": 3,
  "values": {
    "models": "14",
    "next_id": "12"
  },
  "files": [
    {
      "path": "Shaders/Common.ush",
      "change": "changed"
    },
    {
      "path": "Shaders/Old.ush",
      "change": "removed"
    },
    {
      "path": "Shaders/Skin.ush",
      "change": "new"
    }
  ],
  "obstacles": [],
  "shaders": [
    {
      "shader": "lighting",
      "result": "compiles",
      "message": ""
    }
  ]
}
)");
}

TEST_CASE("bytes of a tree that are no UTF-8 are replaced in JSON", "[patch]")
{
    report::PatchReport report = refused();
    report.plan.obstacles[0].what = "`\xff\xfe\"` is taken";
    report.shaders = {{"lighting", Result::broken, "ERROR: '\xc3' : unknown"}};
    const auto json = nlohmann::json::parse(report::patch_json(report));
    CHECK(json["obstacles"][0]["what"] == "`\xef\xbf\xbd\xef\xbf\xbd\"` is taken");
    CHECK(json["obstacles"][0]["line"] == 7);
    CHECK(json["obstacles"][0]["anchor"] == "^#define NUM\\b");
    CHECK(json["shaders"][0]["message"] == "ERROR: '\xef\xbf\xbd' : unknown");
    CHECK(json["shaders"][0]["result"] == "broken");
    CHECK(json["files"].empty());
}
