//% for scalar in scalars
#ifndef ${scalar.guard}
#define ${scalar.guard}
// x^y for x >= 0, and 1 where y is 0: an x below the least normal number counts as that.
${scalar.type} ${name}(${scalar.type} x, ${scalar.type} y)
{
    return pow(max(x, ${least}), y);
}
#endif
//% end
//% for vector in vectors
#ifndef ${vector.guard}
#define ${vector.guard}
${vector.type} ${name}(${vector.type} x, ${vector.type} y)
{
    return ${vector.type}(
//% for part in vector.parts
        ${name}(x.${part.letter}, y.${part.letter})${part.comma}
//% end
    );
}
#endif
//% end
