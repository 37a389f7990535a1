// Integrals over directions of what a function gives: how much a lobe reflects, and what area its
// facets project to.
//
//   albedo   the integral over light of f cos, for one direction of view: results are f cos
//   facets   the integral over half vectors of D cos, evaluated at l = v = h
//
// Nodes follow the lobe. Light is taken in polar coordinates around the normal, in cells that halve
// towards the mirror direction, the horizon and the circle v.l = 0. Facets are taken in slopes, as
// multiples of alpha, with u = r^2 / (1 + r^2): then GGX is constant in u. [Walter07] eq 33, 35
#pragma once

#include "analyze/physics/emitted_function.h"

#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

struct DirectionNode {
    Vector direction;
    double weight = 0;
};

/// How many nodes: `order` in a cell, cells in `parts`.
struct Fineness {
    int order = 8;
    int parts = 1;
};

/// For integrals over light seen from (sin, 0, cos): of functions as narrow as alpha.
std::vector<DirectionNode> light_nodes(double cos_view, double alpha, bool symmetric,
                                       Fineness fineness);
/// For integrals of D cos over half vectors; the weights have the cosine.
std::vector<DirectionNode> facet_nodes(double alpha_x, double alpha_y, Fineness fineness);

struct HemisphereJob {
    enum class Over {
        light,
        facets,
        nothing  ///< the function is the integral, for this direction of view
    };

    EntryInputs::Values values;  ///< all but the directions
    Over over = Over::light;
    double cos_view = 1;  ///< where not over facets
    double alpha_x = 1;   ///< how narrow it is; of light, the lesser counts
    double alpha_y = 1;
};

struct HemisphereIntegral {
    double value = 0;        ///< of what was emitted; the component that gives most
    double exact = 0;        ///< of the definition, in double
    double uncertainty = 0;  ///< of the quadrature: with half the order, and nodes as floats
};

/// One integral per job, with as many nodes as it takes for about five digits, within reason. Why
/// it could not run, or empty.
std::string integrate(EmittedFunction& function, std::span<const HemisphereJob> jobs,
                      std::vector<HemisphereIntegral>& out);

/// The integral of how far from exact a conforming device may be; infinite where the contract
/// leaves a node undefined.
double allowed_error(const EmittedFunction& function, const HemisphereJob& job);

}  // namespace lobe::analyze
