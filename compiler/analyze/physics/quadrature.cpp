#include "analyze/physics/quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

/// Nodes on [-1, 1]: the roots of the Legendre polynomial, by Newton's method from the estimate
/// cos(pi (i + 3/4) / (n + 1/2)). [Abramowitz64] 25.4.29
std::vector<QuadratureNode> legendre(int order)
{
    std::vector<QuadratureNode> nodes;
    for (int i = 0; i < order; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (order + 0.5));
        double slope = 1;
        for (int step = 0; step < 8; ++step) {
            double before = 1, value = x;
            for (int k = 2; k <= order; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            slope = order * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        nodes.push_back({x, 2 / ((1 - x * x) * slope * slope)});
    }
    return nodes;
}

}  // namespace

std::vector<QuadratureNode> gauss_legendre(std::span<const double> ends, int order)
{
    const std::vector<QuadratureNode> unit = legendre(order);
    std::vector<QuadratureNode> nodes;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double half = (ends[i + 1] - ends[i]) / 2;
        const double middle = ends[i] + half;
        for (const QuadratureNode& node : unit)
            nodes.push_back({middle + half * node.at, half * node.weight});
    }
    return nodes;
}

std::vector<double> graded_cells(double low, double high, std::span<const NarrowPlace> points)
{
    std::vector<double> ends{low, high};
    for (const NarrowPlace& place : points) {
        if (place.at < low || place.at > high) continue;
        ends.push_back(place.at);
        for (double size = (high - low) / 2; size > place.finest / 2; size /= 2)
            for (const double end : {place.at - size, place.at + size})
                if (end > low && end < high) ends.push_back(end);
    }
    std::ranges::sort(ends);
    // Cells of no width, or of next to none where two places grade alike, add nothing.
    const double least = (high - low) * 0x1p-40;
    std::vector<double> out{low};
    for (const double end : ends)
        if (end - out.back() > least) out.push_back(end);
    out.back() = high;
    return out;
}

std::vector<double> divided(std::span<const double> ends, int parts)
{
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        for (int part = 0; part < parts; ++part)
            out.push_back(ends[i] + (ends[i + 1] - ends[i]) * part / parts);
    if (!ends.empty()) out.push_back(ends.back());
    return out;
}

}  // namespace lobe::analyze
