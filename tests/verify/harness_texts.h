// Compute shaders that double every number of a buffer, once per spelling: floats `x[i]` at
// binding 0, results `2 x[i]` at binding 1, a push constant that bounds `i`.
#pragma once

#include "verify/judge.h"

#include <array>
#include <string_view>

namespace lobe::verify {

struct HarnessText {
    std::string_view name;
    Dialect dialect{};
    bool float16 = false;
    std::string_view text;
};

inline constexpr std::array harness_texts{
    HarnessText{"glsl450", Dialect::glsl, false, R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results.y[i] = 2.0 * points.x[i];
}
)"},
    HarnessText{"glsl450 float16", Dialect::glsl, true, R"(#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    float16_t x = float16_t(points.x[i]);
    results.y[i] = float(2.0hf * x);
}
)"},
    HarnessText{"essl310", Dialect::essl, false, R"(#version 310 es
precision highp float;
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results.y[i] = 2.0 * points.x[i];
}
)"},
    HarnessText{"hlsl", Dialect::hlsl, false,
                R"([[vk::binding(0, 0)]] StructuredBuffer<float> Inputs;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> Outputs;
[[vk::push_constant]] cbuffer Push { uint Count; };

[numthreads(64, 1, 1)]
void main(uint3 Id : SV_DispatchThreadID)
{
    if (Id.x >= Count) return;
    Outputs[Id.x] = 2.0f * Inputs[Id.x];
}
)"},
    HarnessText{"hlsl with ConstantBuffer", Dialect::hlsl, false,
                R"([[vk::binding(0, 0)]] StructuredBuffer<float> Inputs;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> Outputs;
struct Push { uint Count; };
[[vk::push_constant]] ConstantBuffer<Push> Constants;

[numthreads(64, 1, 1)]
void main(uint3 Id : SV_DispatchThreadID)
{
    if (Id.x >= Constants.Count) return;
    Outputs[Id.x] = 2.0f * Inputs[Id.x];
}
)"},
};

}  // namespace lobe::verify
