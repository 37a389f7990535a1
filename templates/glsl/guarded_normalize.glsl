//% for vector in vectors
#ifndef ${vector.guard}
#define ${vector.guard}
// v / |v|, and 0 of 0: a square of |v| below the least normal number counts as that.
${vector.type} ${name}(${vector.type} v)
{
    return v * inversesqrt(max(dot(v, v), ${least}));
}
#endif
//% end
