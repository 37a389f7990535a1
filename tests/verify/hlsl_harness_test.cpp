// The spellings of a compute harness that each front end takes, and that a Vulkan device runs.
//
// HLSL through glslang: `[[vk::binding(b, set)]]` before a StructuredBuffer, and
// `[[vk::push_constant]]` before a `cbuffer` (or a `ConstantBuffer<Push>`; before a bare
// struct variable it is ignored and the variable lands in a uniform block). ESSL 3.10 and GLSL 4.50
// under Vulkan rules take the same std430 buffers and `layout(push_constant)`; ESSL wants
// `precision highp float;`. float16 is GLSL only, with
// GL_EXT_shader_explicit_arithmetic_types_float16: buffers stay float and values are converted.
#include "verify/harness_texts.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

using namespace lobe::verify;

TEST_CASE("each front end takes its spelling of the compute harness")
{
    for (const HarnessText& harness : harness_texts) {
        CAPTURE(harness.name);
        const Verdict compiled = compile(harness.text, harness.dialect, Stage::compute);
        for (const Message& message : compiled.messages) UNSCOPED_INFO(message.text);
        REQUIRE(compiled.accepted);
        const Verdict valid = validate(compiled.spirv);
        for (const Message& message : valid.messages) UNSCOPED_INFO(message.text);
        CHECK(valid.accepted);
    }
}
