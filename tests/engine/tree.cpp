#include "engine/tree.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

namespace lobe::engine {

Tree tree_of(const Files& files)
{
    return {[&files](const std::string& path) -> std::optional<std::string> {
                const auto found = files.find(path);
                return found == files.end() ? std::nullopt : std::optional{found->second};
            },
            {}};
}

Files applied(Files files, const Plan& plan)
{
    for (const Change& change : plan.changes) {
        const auto found = files.find(change.path);
        CHECK(change.before.has_value() == (found != files.end()));
        if (change.before) CHECK(*change.before == found->second);
        if (change.after)
            files[change.path] = *change.after;
        else
            files.erase(change.path);
    }
    return files;
}

EditList list_of(std::string_view text)
{
    ParsedEdits parsed = parse_edits(text);
    REQUIRE(parsed.error == "");
    return std::move(parsed.list);
}

Request request_of(std::string model)
{
    Request request;
    request.model = std::move(model);
    request.values.lists["pins"] = {{{{"name", "Gloss"}}, {}}, {{{"name", "Sheen"}}, {}}};
    request.words = {"has_node"};
    request.files = {{"functions.ush", "float Lobe()\n{\n\treturn 1;\n}\n"}};
    return request;
}

Files with_crlf(const Files& files)
{
    Files result;
    for (const auto& [path, bytes] : files)
        for (const char byte : bytes) {
            if (byte == '\n') result[path] += '\r';
            result[path] += byte;
        }
    return result;
}

std::string shown(const std::vector<Obstacle>& obstacles)
{
    std::string lines;
    for (const Obstacle& obstacle : obstacles)
        lines += fmt::format("{}:{}: {}: {}\n", obstacle.file, obstacle.line, obstacle.edit,
                             obstacle.what);
    return lines;
}

const Files& small_tree()
{
    static const Files files = {
        {"Build/Build.version", "{\n\t\"MajorVersion\": 4,\n\t\"MinorVersion\": 27,\n}\n"},
        {"Shaders/Common.ush", "#define MODEL_UNLIT 0\n"
                               "#define MODEL_LIT   1\n"
                               "#define MODEL_NUM   2\n"
                               "#define MODEL_MASK  0xF\n"
                               "// #define MODEL_NUM 9\n"
                               "\n"
                               "float3 ColorOf(uint Model)\n"
                               "{\n"
                               "\tswitch (Model)\n"
                               "\t{\n"
                               "\t\tcase MODEL_LIT: return 1;\n"
                               "\t\tdefault: return 0;\n"
                               "\t}\n"
                               "}"},
        {"Source/Types.h", "enum EModel : int;\n"
                           "enum EModel\n"
                           "{\n"
                           "\tM_Unlit,\n"
                           "\tM_Lit,\n"
                           "\tM_Num,\n"
                           "};\n"},
        {"Source/Pass.cpp", "void First() { Use({ M_Unlit, M_Lit }); }\n"
                            "void Second()\n"
                            "{\n"
                            "    if (Uses({M_Lit}) || Uses({M_Lit}))\n"
                            "        Draw(M_Lit, 1,\n"
                            "             2);\n"
                            "}\n"},
    };
    return files;
}

const EditList& small_list()
{
    static const EditList list = list_of(R"(
path SH Shaders
supports 4.25 4.27
word has_node "the model has a node"

file Build/Build.version
version "MajorVersion":\s*(\d+),\s*"MinorVersion":\s*(\d+)

file SH/Common.ush
read next_id ^#define MODEL_NUM[ \t]+(\d+)
read mask ^#define MODEL_MASK[ \t]+(\w+)
at_most mask next_id "there is an id left"
unique "the name of the model" \bMODEL_${MODEL}\b

edit id "the id"
    at ^(#define MODEL_NUM[ \t]+)\d+
    replace
    | #define MODEL_${MODEL} ${next_id}
    | ${1}${next_id_plus_1}

edit color "its color"
    scope ^float3 ColorOf\(
    at ^\s*default:
    before
    | case MODEL_${MODEL}:
    | 	return 0.5;

edit functions "include them"
    at ^float3 ColorOf\(
    before
    | #include "${Model}.ush"

file Source/Types.h
count ordinal ^\s*M_\w+,
    scope ^enum EModel\b
assert "the enum ends in its count" ^\s*M_Num,
edit enumerator "the model in C++"
    at ^\s*M_Num,
    before
    | M_${Model},

file Source/Pass.cpp
edit uses "every pass"
    scope ^void Second\(
    at \{\s*M_Lit[^}]*?(\s*\})
    hits 2
    append
    | , M_${Model}
edit draw "its draw call"
    when has_node
    since 4.26
    at Draw\((M_Lit)[^;]*;
    clone
    | M_${Model}
edit pins "its pins"
    at ^void Second\(
    before
    | //% for pin in pins
    | Pin(${pin.name});
    | //% end

new SH/${Model}.ush functions.ush
)");
    return list;
}

}  // namespace lobe::engine
