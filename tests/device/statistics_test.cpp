// What RADV says of shaders whose instructions can be counted by hand.
#include "device/instructions.h"
#include "device/statistics.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

using namespace lobe::device;

namespace {

/// A shader that stores `value`, in which x and y are numbers that only the run knows.
std::vector<std::uint32_t> shader(const std::string& value)
{
    const std::string text = fmt::format(R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Points {{ float points[]; }};
layout(std430, set = 0, binding = 1) writeonly buffer Results {{ float results[]; }};
void main()
{{
    float x = points[gl_GlobalInvocationID.x * 2u];
    float y = points[gl_GlobalInvocationID.x * 2u + 1u];
    results[gl_GlobalInvocationID.x] = {};
}}
)",
                                         value);
    auto verdict =
        lobe::verify::compile(text, lobe::verify::Dialect::glsl, lobe::verify::Stage::compute);
    REQUIRE(verdict.accepted);
    return verdict.spirv;
}

const std::vector<std::vector<std::string>> chips{
    {"polaris10"}, {"vega10"}, {"navi10"}, {"navi21"}, {"gfx1100", "navi31"}};

}  // namespace

TEST_CASE("an operation more is an instruction more, on every chip")
{
    for (const auto& chip : chips) {
        INFO(chip.front());
        std::string why;
        auto compiler = ChipCompiler::open(chip, why);
        INFO(why);
        REQUIRE(compiler);
        CHECK(compiler->driver().starts_with("radv"));
        const auto count = [&](const std::string& value) {
            const auto statistics = compiler->compile(shader(value), why);
            INFO(why);
            REQUIRE(statistics);
            return std::pair{statistics->vector, statistics->transcendental};
        };
        const auto [vector, transcendental] = count("x + y");
        CHECK(transcendental == 0);
        CHECK(count("x * y + x") == std::pair{vector, 0});  // one instruction, fused
        CHECK(count("(x + y) * y * x") == std::pair{vector + 2, 0});
        CHECK(count("exp2(x + y)") == std::pair{vector, 1});
        CHECK(count("inversesqrt(x + y) * x") == std::pair{vector + 1, 1});
    }
}

TEST_CASE("a driver tells registers, waves and its own estimates")
{
    std::string why;
    auto compiler = ChipCompiler::open(chips[3], why);
    REQUIRE(compiler);
    const auto statistics = compiler->compile(shader("x + y"), why);
    REQUIRE(statistics);
    CHECK(statistics->vgprs > 0);
    CHECK(statistics->waves > 0);
    CHECK(statistics->latency > 0);
    CHECK(statistics->inverse_throughput > 0);
    CHECK(statistics->instructions > statistics->vector);
    CHECK(statistics->code_bytes >= 4 * statistics->instructions);
    CHECK(statistics->spilled == 0);
}

TEST_CASE("a chip that the driver does not know is a reason, and so is what is no shader")
{
    std::string why;
    const std::vector<std::string> unknown{"voodoo2"};
    CHECK_FALSE(ChipCompiler::open(unknown, why));
    CHECK(why == "the driver does not know `voodoo2`");

    // The first spelling that is known.
    const std::vector<std::string> renamed{"voodoo2", "navi21"};
    auto compiler = ChipCompiler::open(renamed, why);
    REQUIRE(compiler);
    CHECK(compiler->chip().find("NAVI21") != std::string::npos);

    const std::array<std::uint32_t, 5> words{1, 2, 3, 4, 5};
    CHECK_FALSE(compiler->compile(words, why));
    CHECK(why == "the shader has no compute entry `main`");
    CHECK(compiler->compile(shader("x + y"), why));
}

TEST_CASE("vector instructions are counted by their mnemonics")
{
    const VectorInstructions count =
        count_vector_instructions("BB0:\n"
                                  "\ts_load_dwordx4 s[0:3], s[2:3], 0x0    ; f4080001\n"
                                  "\tv_mul_f32_e32 v1, v0, v0              ; 10020100\n"
                                  "\tv_exp_f32_e32 v1, v1                  ; 7e024b01\n"
                                  "\tv_pk_fma_f16 v1, v1, v1, v1           ; cc0e4001\n"
                                  "\tv_dual_mul_f32 v0, v1, v2 :: v_dual_add_f32 v3, v4, v5\n"
                                  "\tv_rsq_f16_e32 v1, v1\n"
                                  "\tv_nop\n"
                                  "\tbuffer_store_dword v1, v0, s[4:7], 0 offen\n"
                                  "\ts_endpgm");
    CHECK(count.plain == 3);
    CHECK(count.transcendental == 2);
}
