#include "engine/tree.h"

#include <catch2/catch.hpp>

namespace lobe::engine {
namespace {

/// The tree without lines that are marks.
std::string without_marks(const std::string& text)
{
    std::string result;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n') + 1);
        const std::string_view bare = line.substr(line.find_first_not_of(" \t"));
        if (!bare.starts_with("// BEGIN") && !bare.starts_with("// END") &&
            !bare.starts_with("//-") && !bare.starts_with("//+"))
            result += line;
        rest.remove_prefix(line.size());
    }
    return result;
}

}  // namespace

TEST_CASE("every action puts its text where it belongs", "[engine][plan]")
{
    const Plan plan = plan_patch(tree_of(small_tree()), small_list(), request_of("Gloss"));
    REQUIRE(shown(plan.obstacles) == "");
    const Files patched = applied(small_tree(), plan);
    CHECK(without_marks(patched.at("Shaders/Common.ush") + "\n") ==
          "#define MODEL_UNLIT 0\n"
          "#define MODEL_LIT   1\n"
          "#define MODEL_GLOSS 2\n"
          "#define MODEL_NUM   3\n"
          "#define MODEL_MASK  0xF\n"
          "// #define MODEL_NUM 9\n"
          "\n"
          "#include \"Gloss.ush\"\n"
          "float3 ColorOf(uint Model)\n"
          "{\n"
          "\tswitch (Model)\n"
          "\t{\n"
          "\t\tcase MODEL_LIT: return 1;\n"
          "\t\tcase MODEL_GLOSS:\n"
          "\t\t\treturn 0.5;\n"
          "\t\tdefault: return 0;\n"
          "\t}\n"
          "}\n");
    CHECK(without_marks(patched.at("Source/Types.h")) == "enum EModel : int;\n"
                                                         "enum EModel\n"
                                                         "{\n"
                                                         "\tM_Unlit,\n"
                                                         "\tM_Lit,\n"
                                                         "\tM_Gloss,\n"
                                                         "\tM_Num,\n"
                                                         "};\n");
    CHECK(without_marks(patched.at("Source/Pass.cpp")) ==
          "void First() { Use({ M_Unlit, M_Lit }); }\n"
          "Pin(Gloss);\n"
          "Pin(Sheen);\n"
          "void Second()\n"
          "{\n"
          "    if (Uses({M_Lit, M_Gloss}) || Uses({M_Lit, M_Gloss}))\n"
          "        Draw(M_Lit, 1,\n"
          "             2);\n"
          "        Draw(M_Gloss, 1,\n"
          "             2);\n"
          "}\n");
    CHECK(plan.version == "4.27");
    CHECK(plan.read == std::vector<std::pair<std::string, std::string>>{
                           {"next_id", "2"}, {"mask", "0xF"}, {"ordinal", "3"}});
    CHECK(plan.regions == 7);
}

TEST_CASE("a region says what it is and what stood there", "[engine][plan]")
{
    const Plan plan = plan_patch(tree_of(small_tree()), small_list(), request_of("Gloss"));
    const Files patched = applied(small_tree(), plan);
    CHECK_THAT(patched.at("Shaders/Common.ush"),
               Catch::StartsWith("#define MODEL_UNLIT 0\n"
                                 "#define MODEL_LIT   1\n"
                                 "// BEGIN lobe Gloss 1/7 id 730af1d1\n"
                                 "//+ Shaders/Gloss.ush\n"
                                 "//- #define MODEL_NUM   2\n"
                                 "#define MODEL_GLOSS 2\n"
                                 "#define MODEL_NUM   3\n"
                                 "// END lobe Gloss id\n"
                                 "#define MODEL_MASK  0xF\n"));
    CHECK_THAT(patched.at("Source/Pass.cpp"),
               Catch::Contains("    //- if (Uses({M_Lit}) || Uses({M_Lit}))\n"
                               "    if (Uses({M_Lit, M_Gloss}) || Uses({M_Lit, M_Gloss}))\n"
                               "    // END lobe Gloss uses\n"));
    CHECK_THAT(patched.at("Shaders/Gloss.ush"),
               Catch::StartsWith("// lobe Gloss new ") &&
                   Catch::EndsWith("\nfloat Lobe()\n{\n\treturn 1;\n}\n"));
}

}  // namespace lobe::engine
