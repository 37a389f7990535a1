//% for scalar in scalars
#ifndef ${scalar.guard}
#define ${scalar.guard}
// smoothstep; where its edges meet or cross it is the step x > a.
${scalar.type} ${name}(${scalar.type} a, ${scalar.type} b, ${scalar.type} x)
{
    const ${scalar.type} t = clamp((x - a) / max(b - a, ${width}), ${zero}, ${one});
    return t * t * (${three} - ${two} * t);
}
#endif
//% end
//% for vector in vectors
#ifndef ${vector.guard}
#define ${vector.guard}
${vector.type} ${name}(${vector.type} a, ${vector.type} b, ${vector.type} x)
{
    return ${vector.type}(
//% for part in vector.parts
        ${name}(a.${part.letter}, b.${part.letter}, x.${part.letter})${part.comma}
//% end
    );
}
#endif
//% end
