//% for vector in vectors
#ifndef ${vector.guard}
#define ${vector.guard}
// v / |v|, and 0 where |v| is so small that its square is no normal number.
${vector.type} ${name}(${vector.type} v)
{
    const ${scalar} length_squared = dot(v, v);
    return length_squared >= ${least} ? v * rsqrt(length_squared) : (${vector.type})${zero};
}
#endif
//% end
