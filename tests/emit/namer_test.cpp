#include "emit/namer.h"

#include <catch2/catch.hpp>

namespace lobe::emit {
namespace {

const Dialect& language(std::string_view target) { return dialect(*find_target(target)); }

}  // namespace

TEST_CASE("a free name is given as wanted", "[emit][namer]")
{
    Namer names{language("glsl450")};
    CHECK(names.unique("NoL") == "NoL");
    CHECK(names.unique("D_GGX") == "D_GGX");
}

TEST_CASE("keywords and builtin functions are avoided per language", "[emit][namer]")
{
    Namer glsl{language("glsl450")};
    CHECK(glsl.unique("sample") == "sample_");
    CHECK(glsl.unique("mix") == "mix_");
    CHECK(glsl.unique("lerp") == "lerp");
    Namer hlsl{language("hlsl")};
    CHECK(hlsl.unique("mix") == "mix");
    CHECK(hlsl.unique("lerp") == "lerp_");
    CHECK(hlsl.unique("Technique") == "Technique_");
    Namer unreal{language("ue4")};
    CHECK(unreal.unique("View") == "View_");
    CHECK(unreal.unique("lerp") == "lerp_");
    CHECK(unreal.unique("D_GGX") == "D_GGX_");
}

TEST_CASE("a name given twice gets a number", "[emit][namer]")
{
    Namer names{language("glsl450")};
    CHECK(names.unique("t") == "t");
    CHECK(names.unique("t") == "t_2");
    CHECK(names.unique("t") == "t_3");
    CHECK(names.unique("t_2") == "t_2_2");
    CHECK(names.unique("sample") == "sample_");
    CHECK(names.unique("sample") == "sample_2");
}

TEST_CASE("what GLSL keeps for itself is not given out", "[emit][namer]")
{
    Namer names{language("hlsl")};
    CHECK(names.unique("a__b") == "a_b");
    CHECK(names.unique("gl_Position").find("gl_") != 0);
    CHECK(names.unique("x_") == "x_");
    CHECK(names.unique("x_") == "x_2");
}

TEST_CASE("names are written as the language's people write them", "[emit][namer]")
{
    CHECK(language("ue4").styled("diffuse_fresnel") == "DiffuseFresnel");
    CHECK(language("ue4").styled("f0") == "F0");
    CHECK(language("ue4").styled("NoH") == "NoH");
    CHECK(language("glsl450").styled("diffuse_fresnel") == "diffuse_fresnel");
}

}  // namespace lobe::emit
