#include "analyze/environment/sampling.h"

#include <cmath>
#include <numbers>

namespace lobe::analyze {

double radical_inverse(std::uint32_t index)
{
    double result = 0;
    for (double digit = 0.5; index != 0; index >>= 1, digit /= 2)
        if ((index & 1U) != 0) result += digit;
    return result;
}

SquarePoint hammersley(std::uint32_t index, std::uint32_t count)
{
    return {static_cast<double>(index) / static_cast<double>(count), radical_inverse(index)};
}

Vector importance_sample_ggx(SquarePoint at, double alpha)
{
    const double phi = 2 * std::numbers::pi * at.x;
    // cos^2 = (1 - y) / (1 + (alpha^2 - 1) y); its complement directly, since it may be near 1.
    const double bottom = 1 + (alpha * alpha - 1) * at.y;
    const double cosine = std::sqrt((1 - at.y) / bottom);
    const double sine = alpha * std::sqrt(at.y / bottom);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

double density_ggx(double cos_h, double alpha)
{
    const double bottom = (1 - cos_h) * (1 + cos_h) + cos_h * cos_h * alpha * alpha;
    return alpha * alpha / (std::numbers::pi * bottom * bottom);
}

Vector mirrored(const Vector& v, const Vector& h)
{
    const double twice = 2 * dot(v, h);
    return {twice * h.x - v.x, twice * h.y - v.y, twice * h.z - v.z};
}

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector normalized(const Vector& v)
{
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

}  // namespace lobe::analyze
