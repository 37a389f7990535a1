// Nodes and weights on an interval, dense where an integrand is narrow.
//
// Gauss-Legendre on cells that shrink geometrically towards a point: for an integrand that is
// smooth but for a peak or a root at that point, the error falls exponentially with the nodes.
#pragma once

#include <span>
#include <vector>

namespace lobe::analyze {

struct QuadratureNode {
    double at = 0;
    double weight = 0;
};

/// Gauss-Legendre with `order` nodes in every cell between neighboring ends, which ascend.
std::vector<QuadratureNode> gauss_legendre(std::span<const double> ends, int order);

/// Cells of [low, high] that halve towards each of `points` inside it, down to the size that goes
/// with the point.
struct NarrowPlace {
    double at = 0;
    double finest = 1;
};
std::vector<double> graded_cells(double low, double high, std::span<const NarrowPlace> points);

/// The same cells in this many equal parts each.
std::vector<double> divided(std::span<const double> ends, int parts);

}  // namespace lobe::analyze
