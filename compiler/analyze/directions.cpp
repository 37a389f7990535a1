#include "analyze/directions.h"

#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator*(double s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector unit(const Vector& a) { return (1 / std::sqrt(dot(a, a))) * a; }

/// Half of the frames are the axes themselves, where mirror images are exact in floats.
Basis any_basis(Random& random)
{
    Basis basis;
    if (random.coin()) return basis;
    basis.z = on_sphere(random);
    const Vector& n = basis.z;
    // Any vector that is not along n, made orthogonal to it.
    const Vector other = std::abs(n.x) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    const Vector side = unit(other + (-dot(other, n)) * n);
    const Vector up{n.y * side.z - n.z * side.y, n.z * side.x - n.x * side.z,
                    n.x * side.y - n.y * side.x};
    // Turned about n by a random angle.
    Vector turn = on_sphere(random);
    turn.z = 0;
    turn = dot(turn, turn) > 1e-6 ? unit(turn) : Vector{1, 0, 0};
    basis.x = turn.x * side + turn.y * up;
    basis.y = -turn.y * side + turn.x * up;
    return basis;
}

Vector above(Random& random, const Basis& basis)
{
    const Vector local = on_sphere(random);
    return basis(local.x, local.y, std::abs(local.z));
}

Vector below(Random& random, const Basis& basis)
{
    const Vector local = on_sphere(random);
    return basis(local.x, local.y, -std::abs(local.z));
}

Vector grazing(Random& random, const Basis& basis)
{
    constexpr std::array cosines{0.0, 1e-4, 0x1p-149, 0x1p-126, 0x1p-24, 1e-7};
    const double cosine = cosines[random.below(cosines.size())];
    Vector side = on_sphere(random);
    side.z = 0;
    side = dot(side, side) > 1e-6 ? unit(side) : Vector{1, 0, 0};
    const double sine = std::sqrt(1 - cosine * cosine);
    return basis(sine * side.x, sine * side.y, cosine);
}

Vector mirrored(const Vector& l, const Vector& h) { return 2 * dot(l, h) * h + -1 * l; }

}  // namespace

Vector Basis::operator()(double a, double b, double c) const { return a * x + (b * y + c * z); }

const Vector& vector_of(const Directional& point, ir::GeometryField field)
{
    switch (field) {
    case ir::GeometryField::l: return point.l;
    case ir::GeometryField::v: return point.v;
    case ir::GeometryField::x: return point.basis.x;
    case ir::GeometryField::y: return point.basis.y;
    default: return point.basis.z;  // an entry point has no other vector than n
    }
}

Vector on_sphere(Random& random)
{
    // By rejection, which needs no trigonometric function.
    for (;;) {
        const Vector candidate{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const double square = dot(candidate, candidate);
        if (square <= 1 && square >= 0x1p-20) return unit(candidate);
    }
}

Directional directions(Random& random, Directions which, double alpha)
{
    Directional out;
    out.basis = any_basis(random);
    const Basis& basis = out.basis;
    switch (which) {
    case Directions::anywhere: {
        const bool up = random.below(8) != 0;
        out.l = up ? above(random, basis) : on_sphere(random);
        out.v = up ? above(random, basis) : on_sphere(random);
        break;
    }
    case Directions::equal: out.l = out.v = above(random, basis); break;
    case Directions::opposed:
        out.l = above(random, basis);
        out.v = -1 * out.l;
        break;
    case Directions::nearly_opposed: {
        out.l = above(random, basis);
        const double angle = random.magnitude(-24, 0);
        out.v = unit(-1 * out.l + angle * on_sphere(random));
        break;
    }
    case Directions::half_is_normal: {
        const Vector local = on_sphere(random);
        out.l = basis(local.x, local.y, std::abs(local.z));
        out.v = basis(-local.x, -local.y, std::abs(local.z));
        break;
    }
    case Directions::near_peak: {
        const Vector tilt = on_sphere(random);
        const double tangent = alpha * (random.coin() ? random.unit() : random.magnitude(-12, 1));
        const Vector h = unit(basis(tangent * tilt.x, tangent * tilt.y, 1));
        out.l = above(random, basis);
        out.v = mirrored(out.l, h);
        break;
    }
    case Directions::along_normal:
        out.l = basis.z;
        out.v = above(random, basis);
        break;
    case Directions::all_along_normal: out.l = out.v = basis.z; break;
    case Directions::light_grazing:
        out.l = grazing(random, basis);
        out.v = above(random, basis);
        break;
    case Directions::view_grazing:
        out.l = above(random, basis);
        out.v = grazing(random, basis);
        break;
    case Directions::both_grazing:
        out.l = grazing(random, basis);
        out.v = grazing(random, basis);
        break;
    case Directions::light_below:
        out.l = below(random, basis);
        out.v = above(random, basis);
        break;
    case Directions::view_below:
        out.l = above(random, basis);
        out.v = below(random, basis);
        break;
    case Directions::both_below:
        out.l = below(random, basis);
        out.v = below(random, basis);
        break;
    }
    return out;
}

}  // namespace lobe::analyze
