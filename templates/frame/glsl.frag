//% # A fragment shader around a generated file, for compilers to judge.
${version}
${location}in ${precision}float frame_x;
${location}out ${precision}vec4 frame_color;
//@ artifact

void main()
{
    ${precision}float frame_sum = 0.0;
//% for call in calls
    ${call.text}
//% end
    frame_color = vec4(frame_sum);
}
