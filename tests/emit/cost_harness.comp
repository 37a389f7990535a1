#version 450
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer HarnessPoints
{
    float harness_points[];
};

layout(std430, set = 0, binding = 1) writeonly buffer HarnessResults
{
    float harness_results[];
};

layout(push_constant) uniform HarnessPush
{
    uint harness_count;
};

uint harness_x0;
uint harness_x1;
uint harness_x2;
uint harness_x3;
uint harness_x4;

// Expects f0 in [0, 1].
// models/sample.lobe:3
vec3 F_Schlick(vec3 f0, float VoH)
{
    float one_minus_VoH = 1.0 - VoH;
    return f0 + (1.0 - f0) * (one_minus_VoH * one_minus_VoH);
}

// Expects flag in [0, 1].
// models/sample.lobe:9
float gated(bool flag, float VoH)
{
    return flag ? VoH : 0.25;
}

uint harness_evaluate(uint harness_link)
{
    vec3 f0 = vec3(uintBitsToFloat(harness_x0 ^ harness_link), uintBitsToFloat(harness_x1 ^ harness_link), uintBitsToFloat(harness_x2 ^ harness_link));
    float VoH = uintBitsToFloat(harness_x3 ^ harness_link);
    bool flag = (harness_x4 ^ harness_link) != 0u;
    vec3 result = F_Schlick(f0, VoH);
    float result_2 = gated(flag, VoH);
    return max(max(max(floatBitsToUint(result.x), floatBitsToUint(result.y)), floatBitsToUint(result.z)), floatBitsToUint(result_2));
}

void main()
{
    uint harness_index = gl_GlobalInvocationID.x;
    harness_x0 = floatBitsToUint(harness_points[harness_index * 5u + 0u]);
    harness_x1 = floatBitsToUint(harness_points[harness_index * 5u + 1u]);
    harness_x2 = floatBitsToUint(harness_points[harness_index * 5u + 2u]);
    harness_x3 = floatBitsToUint(harness_points[harness_index * 5u + 3u]);
    harness_x4 = floatBitsToUint(harness_points[harness_index * 5u + 4u]);
    uint harness_zero = harness_count >> 31u;
    uint harness_link_0 = harness_index + 0u & harness_zero;
    harness_link_0 = harness_evaluate(harness_link_0) & harness_zero;
    harness_link_0 = harness_evaluate(harness_link_0) & harness_zero;
    harness_results[harness_index] = uintBitsToFloat(harness_link_0);
}
