// glslang accepts what is right, rejects what is wrong, and its words and lines arrive.
#include "verify/judge.h"

#include <catch2/catch.hpp>

using namespace lobe::verify;

TEST_CASE("a fragment shader in GLSL 4.50 compiles to SPIR-V that validates")
{
    const Verdict verdict = compile(R"(#version 450
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(min(color, vec3(1.0)), 1.0); }
)",
                                    Dialect::glsl, Stage::fragment);
    REQUIRE(verdict.accepted);
    CHECK(verdict.messages.empty());
    CHECK(validate(verdict.spirv).accepted);
}
