//% # Runs one function over many points: point i is `inputs` floats of binding 0, its results go
//% # to binding 1.  Filled by emit/harness.cpp.
${version}
//% for extension in extensions
${extension.text}
//% end
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
void main()
{
    uint harness_index = gl_GlobalInvocationID.x;
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
