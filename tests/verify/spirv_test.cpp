// SPIRV-Tools and SPIRV-Cross accept what is right, say why they refuse, and never throw.
#include "verify/harness_texts.h"
#include "verify/judge.h"
#include "verify/spirv_words.h"

#include <catch2/catch.hpp>

#include <string>

using namespace lobe::verify;

namespace {

/// GLSL.std.450's numbers of min and max that pass the operand that is a number.
constexpr std::uint32_t n_min = 79;
constexpr std::uint32_t n_max = 80;
constexpr std::uint32_t n_clamp = 81;

std::vector<std::uint32_t> doubling()
{
    return compile(harness_texts[0].text, harness_texts[0].dialect, Stage::compute).spirv;
}

std::vector<std::uint32_t> extended_operations(std::string_view text, Dialect dialect)
{
    const Verdict verdict = compile(text, dialect, Stage::fragment);
    REQUIRE(verdict.accepted);
    std::vector<std::uint32_t> operations;
    for (const auto& words : instructions(verdict.spirv, op_ext_inst))
        operations.push_back(words[4]);
    return operations;
}

}  // namespace

TEST_CASE("min, max and clamp prefer numbers in every front end")
{
    CHECK(extended_operations(R"(#version 450
layout(location = 0) in vec4 x;
layout(location = 0) out vec4 result;
void main() { result = vec4(min(x.x, x.y), max(x.x, x.y), clamp(x.x, x.y, x.z), 1.0); }
)",
                              Dialect::glsl) == std::vector{n_min, n_max, n_clamp});
    CHECK(extended_operations(R"(float4 main(float4 X : COLOR0) : SV_Target0
{
    return float4(min(X.x, X.y), max(X.x, X.y), saturate(X.x), 1);
}
)",
                              Dialect::hlsl) == std::vector{n_min, n_max, n_clamp});
}

TEST_CASE("spirv-val takes what glslang makes and refuses what was broken")
{
    std::vector<std::uint32_t> spirv = doubling();
    REQUIRE_FALSE(spirv.empty());
    CHECK(validate(spirv).accepted);
    // Without its last word, OpFunctionEnd.
    spirv.pop_back();
    const Verdict verdict = validate(spirv);
    CHECK_FALSE(verdict.accepted);
    REQUIRE_FALSE(verdict.messages.empty());
    CHECK(verdict.messages[0].line == 0);
    CHECK(verdict.messages[0].text.find("OpFunctionEnd") != std::string::npos);
}

TEST_CASE("what is no SPIR-V is refused by every tool, with a reason")
{
    const std::vector<std::uint32_t> nothing;
    const std::vector<std::uint32_t> noise{0x12345678, 1, 2, 3, 4, 5, 6, 7, 8};
    std::vector<std::uint32_t> cut = doubling();
    cut.resize(cut.size() / 2);
    for (const auto& words : {nothing, noise, cut}) {
        CAPTURE(words.size());
        const Verdict valid = validate(words);
        CHECK_FALSE(valid.accepted);
        CHECK_FALSE(valid.messages.empty());
        const Verdict optimized = optimize(words);
        CHECK_FALSE(optimized.accepted);
        CHECK_FALSE(optimized.messages.empty());
        CHECK(optimized.spirv.empty());
        for (const CrossTarget target : {CrossTarget::glsl450, CrossTarget::essl310,
                                         CrossTarget::hlsl50, CrossTarget::msl21}) {
            const Verdict crossed = cross_compile(words, target);
            CHECK_FALSE(crossed.accepted);
            CHECK_FALSE(crossed.messages.empty());
            CHECK(crossed.text.empty());
        }
    }
}

TEST_CASE("spirv-opt makes less of a shader, and what it makes validates")
{
    const std::vector<std::uint32_t> spirv = doubling();
    const Verdict verdict = optimize(spirv);
    REQUIRE(verdict.accepted);
    CHECK(verdict.spirv.size() < spirv.size());
    CHECK(validate(verdict.spirv).accepted);
}

TEST_CASE("SPIRV-Cross says the same in four languages")
{
    const std::vector<std::uint32_t> spirv = doubling();
    const auto text = [&spirv](CrossTarget target) {
        const Verdict verdict = cross_compile(spirv, target);
        CHECK(verdict.accepted);
        CHECK(verdict.messages.empty());
        return verdict.text;
    };
    const auto begins = [](const std::string& whole, std::string_view part) {
        return whole.substr(0, part.size()) == part;
    };
    CHECK(begins(text(CrossTarget::glsl450), "#version 450\n"));
    CHECK(begins(text(CrossTarget::essl310), "#version 310 es\n"));
    CHECK(text(CrossTarget::hlsl50).find("RWByteAddressBuffer") != std::string::npos);
    CHECK(text(CrossTarget::msl21).find("kernel void") != std::string::npos);
}

TEST_CASE("what SPIRV-Cross makes of any dialect is taken by glslang again")
{
    for (const HarnessText& harness : harness_texts) {
        if (harness.float16) continue;
        CAPTURE(harness.name);
        const auto spirv = compile(harness.text, harness.dialect, Stage::compute).spirv;
        for (const auto& words : {spirv, optimize(spirv).spirv}) {
            const auto crossed = [&words](CrossTarget target) {
                return cross_compile(words, target).text;
            };
            const std::string glsl = crossed(CrossTarget::glsl450);
            CHECK(compile(glsl, Dialect::glsl, Stage::compute).accepted);
            // Its push constant is a plain uniform, which Vulkan would not take.
            const std::string essl = crossed(CrossTarget::essl310);
            CHECK(parse_only(essl, Dialect::essl, Stage::compute).accepted);
            const std::string hlsl = crossed(CrossTarget::hlsl50);
            CHECK(compile(hlsl, Dialect::hlsl, Stage::compute).accepted);
        }
    }
}

TEST_CASE("ESSL 3.10 has no half floats, and glslang or SPIRV-Cross says so")
{
    REQUIRE(harness_texts[1].float16);
    const auto spirv = compile(harness_texts[1].text, Dialect::glsl, Stage::compute).spirv;
    Verdict verdict = cross_compile(spirv, CrossTarget::essl310);
    if (verdict.accepted) verdict = parse_only(verdict.text, Dialect::essl, Stage::compute);
    CHECK_FALSE(verdict.accepted);
    CHECK_FALSE(verdict.messages.empty());
    CHECK(cross_compile(spirv, CrossTarget::msl21).accepted);
}
