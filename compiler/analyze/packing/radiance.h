// What a packing does to the picture: the error of radiance, not of codes.
//
// A point is a pair of directions, a surface and a set of parameters. Its radiance is the sum of
// the model's outputs, once for the exact parameters and once for what the packing makes of them.
// The error of a point is their difference (the largest of the three channels) relative to the
// exact radiance, or, where the pixel is darker than that, to the radiance of an 18 % grey card
// lit alike (0.18 / pi * n.l): relative in highlights, absolute in darks, whatever the exposure.
//
// The worst is found by search, not proved: points over the whole box, every border between two
// codes from both sides, then steps uphill from the worst of them. Equal inputs give equal
// results, whatever the number of threads.
#pragma once

#include "base/diagnostic.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lobe::analyze {

/// The point that reaches the worst error.
struct RadianceWitness {
    std::vector<std::pair<std::string, double>> inputs;  ///< `l.x`, `roughness`, `retroreflection`
    std::vector<std::pair<std::string, double>> stored;  ///< what the packed parameters become
    double exact = 0;                                    ///< radiance of the channel with the error
    double packed = 0;
};

struct RadianceError {
    double worst = 0;    ///< 0.02 is 2 %
    double typical = 0;  ///< the median over the box
    double often = 0;    ///< 95 of 100 points have less
    RadianceWitness witness;
    double codes = 0;        ///< greatest difference on a display over the box, in 8-bit codes
    double often_codes = 0;  ///< 95 of 100 points have less
};

struct PackingErrors {
    struct OfParameter {
        std::uint32_t parameter = 0;
        RadianceError error;  ///< this one stored, all others exact
    };
    std::vector<OfParameter> parameters;
    RadianceError whole;
    std::size_t points = 0;  ///< that were evaluated for `whole`
};

struct RadianceOptions {
    std::size_t points = std::size_t{1} << 16;  ///< before the climb
    unsigned jobs = 0;                          ///< threads; 0: one per core
    bool codes = false;                         ///< also what a display shows of the whole
};

/// `module` has been through optimize. The box is what the fields carry, the declared ranges of
/// all else, and the packing's own `over`. Directions are at least 2^-13 above the horizon. A
/// parameter without a field is at its default, as the engine knows no other value of it, unless
/// `over` gives it a range. Where a model reads alpha beside roughness, it is its square.
PackingErrors packing_errors(const ir::Module& module, const ir::Packing& packing,
                             const RadianceOptions& options = {});

/// The requirements on radiance that a packing does not meet (E0612), each with the input that
/// breaks it.
Diagnostics unmet(const ir::Module& module, const ir::Packing& packing,
                  const PackingErrors& errors);

}  // namespace lobe::analyze
