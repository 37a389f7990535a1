// The shipped edits on whole stand-in trees: which files change, that git takes the diff, that all
// of it can be undone, and what they refuse.
#include "engine/diff.h"
#include "engine/models.h"
#include "engine/stand_ins.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace lobe::engine {
namespace {

Plan patch(const Files& tree, const Request& request)
{
    return plan_patch(tree_of(tree), shipped_list(), request);
}

Files patched(const Files& tree, const Request& request)
{
    const Plan plan = patch(tree, request);
    INFO(shown(plan.obstacles));
    REQUIRE(plan.obstacles.empty());
    return applied(tree, plan);
}

std::string refused(const Files& tree, const Request& request)
{
    const Plan plan = patch(tree, request);
    CHECK(plan.changes.empty());
    return shown(plan.obstacles);
}

const Request& plain()
{
    static const Request request = wished(plain_wish()).request;
    return request;
}

const Request& carrier()
{
    static const Request request = wished(carrier_wish()).request;
    return request;
}

std::pair<int, int> existing_and_new(const Plan& plan)
{
    const auto is_new = [](const Change& change) { return !change.before; };
    const auto count = std::ranges::count_if(plan.changes, is_new);
    return {static_cast<int>(plan.changes.size()) - static_cast<int>(count),
            static_cast<int>(count)};
}

bool changes(const Plan& plan, const std::string& path)
{
    return std::ranges::any_of(plan.changes,
                               [&](const Change& change) { return change.path == path; });
}

std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// The same model under another name.
emit::Record renamed(const emit::Record& record, std::string_view to)
{
    std::string upper{to};
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    emit::Record result;
    for (const auto& field : record.texts)
        result.texts[field.name] =
            replaced(replaced(field.value, "Callisto", to), "CALLISTO", upper);
    for (const auto& field : record.lists) {
        result.lists[field.name];
        for (const emit::Record& each : field.value)
            result.lists[field.name].push_back(renamed(each, to));
    }
    return result;
}

Request renamed(const Request& request, const std::string& to)
{
    Request result = request;
    result.model = to;
    result.values = renamed(request.values, to);
    for (auto& [name, text] : result.files) {
        name = replaced(name, "Callisto", to);
        text = replaced(text, "Callisto", to);
    }
    return result;
}

Files without_last_newlines(Files tree)
{
    for (auto& [path, text] : tree)
        if (text.ends_with('\n')) text.pop_back();
    return tree;
}

bool has(const std::string& text, std::string_view part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the files that a patch touches")
{
    const auto touched = [](const std::string& version, const Request& request) {
        const Plan plan = patch(engine_tree(version), request);
        INFO(shown(plan.obstacles));
        CHECK(plan.version == version);
        return existing_and_new(plan);
    };
    // Three new ones: the model, its packing, the node.
    CHECK(touched("4.25", plain()) == std::pair{17, 3});
    CHECK(touched("4.26", plain()) == std::pair{18, 3});
    CHECK(touched("4.27", plain()) == std::pair{18, 3});
    // The anisotropy pass's three lists and its shader.
    CHECK(touched("4.26", carrier()) == std::pair{22, 3});
    CHECK(touched("4.27", carrier()) == std::pair{22, 3});

    const Plan plan = patch(engine_tree("4.27"), plain());
    CHECK_FALSE(changes(plan, renderer + "AnisotropyRendering.cpp"));
    CHECK_FALSE(changes(plan, materials + "MaterialInterface.cpp"));
    CHECK(changes(patch(engine_tree("4.27"), carrier()), shaders + "AnisotropyPassShader.usf"));
}

TEST_CASE("the model that ships goes into every version")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    const Files tree = engine_tree(version);
    const Request request = shipped().request;
    const Files done = patched(tree, request);
    CHECK(patch(done, request).changes.empty());
    CHECK(applied(done, plan_revert(tree_of(done), shipped_list(), request)) == tree);
}

TEST_CASE("a model without a node has none of its files")
{
    Wish wish = plain_wish();
    wish.node.clear();
    const Plan plan = patch(engine_tree("4.27"), wished(wish).request);
    REQUIRE(plan.obstacles.empty());
    CHECK(existing_and_new(plan) == std::pair{17, 2});
    CHECK_FALSE(changes(plan, materials + "MaterialExpressions.cpp"));
    const Files tree = applied(engine_tree("4.27"), plan);
    CHECK_FALSE(has(tree.at(shaders + "ShadingModelsMaterial.ush"), "NUM_MATERIAL_OUTPUTS"));
}

TEST_CASE("git takes the diff and makes the planned bytes of it")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    const int kind = GENERATE(0, 1, 2, 3);
    Files tree = kind == 2 ? fork_tree(version) : engine_tree(version);
    if (kind == 1) tree = with_crlf(tree);
    if (kind == 3) tree = without_last_newlines(tree);
    const Plan plan = patch(tree, version == "4.25" ? plain() : carrier());
    INFO(shown(plan.obstacles));
    REQUIRE(plan.obstacles.empty());
    in_folder(tree, [&](const std::string& folder) {
        std::ofstream{folder + "/all.diff", std::ios::binary} << unified_diff(plan.changes);
        std::string output;
        const std::string git = "cd " + folder + " && git -c core.autocrlf=false apply ";
        CHECK(run(git + "--check --whitespace=nowarn all.diff", output) == 0);
        CHECK(run(git + "--whitespace=nowarn all.diff", output) == 0);
        CHECK(output == "");
        for (const Change& change : plan.changes) {
            std::ifstream file{folder + "/" + change.path, std::ios::binary};
            std::ostringstream text;
            text << file.rdbuf();
            INFO(change.path);
            CHECK(text.str() == change.after);
        }
    });
}

