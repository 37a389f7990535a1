// Three floats as a vector: what a renderer needs of linear algebra, and no more.
#pragma once

#include "scene/scene.h"

#include <cmath>

namespace lobe::render {

using scene::Vector3;

inline Vector3 operator+(const Vector3& a, const Vector3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector3 operator-(const Vector3& a, const Vector3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector3 operator-(const Vector3& a) { return {-a[0], -a[1], -a[2]}; }
inline Vector3 operator*(const Vector3& a, float s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline float dot(const Vector3& a, const Vector3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector3 cross(const Vector3& a, const Vector3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline float length(const Vector3& a) { return std::sqrt(dot(a, a)); }
/// Of no length: `otherwise`.
inline Vector3 normalized(const Vector3& a, const Vector3& otherwise = {0, 0, 1})
{
    const float size = length(a);
    return size > 0 ? a * (1 / size) : otherwise;
}

/// Two unit vectors across a unit vector, without a jump but at -z.
/// Duff et al. 2017, Building an Orthonormal Basis, Revisited, listing 3.
struct Across {
    Vector3 x, y;
};
inline Across across(const Vector3& n)
{
    const float sign = std::copysign(1.0F, n[2]);
    const float a = -1 / (sign + n[2]);
    const float b = n[0] * n[1] * a;
    return {{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
            {b, sign + n[1] * n[1] * a, -n[1]}};
}

/// A point moved by a matrix, and a direction turned and scaled by it.
inline Vector3 moved(const scene::Matrix& m, const Vector3& p)
{
    Vector3 out;
    for (int row = 0; row < 3; ++row)
        out[row] =
            static_cast<float>(m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]);
    return out;
}
inline Vector3 turned(const scene::Matrix& m, const Vector3& d)
{
    Vector3 out;
    for (int row = 0; row < 3; ++row)
        out[row] = static_cast<float>(m[row] * d[0] + m[4 + row] * d[1] + m[8 + row] * d[2]);
    return out;
}
/// A normal: by the cofactors, which stay right under uneven scales and mirrors.
inline Vector3 turned_normal(const scene::Matrix& m, const Vector3& n)
{
    const Vector3 a = turned(m, {1, 0, 0});
    const Vector3 b = turned(m, {0, 1, 0});
    const Vector3 c = turned(m, {0, 0, 1});
    return cross(b, c) * n[0] + cross(c, a) * n[1] + cross(a, b) * n[2];
}

}  // namespace lobe::render
