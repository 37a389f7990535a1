//% # Evaluates functions in chains; see emit/cost_harness.h, which fills it. No lane leaves early:
//% # drivers count what stands behind a branch as run less often.
#version 450
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

//% for input in inputs
uint ${input.name};
//% end

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
uint harness_evaluate(uint harness_link)
{
//% for statement in statements
    ${statement.text}
//% end
    return ${result};
}

void main()
{
    uint harness_index = gl_GlobalInvocationID.x;
//% for input in inputs
    ${input.name} = ${input.value};
//% end
    uint harness_zero = harness_count >> 31u;
//% for chain in chains
    uint ${chain.link} = ${chain.start} & harness_zero;
//% end
//% for step in steps
    ${step.link} = harness_evaluate(${step.link}) & harness_zero;
//% end
    harness_results[harness_index] = uintBitsToFloat(${sum});
}