TEST_CASE("patching again changes nothing, reverting restores every byte")
{
    const std::string version = GENERATE("4.25", "4.26", "4.27");
    const int kind = GENERATE(0, 1, 2, 3);
    Files tree = kind == 2 ? fork_tree(version) : engine_tree(version);
    if (kind == 1) tree = with_crlf(tree);
    if (kind == 3) tree = without_last_newlines(tree);
    const Request& request = version == "4.25" ? plain() : carrier();
    const Files once = patched(tree, request);
    CHECK(once != tree);
    CHECK(patch(once, request).changes.empty());

    const Plan back = plan_revert(tree_of(once), shipped_list(), {"Callisto", {}, {}, {}});
    INFO(shown(back.obstacles));
    CHECK(applied(once, back) == tree);
}

TEST_CASE("another packing of the model takes the place of the first")
{
    const Files tree = engine_tree("4.27");
    const Files direct = patched(tree, plain());
    CHECK(patched(patched(tree, carrier()), plain()) == direct);
    CHECK(patched(direct, carrier()) == patched(tree, carrier()));
}

TEST_CASE("two models live in one tree")
{
    const std::string version = GENERATE("4.25", "4.27");
    const Request& first = version == "4.25" ? plain() : carrier();
    const Request second = renamed(first, "Velvet");
    const Files tree = engine_tree(version);
    const Files one = patched(tree, first);
    const Files two = patched(one, second);
    CHECK(has(two.at(shaders + "ShadingCommon.ush"),
              "#define SHADINGMODELID_VELVET		13"));
    CHECK(has(two.at(shaders + "ShadingCommon.ush"),
              "#define SHADINGMODELID_NUM					14"));
    CHECK(patch(two, second).changes.empty());

    const Plan back = plan_revert(tree_of(two), shipped_list(), second);
    INFO(shown(back.obstacles));
    CHECK(applied(two, back) == one);
}

