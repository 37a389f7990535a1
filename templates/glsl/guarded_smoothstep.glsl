//% for scalar in scalars
#ifndef ${scalar.guard}
#define ${scalar.guard}
// smoothstep that is the step x > a where its edges meet or cross.
${scalar.type} ${name}(${scalar.type} a, ${scalar.type} b, ${scalar.type} x)
{
    return b > a ? smoothstep(a, b, x) : (x > a ? ${one} : ${zero});
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
