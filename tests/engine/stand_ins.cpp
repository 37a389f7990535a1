#include "engine/stand_ins.h"

#include "emit/template.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace lobe::engine {
namespace {

namespace fs = std::filesystem;

const fs::path data = "data/engine";

std::string read(const fs::path& path)
{
    std::ifstream file{path, std::ios::binary};
    REQUIRE(file);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// The files of a folder go into the tree, then its `changes` are done.
void lay_over(Files& tree, const std::string& folder)
{
    for (auto& [path, text] : data_files(folder)) tree[path] = text;
    const auto changes = tree.extract("changes");
    if (changes.empty()) return;
    std::istringstream lines{changes.mapped()};
    std::string what;
    std::string path;
    while (lines >> what >> path) {
        INFO(what << ' ' << path);
        REQUIRE(tree.contains(path));
        if (what == "absent") {
            tree.erase(path);
        } else {
            REQUIRE(what == "no_newline");
            std::string& text = tree[path];
            if (text.ends_with('\n')) text.pop_back();
        }
    }
}

}  // namespace

const EditList& shipped_list()
{
    static const EditList list = [] {
        const auto text = emit::embedded_template("ue4/engine.edits");
        REQUIRE(text.has_value());
        ParsedEdits parsed = parse_edits(*text);
        INFO(parsed.error);
        REQUIRE(parsed.error.empty());
        return std::move(parsed.list);
    }();
    return list;
}

Files data_files(const std::string& folder)
{
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(data / folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(data / folder).generic_string()] =
                read(entry.path());
    return files;
}

Files engine_tree(const std::string& version)
{
    Files tree;
    lay_over(tree, "common");
    if (fs::exists(data / version)) lay_over(tree, version);
    return tree;
}

Files with(Files tree, const std::string& path, std::string_view from, std::string_view to)
{
    std::string& text = tree.at(path);
    const std::size_t at = text.find(from);
    INFO(path << ": " << from);
    REQUIRE(at != std::string::npos);
    REQUIRE(text.find(from, at + 1) == std::string::npos);
    text.replace(at, from.size(), to);
    return tree;
}

Files fork_tree(const std::string& version)
{
    Files tree = engine_tree(version);
    const auto change = [&](const std::string& path, std::string_view from, std::string_view to) {
        tree = with(std::move(tree), path, from, to);
    };
    change(shaders + "ShadingCommon.ush",
           "#define SHADINGMODELID_NUM					12",
           "#define SHADINGMODELID_TOON					12\n#define "
           "SHADINGMODELID_GRASS				13\n"
           "#define SHADINGMODELID_NUM					14");
    change(shaders + "ShadingCommon.ush", "		default: return float3(1.0f, 1.0f, 1.0f);",
           "		case SHADINGMODELID_TOON: return float3(1.0f, 0.0f, 0.0f);\n"
           "		default: return float3(1.0f, 1.0f, 1.0f);");
    change(shaders + "ShadingModels.ush", "		default:\n",
           "		case SHADINGMODELID_TOON:\n			return "
           "DefaultLitBxDF(GBuffer, N, V, L, "
           "Falloff, NoL, AreaLight, Shadow);\n		default:\n");
    if (version != "4.25")
        change(shaders + "DeferredShadingCommon.ush", "ShadingModelID == SHADINGMODELID_EYE;",
               "ShadingModelID == SHADINGMODELID_EYE\n		|| ShadingModelID == "
               "SHADINGMODELID_TOON;");
    change(shaders + "BasePassCommon.ush", "MATERIAL_SHADINGMODEL_EYE))",
           "MATERIAL_SHADINGMODEL_EYE || MATERIAL_SHADINGMODEL_TOON))");
    change(classes + "Engine/EngineTypes.h", "	/** Number of unique shading models. */",
           "	MSM_Toon					UMETA(DisplayName=\"Toon\"),\n"
           "	// Blades of it.\n"
           "	MSM_Grass,\n"
           "	/** Number of unique shading models. */");
    change(classes + "Materials/MaterialExpressionShadingModel.h", "MSM_Eye\"",
           "MSM_Eye, MSM_Toon\"");
    change(materials + "Material.cpp", "{ MSM_ClearCoat, MSM_Hair, MSM_Cloth, MSM_Eye }",
           "{ MSM_Toon, MSM_ClearCoat, MSM_Hair, MSM_Cloth, MSM_Eye }");
    return tree;
}

void in_folder(const Files& files, const std::function<void(const std::string& folder)>& check)
{
    std::string name = (fs::temp_directory_path() / "lobe-engine-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    for (const auto& [path, text] : files) {
        const fs::path whole = fs::path{name} / path;
        fs::create_directories(whole.parent_path());
        std::ofstream{whole, std::ios::binary} << text;
    }
    check(name);
    fs::remove_all(name);
}

int run(const std::string& command, std::string& output)
{
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 4096> part{};
    while (const std::size_t read = fread(part.data(), 1, part.size(), pipe))
        output.append(part.data(), read);
    const int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace lobe::engine
