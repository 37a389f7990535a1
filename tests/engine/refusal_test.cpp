// What stands in the way of a patch: everything at once, where it is, and nothing is planned.
#include "engine/regions.h"
#include "engine/tree.h"

#include <catch2/catch.hpp>

#include <vector>

namespace lobe::engine {
namespace {

using Catch::Contains;

/// The small tree with one text for another in one of its files.
Files changed(const std::string& path, const std::string& from, const std::string& to,
              Files files = small_tree())
{
    const auto at = files.at(path).find(from);
    REQUIRE(at != std::string::npos);
    files[path].replace(at, from.size(), to);
    return files;
}

Plan plan_of(const Files& files)
{
    return plan_patch(tree_of(files), small_list(), request_of("Gloss"));
}

/// All obstacles; none has a change beside it, or comes without help.
std::string refused(const Plan& plan)
{
    CHECK(plan.changes.empty());
    for (const Obstacle& obstacle : plan.obstacles) CHECK_FALSE(obstacle.help.empty());
    return shown(plan.obstacles);
}
std::string refused(const Files& files) { return refused(plan_of(files)); }

Files patched() { return applied(small_tree(), plan_of(small_tree())); }

std::string refused_revert(const Files& files)
{
    Request request;
    request.model = "Gloss";
    return refused(plan_revert(tree_of(files), small_list(), request));
}

}  // namespace

TEST_CASE("a tree that is no engine is one obstacle", "[engine][refusal]")
{
    const std::string words = ":0: : this is no engine's tree: it lacks 4 of 4 files: "
                              "Build/Build.version, Shaders/Common.ush, Source/Types.h, "
                              "Source/Pass.cpp\n";
    CHECK(refused(Files{}) == words);
    CHECK(refused(Files{{"README", "x\n"}}) == words);
    CHECK(refused_revert(Files{}) == words);
}

TEST_CASE("of many files that are missing a few are named", "[engine][refusal]")
{
    const EditList list = list_of("file A\nfile B\nfile C\nfile D\nfile E\nfile F\n"
                                  "file G\noptional\n");
    CHECK(refused(plan_patch(tree_of({}), list, request_of("Gloss"))) ==
          ":0: : this is no engine's tree: it lacks 6 of 6 files: A, B, C, D and 2 more\n");
    const Files half = {{"A", ""}, {"B", ""}, {"C", ""}};
    CHECK(plan_patch(tree_of(half), list, request_of("Gloss")).obstacles.size() == 3);
}

TEST_CASE("an engine of another version is one obstacle", "[engine][refusal]")
{
    CHECK(refused(changed("Build/Build.version", "4,\n", "5,\n")) ==
          "Build/Build.version:2: : this is engine 5.27\n");
    CHECK(refused(changed("Build/Build.version", "27", "24")) ==
          "Build/Build.version:2: : this is engine 4.24\n");
    CHECK(refused(changed("Build/Build.version", "Major", "Minor")) ==
          "Build/Build.version:0: : the engine's version cannot be told\n");
}

TEST_CASE("a file that is missing is named beside all else", "[engine][refusal]")
{
    Files files = changed("Shaders/Common.ush", "MODEL_NUM   2", "MODEL_COUNT 2");
    files.erase("Source/Types.h");
    CHECK(refused(files) == "Source/Types.h:0: : this file is not in the tree\n"
                            "Shaders/Common.ush:0: next_id: this value is not there\n"
                            "Shaders/Common.ush:0: id: the anchor does not hit\n");
}

TEST_CASE("a value without its file is one obstacle, wherever it is used", "[engine][refusal]")
{
    const EditList list = list_of("file C\nread id (\\d+)\nat_most 3 id_plus_1 \"room\"\n"
                                  "file D\noptional\nread other (\\d+)\nelse 7\n"
                                  "file A\nedit one \"1\"\nat x\nafter\n| ${id} ${other}\n"
                                  "edit two \"2\"\nat x\nbefore\n| ${id_plus_1}\n");
    Files files = {{"A", "x\n"}};
    CHECK(refused(plan_patch(tree_of(files), list, request_of("Gloss"))) ==
          "C:0: : this file is not in the tree\n");
    files["C"] = "2\n";
    const Plan plan = plan_patch(tree_of(files), list, request_of("Gloss"));
    CHECK_THAT(applied(files, plan).at("A"), Contains("\n2 7\n") && Contains("\n3\n"));
}

TEST_CASE("anchors that are missing or ambiguous are named with their lines", "[engine][refusal]")
{
    const Plan plan = plan_of(changed("Source/Types.h", "M_Num", "M_Count"));
    CHECK(refused(plan) == "Source/Types.h:0: : the enum ends in its count: not found\n"
                           "Source/Types.h:0: enumerator: the anchor does not hit\n");
    CHECK(plan.obstacles[1].anchor == "^\\s*M_Num,");
    CHECK_THAT(plan.obstacles[1].help, Contains("line "));

    CHECK(refused(changed("Source/Types.h", "};\n", "\tM_Num,\n};\n")) ==
          "Source/Types.h:6: : the enum ends in its count: found 2 times, in lines 6 and 7\n"
          "Source/Types.h:6: enumerator: the anchor hits 2 times, in lines 6 and 7; once is "
          "expected\n");
    CHECK(refused(changed("Source/Pass.cpp", "{M_Lit}", "{M_Unlit}")) ==
          "Source/Pass.cpp:2: uses: the anchor hits once, in line 4; at least 2 are expected, "
          "in lines 2-7\n");
}

TEST_CASE("a scope that is missing, ambiguous or open is an obstacle", "[engine][refusal]")
{
    const std::string gone =
        "Source/Pass.cpp:0: uses: the definition that the edit looks in is not there\n";
    const std::string pins = "Source/Pass.cpp:0: pins: the anchor does not hit\n";
    CHECK(refused(changed("Source/Pass.cpp", "void Second", "void Third")) == gone + pins);
    CHECK(refused(changed("Source/Pass.cpp", "             2);\n}", "             2);\n")) == gone);
    CHECK(refused(changed("Source/Pass.cpp", "void Second()\n{",
                          "void Second();\nvoid Fourth()\n{")) == gone);
    CHECK(refused(changed("Source/Pass.cpp", "void First()", "void Second() {}\nvoid First()")) ==
          "Source/Pass.cpp:1: uses: 2 definitions fit the `scope`, in lines 1 and 3\n"
          "Source/Pass.cpp:1: pins: the anchor hits 2 times, in lines 1 and 3; once is expected\n");
}

TEST_CASE("ids that run out are an obstacle", "[engine][refusal]")
{
    CHECK(refused(changed("Shaders/Common.ush", "MODEL_NUM   2", "MODEL_NUM   16")) ==
          "Shaders/Common.ush:3: next_id: there is an id left: `next_id` = 16 should be at most "
          "`mask` = 15\n");
    CHECK(shown(plan_of(changed("Shaders/Common.ush", "MODEL_NUM   2", "MODEL_NUM   15"))
                    .obstacles) == "");
    CHECK_THAT(refused(changed("Shaders/Common.ush", "0xF", "SOME_MASK")),
               Contains("`mask`, which is no number"));
}

TEST_CASE("a name that is taken is an obstacle", "[engine][refusal]")
{
    CHECK(refused(changed("Shaders/Common.ush", "MODEL_LIT   1", "MODEL_GLOSS 1")) ==
          "Shaders/Common.ush:2: : the name of the model: `MODEL_GLOSS` is taken, in line 2\n");
    CHECK(shown(plan_of(changed("Shaders/Common.ush", "#define MODEL_LIT   1",
                                "#define MODEL_LIT   1 // MODEL_GLOSS"))
                    .obstacles) == "");
}

TEST_CASE("a new file never takes the place of someone's", "[engine][refusal]")
{
    Files files = small_tree();
    files["Shaders/Gloss.ush"] = "mine\n";
    CHECK(refused(files) == "Shaders/Gloss.ush:1: : the engine has a file of this name already\n");
    CHECK(refused_revert(files) == "");
    files["Shaders/Gloss.ush"] = "// Gloss.\n// Generated by lobe 0.1 from x.lobe\n";
    CHECK(refused(files) ==
          "Shaders/Gloss.ush:1: : this file was generated, but not put here by a patch\n");
    files = patched();
    files["Shaders/Gloss.ush"] += "mine\n";
    CHECK(refused(files) == "Shaders/Gloss.ush:1: : this generated file was edited by hand\n");
    CHECK(refused_revert(files) ==
          "Shaders/Gloss.ush:1: : this generated file was edited by hand\n");
}

TEST_CASE("a mark cannot name a file outside of the tree", "[engine][refusal]")
{
    // Hashes as whoever writes such a mark would give them.
    LineHash content;
    content.add("x");
    const std::string victim = "// lobe Gloss new " + content.text() + "\nx\n";
    for (const std::string path : {"../x", "/x", "a/../../x", "a/.."}) {
        NewRegion region;
        region.model = "Gloss";
        region.name = "id";
        region.number = region.total = 1;
        region.new_files = {path};
        Lines text;
        write_region(region, text.lines);
        const Files files = {{"F", to_bytes(text)}, {path, victim}, {"a/x..", victim}};
        const Plan plan = plan_revert(tree_of(files), list_of("file F\n"), request_of("Gloss"));
        REQUIRE(plan.changes.size() == 1);
        CHECK(plan.changes[0].path == "F");
    }
}

TEST_CASE("a patch that is there in half is an obstacle, and can be reverted", "[engine][refusal]")
{
    Files files = patched();
    files["Source/Pass.cpp"] = small_tree().at("Source/Pass.cpp");
    CHECK(refused(files) ==
          "Source/Pass.cpp:0: : a patch of Gloss was applied in half: there are 4 of 7 regions; "
          "these files lack theirs: Source/Pass.cpp\n");
    Request request;
    request.model = "Gloss";
    const Plan back = plan_revert(tree_of(files), small_list(), request);
    CHECK(applied(files, back) == small_tree());

    // A new file is no region: it comes back by itself.
    files = patched();
    files.erase("Shaders/Gloss.ush");
    CHECK(applied(files, plan_of(files)) == patched());
}

TEST_CASE("regions of two patches are an obstacle", "[engine][refusal]")
{
    Files files = patched();
    auto& text = files.at("Source/Types.h");
    text.replace(text.find("4/7"), 3, "4/9");
    CHECK(refused(files) ==
          "Shaders/Common.ush:0: : a patch of Gloss was applied in half: there are regions of "
          "patches with 7 and 9 regions each; none of the files that this version of lobec changes "
          "lacks one\n");
}

TEST_CASE("a region that is there twice is an obstacle", "[engine][refusal]")
{
    Files files = patched();
    auto& text = files.at("Source/Types.h");
    const auto begin = text.find("\t// BEGIN");
    const auto end = text.find("\tM_Num");
    text.insert(end, text.substr(begin, end - begin));
    CHECK(refused(files) == "Source/Types.h:9: enumerator: region 4 of Gloss is there twice, also "
                            "at Source/Types.h:6\n");
}

TEST_CASE("marks without their other half are obstacles", "[engine][refusal]")
{
    const Files files =
        changed("Source/Types.h", "\t// END lobe Gloss enumerator\n", "", patched());
    const std::string words =
        "Source/Types.h:6: : the BEGIN of region `enumerator` of Gloss without its END\n";
    CHECK(refused(files) == words);
    CHECK(refused_revert(files) == words);
}

TEST_CASE("a region that was edited by hand is an obstacle with its lines", "[engine][refusal]")
{
    const std::string words = "Source/Types.h:6: enumerator: the generated region in lines 6-8 was "
                              "edited by hand\n";
    for (const std::string to : {"M_Gloss = 7,", "M_Gloss", "M_Gloss,\n\tM_Mine,"}) {
        const Files files = changed("Source/Types.h", "M_Gloss,", to, patched());
        CHECK_THAT(refused(files), Contains("Source/Types.h:6: enumerator: the generated region"));
        CHECK_THAT(refused_revert(files), Contains("edited by hand"));
    }
    CHECK(refused(changed("Source/Types.h", "M_Gloss,", "M_Mine,", patched())) == words);
    // What a region took the place of is part of it.
    CHECK_THAT(refused(changed("Shaders/Common.ush", "//- #define MODEL_NUM   2",
                               "//- #define MODEL_NUM   3", patched())),
               Contains("edited by hand"));
    // Outside of the regions anything may happen.
    const Files beside = changed("Source/Types.h", "M_Lit,", "M_Lit = 1,", patched());
    CHECK(plan_of(beside).changes.empty());
    CHECK(shown(plan_of(beside).obstacles) == "");
}

TEST_CASE("a file that cannot be written is an obstacle where it has to be", "[engine][refusal]")
{
    const Files files = small_tree();
    Tree tree = tree_of(files);
    tree.refuses_write = [](const std::string& path) {
        return path == "Source/Types.h" ? "it is read-only" : "";
    };
    CHECK(refused(plan_patch(tree, small_list(), request_of("Gloss"))) ==
          "Source/Types.h:0: : this file cannot be written: it is read-only\n");
    const Files after = patched();
    tree = tree_of(after);
    tree.refuses_write = [](const std::string&) { return "it is read-only"; };
    CHECK(shown(plan_patch(tree, small_list(), request_of("Gloss")).obstacles) == "");
    Request request;
    request.model = "Gloss";
    CHECK(plan_revert(tree, small_list(), request).obstacles.size() == 4);
}

TEST_CASE("files that are no text are obstacles", "[engine][refusal]")
{
    Files files = small_tree();
    files["Source/Types.h"] += std::string("\0", 1);
    CHECK(refused(files) == "Source/Types.h:0: : has NUL bytes in it, so it is no text that edits "
                            "fit in\n");
    files["Source/Types.h"] = small_tree().at("Source/Types.h") + "// caf\xe9 \xff\n";
    const Plan plan = plan_of(files);
    CHECK(shown(plan.obstacles) == "");
    CHECK_THAT(applied(files, plan).at("Source/Types.h"), Catch::EndsWith("// caf\xe9 \xff\n"));
}

TEST_CASE("a region does not go where lines continue or comments are", "[engine][refusal]")
{
    CHECK(
        refused(changed("Source/Types.h", "M_Lit,\n", "M_Lit, \\\n")) ==
        "Source/Types.h:5: enumerator: a line that ends in a backslash continues where the region "
        "goes\n");
    CHECK(refused(changed("Shaders/Common.ush", "MODEL_NUM   2\n", "MODEL_NUM   2 \\\n")) ==
          "Shaders/Common.ush:3: id: a line that ends in a backslash continues where the region "
          "goes\n");
    CHECK(refused(changed("Source/Types.h", "\tM_Lit,\n", "\tM_Lit, /* and\n*/\t")) ==
          "Source/Types.h:0: : the enum ends in its count: not found\n"
          "Source/Types.h:0: enumerator: the anchor does not hit\n");
}

TEST_CASE("edits of the same lines are an obstacle", "[engine][refusal]")
{
    const EditList list = list_of("file F\n"
                                  "edit one \"1\"\nat ^(x);\nappend\n| a\n"
                                  "edit two \"2\"\nat ^x(;)\nappend\n| b\n"
                                  "edit three \"3\"\nat y\nbefore\n| c\n"
                                  "edit four \"4\"\nat x;\\s+y\\s+z\nreplace\n| d\n");
    const Files files = {{"F", "x;\ny\nz\n"}};
    CHECK(refused(plan_patch(tree_of(files), list, request_of("Gloss"))) ==
          "F:1: two: edit `one` changes the same lines\n"
          "F:2: three: edit `four` changes the same lines\n"
          "F:1: four: edit `one` changes the same lines\n"
          "F:1: four: edit `two` changes the same lines\n");
}

TEST_CASE("a list that asks for more than it gets is an obstacle", "[engine][refusal]")
{
    const EditList list = list_of("file F\n"
                                  "edit one \"1\"\nat ^x\nafter\n| ${unknown}\n"
                                  "edit two \"2\"\nat ${unknown}\nafter\n| b\n"
                                  "edit three \"3\"\nscope ${unknown}\nat x\nafter\n| b\n"
                                  "edit four \"4\"\nat x\nafter\n| //- b\n"
                                  "edit five \"5\"\nat x\nafter\n| b \\\n"
                                  "edit six \"6\"\nat x(y)?\nappend\n| b\n"
                                  "new N${unknown} f\n"
                                  "new M no-such\n");
    const Files files = {{"F", "x\n"}};
    CHECK(refused(plan_patch(tree_of(files), list, request_of("Gloss"))) ==
          "F:1: one: the text of the edit: one:1: unknown name `unknown`\n"
          "F:0: two: the anchor has no value `unknown`\n"
          "F:0: three: the scope has no value `unknown`\n"
          "F:1: six: group 1 of the anchor is no part of the hit\n"
          "F:1: four: the text of the edit has a line that looks like a region's mark\n"
          "F:1: five: the text of the edit ends in a backslash\n"
          "N:0: : no value `unknown`\n"
          "M:0: : there is no artifact or template `no-such`\n");
}

TEST_CASE("values that disagree are an obstacle", "[engine][refusal]")
{
    const EditList list = list_of("file F\nread n ^a (\\d+)\nread n ^b (\\d+)\nread n ^c (\\d+)\n"
                                  "else 1\nequal n 1 \"one is one\"\nequal n 2 \"one is two\"\n");
    const Files files = {{"F", "a 1\nb 2\n"}};
    CHECK(refused(plan_patch(tree_of(files), list, request_of("Gloss"))) ==
          "F:0: n: `n` is 2 here and 1 elsewhere\n"
          "F:1: n: one is two: 2 should be equal to `n` = 1\n");
}

}  // namespace lobe::engine
