//% # Runs one function over many points: point i is `inputs` floats of binding 0, its results go
//% # to binding 1.  Filled by emit/harness.cpp.
//% for line in prelude
${line.text}
//% end
[[vk::binding(0, 0)]] StructuredBuffer<float> harness_points;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> harness_results;

[[vk::push_constant]] cbuffer HarnessPush
{
    uint harness_count;
};

//% for helper in helpers
${helper.text}

//% end
//% for function in functions
//% for line in function.comment
// ${line.text}
//% end
${function.signature}
{
//% for statement in function.statements
    ${statement.text}
//% end
}

//% end
[numthreads(64, 1, 1)]
void main(uint3 harness_thread : SV_DispatchThreadID)
{
    uint harness_index = harness_thread.x;
    if (harness_index >= harness_count) return;
//% for load in loads
    ${load.text}
//% end
//% for statement in statements
    ${statement.text}
//% end
//% for store in stores
    harness_results[harness_index * ${store.outputs}u + ${store.component}u] = ${store.value};
//% end
}
