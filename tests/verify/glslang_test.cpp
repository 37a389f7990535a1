// glslang accepts what is right and rejects what is wrong; its words and lines arrive.
#include "verify/harness_texts.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

#include <string>
#include <thread>

using namespace lobe::verify;

namespace {

constexpr std::string_view fragment450 = R"(#version 450
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(min(color, vec3(1.0)), 1.0); }
)";

constexpr std::string_view fragment330 = R"(#version 330
in vec3 color;
out vec4 result;
void main() { result = vec4(color, 1.0); }
)";

constexpr std::string_view fragment300es = R"(#version 300 es
precision highp float;
in vec3 color;
out vec4 result;
void main() { result = vec4(color, 1.0); }
)";

constexpr std::string_view fragment_hlsl = R"(float4 shade(float3 Color : COLOR0) : SV_Target0
{
    half3 Bounded = saturate(Color);
    return float4(Bounded, 1);
}
)";

}  // namespace

TEST_CASE("a shader of each Vulkan dialect compiles without a word")
{
    const Verdict glsl = compile(fragment450, Dialect::glsl, Stage::fragment);
    CHECK(glsl.accepted);
    CHECK(glsl.messages.empty());
    CHECK_FALSE(glsl.spirv.empty());
    const Verdict hlsl = compile(fragment_hlsl, Dialect::hlsl, Stage::fragment, "shade");
    CHECK(hlsl.accepted);
    CHECK(hlsl.messages.empty());
    CHECK_FALSE(hlsl.spirv.empty());
}

TEST_CASE("an error comes verbatim with its line")
{
    const Verdict verdict = compile("#version 450\n"
                                    "layout(location = 0) out vec4 result;\n"
                                    "void main()\n"
                                    "{\n"
                                    "    result = vec4(alpha);\n"
                                    "}\n",
                                    Dialect::glsl, Stage::fragment);
    CHECK_FALSE(verdict.accepted);
    CHECK(verdict.spirv.empty());
    REQUIRE(verdict.messages.size() == 1);
    CHECK(verdict.messages[0].line == 5);
    CHECK(verdict.messages[0].text == "ERROR: 0:5: 'alpha' : undeclared identifier");
}

TEST_CASE("of an HLSL cascade the first error is kept, and warnings")
{
    const Verdict verdict = compile("#pragma once\n"
                                    "float4 main(float2 Uv : TEXCOORD0) : SV_Target0\n"
                                    "{\n"
                                    "    float X = Unknown(Uv.x);\n"
                                    "    float Y = AlsoUnknown(X);\n"
                                    "    return float4(X, Y, 0, 1);\n"
                                    "}\n",
                                    Dialect::hlsl, Stage::fragment);
    CHECK_FALSE(verdict.accepted);
    REQUIRE(verdict.messages.size() == 2);
    CHECK(verdict.messages[0].line == 1);
    CHECK(verdict.messages[0].text == "WARNING: 0:1: '#pragma once' : not implemented");
    CHECK(verdict.messages[1].line == 4);
    CHECK(verdict.messages[1].text ==
          "ERROR: 0:4: 'Unknown' : no matching overloaded function found");
}

TEST_CASE("a syntax error of HLSL has its line")
{
    const Verdict verdict =
        compile("float4 main() : SV_Target0\n{\n    float X = 1\n    return X;\n}", Dialect::hlsl,
                Stage::fragment);
    CHECK_FALSE(verdict.accepted);
    REQUIRE(verdict.messages.size() == 1);
    CHECK(verdict.messages[0].line == 4);
    CHECK(verdict.messages[0].text == "ERROR: 0:4: ';' : Expected");
}

TEST_CASE("a warning does not reject")
{
    const std::string text = "#pragma once\n" + std::string{fragment_hlsl};
    const Verdict verdict = compile(text, Dialect::hlsl, Stage::fragment, "shade");
    CHECK(verdict.accepted);
    REQUIRE(verdict.messages.size() == 1);
    CHECK(verdict.messages[0].line == 1);
}

TEST_CASE("an entry point that is not there is missed")
{
    const Verdict hlsl = compile(fragment_hlsl, Dialect::hlsl, Stage::fragment, "main");
    CHECK_FALSE(hlsl.accepted);
    REQUIRE(hlsl.messages.size() == 1);
    CHECK(hlsl.messages[0].line == 0);
    CHECK(hlsl.messages[0].text == "WARNING: Linking fragment stage: Entry point not found");
    const Verdict glsl =
        parse_only("#version 330\nfloat f() { return 1.0; }\n", Dialect::glsl, Stage::fragment);
    CHECK_FALSE(glsl.accepted);
    REQUIRE(glsl.messages.size() == 1);
    CHECK(glsl.messages[0].text == "ERROR: Linking fragment stage: Missing entry point: Each "
                                   "stage requires one entry point");
}

