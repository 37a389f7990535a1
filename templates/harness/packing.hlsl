//% # Unpacks and packs over many points: point i is `inputs` floats of binding 0, its results go to
//% # binding 1.  Filled by emit/round_trip.cpp.
//% for line in prelude
${line.text}
//% end
[[vk::binding(0, 0)]] StructuredBuffer<float> harness_points;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> harness_results;

[[vk::push_constant]] cbuffer HarnessPush
{
    uint harness_count;
};

//@ artifact

//% for structure in structures
struct FHarnessParameters
{
//% for member in structure.members
    ${member.type} ${member.name};
//% end
};

//% end
[numthreads(64, 1, 1)]
void main(uint3 harness_thread : SV_DispatchThreadID)
{
    uint harness_index = harness_thread.x;
    if (harness_index >= harness_count) return;
//% for statement in statements
    ${statement.text}
//% end
}
