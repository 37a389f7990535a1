//% for vector in vectors
#ifndef ${vector.guard}
#define ${vector.guard}
// v / |v|, and 0 where |v| is so small that its square is no normal number.
${vector.type} ${name}(${vector.type} v)
{
    ${scalar} square = dot(v, v);
    return square >= ${least} ? v * inversesqrt(square) : ${vector.type}(${zero});
}
#endif
//% end
