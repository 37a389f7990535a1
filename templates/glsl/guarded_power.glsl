//% for scalar in scalars
#ifndef ${scalar.guard}
#define ${scalar.guard}
// x^y for x >= 0, with 0^0 = 1 and 0^y = 0.
${scalar.type} ${name}(${scalar.type} x, ${scalar.type} y)
{
    return y == ${zero} ? ${one} : (x <= ${zero} ? ${zero} : pow(x, y));
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
