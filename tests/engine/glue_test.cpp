// What the patch writes into C++: it compiles, before and after, with g++ and clang++.
#include "engine/diff.h"
#include "engine/models.h"
#include "engine/stand_ins.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cstdlib>

namespace lobe::engine {
namespace {

/// What the engine's header tool writes for every class of a header.
std::string generated_header(const std::string& header)
{
    std::string name;
    const std::size_t at = header.find("\nclass U");
    if (at == std::string::npos) return {};
    name = header.substr(at + 7, header.find(' ', at + 7) - at - 7);
    return fmt::format("#undef GENERATED_UCLASS_BODY\n#define GENERATED_UCLASS_BODY() public: "
                       "using Super = UMaterialExpressionCustomOutput; {}(const "
                       "FObjectInitializer& ObjectInitializer);\n",
                       name);
}

/// Everything that compiling a tree's sources takes.
Files sources_of(const Files& tree)
{
    Files all;
    for (const auto& [path, text] : data_files("headers")) all["headers/" + path] = text;
    for (const auto& [path, text] : tree) {
        if (path.ends_with(".cpp") || path.ends_with(".h")) all[path] = text;
        if (path.ends_with(".h") && text.find(".generated.h\"") != std::string::npos) {
            const std::string name = path.substr(path.rfind('/') + 1);
            all["generated/" + name.substr(0, name.size() - 2) + ".generated.h"] =
                generated_header(text);
        }
    }
    return all;
}

/// The complaints of a compiler about a tree's sources, in the editor and in a game. They are one
/// unit, as the engine's own build makes them; the one with the node comes first.
std::string complaints(const Files& tree, const std::string& compiler)
{
    Files all = sources_of(tree);
    std::string& unit = all["unit.cpp"];
    unit = fmt::format("#include \"{}MaterialExpressions.cpp\"\n", materials);
    for (const auto& [path, text] : tree)
        if (path.ends_with(".cpp") && !path.ends_with("/MaterialExpressions.cpp"))
            unit += fmt::format("#include \"{}\"\n", path);
    std::string output;
    in_folder(all, [&](const std::string& folder) {
        for (const int editor : {1, 0})
            run(fmt::format("cd {} && {} -std=c++17 -fsyntax-only -Wall -Wextra -Werror "
                            "-Wno-unused-parameter -DWITH_EDITOR={} -DWITH_EDITORONLY_DATA={} "
                            "-Iheaders -Igenerated -I. -I{} unit.cpp",
                            folder, compiler, editor, editor, classes),
                output);
    });
    return output;
}

std::string both_compilers(const Files& tree)
{
    std::string output;
    for (const std::string compiler : {"g++", "clang++"}) output += complaints(tree, compiler);
    return output;
}

Files patched(const Files& tree, const Request& request)
{
    const Plan plan = plan_patch(tree_of(tree), shipped_list(), request);
    INFO(shown(plan.obstacles));
    REQUIRE(plan.obstacles.empty());
    return applied(tree, plan);
}

}  // namespace

TEST_CASE("the stand-in trees compile as they are")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    CHECK(both_compilers(engine_tree(version)) == "");
    CHECK(both_compilers(fork_tree(version)) == "");
}

TEST_CASE("a compiler that is asked finds what is wrong")
{
    const Files broken =
        with(engine_tree("4.27"), materials + "Material.cpp",
             "HasShadingModel(MSM_SingleLayerWater)", "HasShadingModel(MSM_Callisto)");
    for (const std::string compiler : {"g++", "clang++"})
        CHECK(complaints(broken, compiler).find("MSM_Callisto") != std::string::npos);
}

TEST_CASE("the patched C++ compiles")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    CAPTURE(version);
    CHECK(both_compilers(patched(engine_tree(version), wished(plain_wish()).request)) == "");
    CHECK(both_compilers(patched(engine_tree(version), wished(color_wish()).request)) == "");
    CHECK(both_compilers(patched(fork_tree(version), wished(plain_wish()).request)) == "");
    if (version != "4.25")
        CHECK(both_compilers(patched(engine_tree(version), wished(carrier_wish()).request)) == "");
}

}  // namespace lobe::engine