TEST_CASE("the id is the next one, in the shaders, the enumeration and the inspector")
{
    const Files tree = patched(fork_tree("4.27"), plain());
    CHECK(has(tree.at(shaders + "ShadingCommon.ush"),
              "#define SHADINGMODELID_CALLISTO		14"));
    CHECK(has(tree.at(shaders + "ShadingCommon.ush"),
              "#define SHADINGMODELID_NUM					15"));
    CHECK(has(tree.at(inspector + "PixelInspectorResult.h"),
              "#define PIXEL_INSPECTOR_SHADINGMODELID_CALLISTO 14"));
    const std::string& types = tree.at(classes + "Engine/EngineTypes.h");
    CHECK(types.find("MSM_Grass") < types.find("MSM_Callisto"));
    CHECK(types.find("MSM_Callisto") < types.find("MSM_NUM"));
}

TEST_CASE("what stands in the way is named")
{
    const Files tree = engine_tree("4.27");
    const std::string common = shaders + "ShadingCommon.ush";
    const std::string types = classes + "Engine/EngineTypes.h";
    const std::string number = "#define SHADINGMODELID_NUM					12";

    SECTION("ids are used up")
    {
        std::string enumerators;
        for (const int id : {12, 13, 14, 15}) enumerators += fmt::format("	MSM_Own{},\n", id);
        Files full = with(tree, common, number, "#define SHADINGMODELID_NUM 16");
        full = with(full, types, "	/** Number of unique shading models. */",
                    enumerators + "	/** Number of unique shading models. */");
        CHECK(has(refused(full, plain()), "all 16 ids of the mask are taken"));
    }
    SECTION("a model of that name is there")
    {
        const Files taken =
            with(tree, common, number, "#define SHADINGMODELID_CALLISTO 11\n" + number);
        CHECK(has(refused(taken, plain()), "the tree has a shading model of this name"));
        CHECK(has(refused(with(tree, types, "	MSM_Cloth	", "	MSM_Callisto	"), plain()),
                  "the engine has a shading model of this name"));
    }
    SECTION("the mask holds fewer")
    {
        CHECK(has(refused(with(tree, common, "0xF", "0x7"), plain()),
                  "the mask of the shading model must hold 16 ids"));
    }
    SECTION("the enumeration has a model more than the shaders")
    {
        const std::string eye =
            "	MSM_Eye						UMETA(DisplayName=\"Eye\"),\n";
        CHECK(has(refused(with(tree, types, eye, eye + "	MSM_Own,\n"), plain()),
                  "as many enumerators must stand before MSM_NUM"));
        CHECK(has(refused(with(tree, types, eye, ""), plain()),
                  "as many enumerators must stand before MSM_NUM"));
        CHECK(has(refused(with(tree, types, eye, "	MSM_Eye = 9,\n"), plain()),
                  "as many enumerators must stand before MSM_NUM"));
    }
    SECTION("the enumeration has another name")
    {
        const Files other =
            with(tree, types, "enum EMaterialShadingModel\n", "enum class EShadingModel\n");
        CHECK(has(refused(other, plain()), types));
    }
    SECTION("an anchor is gone")
    {
        const std::string path = shaders + "DeferredShadingCommon.ush";
        const std::string why =
            refused(with(tree, path, "		|| ShadingModelID == SHADINGMODELID_EYE;",
                         "		|| IsEye(ShadingModelID);"),
                    plain());
        CHECK(has(why, path));
        CHECK(has(why, "has_custom_data"));
    }
    SECTION("an anchor is there twice")
    {
        const std::string path = shaders + "Definitions.usf";
        const std::string line = "#ifndef MATERIAL_SINGLE_SHADINGMODEL\n";
        CHECK(has(refused(with(tree, path, line, line + "#endif\n" + line), plain()),
                  "material_define_default"));
    }
    SECTION("a generated region was edited")
    {
        const Files edited = with(patched(tree, plain()), materials + "HLSLMaterialTranslator.cpp",
                                  "TEXT(\"MATERIAL_SHADINGMODEL_CALLISTO\")",
                                  "TEXT(\"MATERIAL_SHADINGMODEL_KALLISTO\")");
        CHECK(has(refused(edited, plain()), "material_define"));
    }
    SECTION("half of a patch is there")
    {
        Files half = patched(tree, plain());
        half[types] = tree.at(types);
        CHECK_FALSE(refused(half, plain()).empty());
    }
    SECTION("it is no engine")
    {
        CHECK_FALSE(refused({{"README.md", "a plugin\n"}}, plain()).empty());
        Files unknown = tree;
        unknown.erase("Engine/Build/Build.version");
        CHECK(patch(unknown, plain()).version == "4.27");
        unknown.erase("Engine/Source/Runtime/Launch/Resources/Version.h");
        CHECK_FALSE(refused(unknown, plain()).empty());
    }
    SECTION("an engine that the list does not know")
    {
        CHECK_FALSE(refused(with(tree, "Engine/Build/Build.version", "27", "28"), plain()).empty());
    }
    SECTION("several at once")
    {
        Files broken = with(tree, shaders + "BasePassCommon.ush", "WRITES_CUSTOMDATA_TO_GBUFFER",
                            "WRITES_OTHER_DATA");
        broken.erase(materials + "MaterialShader.cpp");
        const std::string why = refused(broken, plain());
        CHECK(has(why, "BasePassCommon.ush"));
        CHECK(has(why, "MaterialShader.cpp"));
    }
}

