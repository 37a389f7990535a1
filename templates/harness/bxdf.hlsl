//% # Runs one output of a BxDF under a point light of radiance 1 over many points.
//% for line in prelude
${line.text}
//% end
[[vk::binding(0, 0)]] StructuredBuffer<float> harness_points;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> harness_results;

[[vk::push_constant]] cbuffer HarnessPush
{
    uint harness_count;
};

static uint harness_base;

//% for macro in macros
#define ${macro.name}( GBuffer, Parameters ) ${macro.statements}
//% end
//@ artifact

[numthreads(64, 1, 1)]
void main(uint3 harness_thread : SV_DispatchThreadID)
{
    uint harness_index = harness_thread.x;
    if (harness_index >= harness_count) return;
    harness_base = harness_index * ${stride}u;
    FGBufferData GBuffer = (FGBufferData)0;
//% for load in loads
    ${load.text}
//% end
    FAreaLight AreaLight = (FAreaLight)0;
    AreaLight.LineCosSubtended = 1;
    AreaLight.FalloffColor = 1;
    const float NoL = saturate(dot(N, L));
    FDirectLighting Lighting = ${bxdf}(GBuffer, N, V, L, 1, NoL, AreaLight, (FShadowTerms)0);
//% for store in stores
    harness_results[harness_index * ${store.outputs}u + ${store.component}u] = ${store.value};
//% end
}
