//% # A pixel shader around a generated file, for compilers to judge.
//% for line in prelude
${line.text}
//% end
//@ artifact

float4 main(float frame_x : TEXCOORD0) : SV_Target0
{
    float frame_sum = 0.0;
//% for call in calls
    ${call.text}
//% end
    return (float4)frame_sum;
}
