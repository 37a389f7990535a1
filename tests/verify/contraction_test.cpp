// NoContraction lands on all arithmetic, once, where it belongs, and holds against spirv-opt.
#include "verify/judge.h"
#include "verify/spirv_words.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

using namespace lobe::verify;

namespace {

/// A compute shader whose function `f` has this body; called twice, so that inlining matters.
std::vector<std::uint32_t> shader(std::string_view body, std::string_view qualifier = "")
{
    std::string text = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };

float f(float x, float y)
{
    )";
    text.append(qualifier).append(" float r;\n    ").append(body).append(R"(
    return r;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results.y[i] = f(points.x[2 * i], points.x[2 * i + 1]);
    results.y[i + count] = f(points.x[2 * i + 1], points.x[2 * i]);
}
)");
    const Verdict verdict = compile(text, Dialect::glsl, Stage::compute);
    for (const Message& message : verdict.messages) UNSCOPED_INFO(message.text);
    REQUIRE(verdict.accepted);
    return verdict.spirv;
}

std::vector<std::uint32_t> optimized(const std::vector<std::uint32_t>& spirv)
{
    Verdict verdict = optimize(spirv);
    REQUIRE(verdict.accepted);
    CHECK(validate(verdict.spirv).accepted);
    return std::move(verdict.spirv);
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> ids)
{
    std::ranges::sort(ids);
    return ids;
}

constexpr std::string_view many_kinds = R"(
    vec3 a = vec3(x, y, x - y);
    mat3 m = outerProduct(a, a) * y;
    r = dot(m * a, a * m) + mod(-x, y) / length(a * x) + mix(x, y, 0.25) * pow(x, y);
)";

}  // namespace

TEST_CASE("every arithmetic result is decorated, and nothing else changes")
{
    const auto plain = shader(many_kinds);
    CHECK(ids_without_contraction(plain).empty());
    const auto strict = forbid_contraction(plain);
    CHECK(validate(strict).accepted);
    constexpr std::size_t words_per_decoration = 3;
    const auto ids = ids_without_contraction(strict);
    CHECK(strict.size() == plain.size() + words_per_decoration * ids.size());
    for (const std::uint32_t op : {op_f_add, op_f_mul, op_f_div, op_dot})
        for (const auto& words : instructions(strict, op))
            CHECK(std::ranges::count(ids, words[2]) == 1);
}

TEST_CASE("it decorates what glslang decorates for precise")
{
    // The same text with `precise`, which glslang carries to everything r is computed from. It
    // leaves out dot, which the specification counts as arithmetic and we decorate.
    constexpr std::string_view body = "r = x * y + x / y - (-x * y) * pow(x, y);";
    const auto precise = shader(body, "precise");
    const auto ids = sorted(ids_without_contraction(precise));
    REQUIRE_FALSE(ids.empty());
    CHECK(sorted(ids_without_contraction(forbid_contraction(shader(body)))) == ids);
    // What has the decoration already gets no second one.
    CHECK((forbid_contraction(precise) == precise));
}

TEST_CASE("forbidding twice is forbidding once")
{
    const auto once = forbid_contraction(shader(many_kinds));
    CHECK((forbid_contraction(once) == once));
}

TEST_CASE("spirv-opt keeps the decorations through inlining")
{
    const auto strict = optimized(forbid_contraction(shader(many_kinds)));
    CHECK_FALSE(ids_without_contraction(strict).empty());
    CHECK((forbid_contraction(strict) == strict));
}

TEST_CASE("spirv-opt cancels a quotient only where contraction is allowed")
{
    const auto quotient = shader("r = (x * y) / x;");
    const auto free = optimized(quotient);
    CHECK(instructions(free, op_f_mul).empty());
    CHECK(instructions(free, op_f_div).empty());
    const auto strict = optimized(forbid_contraction(quotient));
    CHECK(instructions(strict, op_f_mul).size() == 2);  // f is called twice
    CHECK(instructions(strict, op_f_div).size() == 2);
}

TEST_CASE("a product and a sum stay two operations, and constants are not regathered")
{
    const auto strict = optimized(forbid_contraction(shader("r = x * y + x;")));
    CHECK(instructions(strict, op_f_mul).size() == 2);
    CHECK(instructions(strict, op_f_add).size() == 2);
    CHECK(instructions(strict, op_ext_inst).empty());

    const auto constants = shader("r = (x * 3.0) * 0.1;");
    CHECK(instructions(optimized(constants), op_f_mul).size() == 2);
    CHECK(instructions(optimized(forbid_contraction(constants)), op_f_mul).size() == 4);
}

TEST_CASE("what is no SPIR-V comes back as it is")
{
    const std::vector<std::uint32_t> nothing;
    CHECK(forbid_contraction(nothing) == nothing);
    const std::vector<std::uint32_t> noise{0x12345678, 1, 2, 3, 4, 5, 6, 7};
    CHECK(forbid_contraction(noise) == noise);
    auto cut = shader("r = x * y;");
    cut.back() = 0xFFFF0000U | op_f_mul;  // an instruction longer than what is left
    CHECK((forbid_contraction(cut) == cut));
}
