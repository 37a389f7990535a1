// Directions of light and eye around a normal: anywhere, or where shaders break.
#pragma once

#include "analyze/points.h"
#include "analyze/random.h"

namespace lobe::analyze {

struct Vector {
    double x = 0, y = 0, z = 0;
};

/// A right-handed frame of unit vectors; z is the normal.
struct Basis {
    Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vector operator()(double a, double b, double c) const;
};

struct Directional {
    Basis basis;
    Vector l, v;
};

/// The vector that an entry point has an input for: l, v or one of the frame.
const Vector& vector_of(const Directional& point, ir::GeometryField field);

/// Unit vectors in double. `alpha` says how near `near_peak` is.
Directional directions(Random& random, Directions which, double alpha);

/// Uniform on the sphere.
Vector on_sphere(Random& random);

}  // namespace lobe::analyze