TEST_CASE("what a channel cannot carry is said")
{
    CHECK(refused(engine_tree("4.25"), carrier()) ==
          ":0: : 4.25 writes GBufferF in the base pass, and only with r.AnisotropicBRDF: its alpha "
          "cannot carry parameters: 1 should be at most 0\n");

    Wish stray = carrier_wish();
    stray.pins[0] = {"custom_data0", "diffuse_fresnel"};
    CHECK(has(refused(engine_tree("4.27"), wished(stray).request),
              "that pin has to feed what its alpha carries"));

    Wish occlusion = plain_wish();
    occlusion.places[0].channel = "c.a";
    CHECK(has(refused(engine_tree("4.27"), wished(occlusion).request), "AOMultiBounce"));
}

TEST_CASE("lists in another order, and lines by other hands, stay as they are")
{
    Files tree = with(engine_tree("4.27"), materials + "Material.cpp",
                      "{ MSM_ClearCoat, MSM_Hair, MSM_Cloth, MSM_Eye }",
                      "{ MSM_Eye, MSM_Own, MSM_ClearCoat }");
    tree = with(tree, shaders + "BasePassCommon.ush",
                "(MATERIAL_SHADINGMODEL_SUBSURFACE || MATERIAL_SHADINGMODEL_CLEAR_COAT",
                "(MATERIAL_SHADINGMODEL_CLEAR_COAT || MATERIAL_SHADINGMODEL_OWN");
    const Files done = patched(tree, plain());
    CHECK(has(done.at(materials + "Material.cpp"),
              "{ MSM_Eye, MSM_Own, MSM_ClearCoat, MSM_Callisto }"));
    CHECK(has(done.at(shaders + "BasePassCommon.ush"),
              "MATERIAL_SHADINGMODEL_EYE || MATERIAL_SHADINGMODEL_CALLISTO))"));
}

TEST_CASE("the pins' names and defaults are the model's")
{
    const std::string version = GENERATE("4.25", "4.27");
    const std::string text =
        patched(engine_tree(version), plain()).at(materials + "MaterialShared.cpp");
    CHECK(has(text, "case MP_Opacity:\n			return Compiler->Constant(0.75f);"));
    CHECK(has(text,
              "case MP_CustomData0: CustomPinNames.Add({ MSM_Callisto, \"Diffuse Fresnel\" });"));
    CHECK(has(text, "CustomPinNames.Add({ MSM_Callisto, \"Diffuse Fresnel Falloff\" });"));
    const std::string old = version == "4.25" ? "(Material->MaterialDomain == MD_Volume ? "
                                                "LOCTEXT(\"Extinction\", \"Extinction\") : "
                                                "LOCTEXT(\"Opacity\", \"Opacity\")).ToString()"
                                              : "(LOCTEXT(\"Opacity\", \"Opacity\")).ToString()";
    CHECK(has(text, old));
    CHECK(text.back() != '\n');
}

}  // namespace lobe::engine
