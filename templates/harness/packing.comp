//% # Unpacks and packs over many points: point i is `inputs` floats of binding 0, its results go to
//% # binding 1.  Filled by emit/round_trip.cpp.
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

//@ artifact

void main()
{
    uint harness_index = gl_GlobalInvocationID.x;
    if (harness_index >= harness_count) return;
//% for statement in statements
    ${statement.text}
//% end
}