TEST_CASE("GLSL 3.30 and ESSL 3.00 are for OpenGL only")
{
    CHECK(parse_only(fragment330, Dialect::glsl, Stage::fragment).accepted);
    CHECK(parse_only(fragment300es, Dialect::essl, Stage::fragment).accepted);
    CHECK_FALSE(compile(fragment330, Dialect::glsl, Stage::fragment).accepted);
    CHECK_FALSE(compile(fragment300es, Dialect::essl, Stage::fragment).accepted);
}

TEST_CASE("GLSL 3.30 has no fma and ESSL 3.00 no implicit conversion")
{
    const Verdict desktop = parse_only("#version 330\n"
                                       "out vec4 result;\n"
                                       "void main() { result = vec4(fma(1.0, 2.0, 3.0)); }\n",
                                       Dialect::glsl, Stage::fragment);
    CHECK_FALSE(desktop.accepted);
    REQUIRE(desktop.messages.size() == 1);
    CHECK(desktop.messages[0].line == 3);
    CHECK(desktop.messages[0].text == "ERROR: 0:3: 'fma' : no matching overloaded function found");

    const Verdict mobile = parse_only("#version 300 es\n"
                                      "precision highp float;\n"
                                      "out vec4 result;\n"
                                      "void main() { result = vec4(1.0) * 2; }\n",
                                      Dialect::essl, Stage::fragment);
    CHECK_FALSE(mobile.accepted);
    REQUIRE(mobile.messages.size() == 1);
    CHECK(mobile.messages[0].line == 4);
}

TEST_CASE("ESSL without a precision for floats is refused")
{
    const Verdict verdict = parse_only("#version 300 es\n"
                                       "out vec4 result;\n"
                                       "void main() { result = vec4(1.0); }\n",
                                       Dialect::essl, Stage::fragment);
    CHECK_FALSE(verdict.accepted);
    REQUIRE(verdict.messages.size() == 1);
    CHECK(verdict.messages[0].line == 2);
}

TEST_CASE("a text that says it is the other language is refused")
{
    const Verdict as_glsl = parse_only(fragment300es, Dialect::glsl, Stage::fragment);
    CHECK_FALSE(as_glsl.accepted);
    REQUIRE(as_glsl.messages.size() == 1);
    CHECK(as_glsl.messages[0].text == "the text says it is ESSL, GLSL was expected");
    CHECK_FALSE(compile(fragment450, Dialect::essl, Stage::fragment).accepted);
    CHECK_FALSE(parse_only(fragment330, Dialect::essl, Stage::fragment).accepted);
}

TEST_CASE("nothing at all is refused with a reason")
{
    for (const Dialect dialect : {Dialect::glsl, Dialect::essl, Dialect::hlsl}) {
        const Verdict compiled = compile({}, dialect, Stage::compute);
        CHECK_FALSE(compiled.accepted);
        CHECK_FALSE(compiled.messages.empty());
        const Verdict parsed = parse_only({}, dialect, Stage::compute);
        CHECK_FALSE(parsed.accepted);
        CHECK_FALSE(parsed.messages.empty());
    }
}

TEST_CASE("threads judge at the same time and agree")
{
    const auto judge_all = [] {
        std::vector<std::vector<std::uint32_t>> spirv;
        for (int round = 0; round < 4; ++round)
            for (const HarnessText& harness : harness_texts)
                spirv.push_back(compile(harness.text, harness.dialect, Stage::compute).spirv);
        return spirv;
    };
    const auto alone = judge_all();
    std::vector<std::vector<std::vector<std::uint32_t>>> together(4);
    std::vector<std::thread> threads;
    for (auto& each : together) threads.emplace_back([&each, &judge_all] { each = judge_all(); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& each : together) CHECK(each == alone);
    CHECK_FALSE(alone.front().empty());
}

TEST_CASE("includes are asked for by name, and once where they say so")
{
    int asked = 0;
    const Includes includes = [&asked](std::string_view name) -> std::optional<std::string> {
        if (name == "/Lib/Half.ush") {
            ++asked;
            return "#pragma once\nfloat Half() { return 0.5; }\n";
        }
        if (name == "Loop.ush") return "#include \"Loop.ush\"\n";
        return std::nullopt;
    };
    const auto compile_with = [&includes](std::string_view line) {
        return compile(std::string{line} + "#include \"/Lib/Half.ush\"\n"
                                           "float4 shade() : SV_Target0 { return Half(); }\n",
                       Dialect::hlsl, Stage::fragment, "shade", includes);
    };
    CHECK(compile_with("").accepted);
    CHECK(asked == 1);
    CHECK(compile_with("#include \"/Lib/Half.ush\"\n").accepted);
    CHECK_FALSE(compile_with("#include \"Missing.ush\"\n").accepted);
    CHECK_FALSE(compile_with("#include \"Loop.ush\"\n").accepted);
}
