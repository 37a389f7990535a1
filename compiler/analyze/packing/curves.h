// Curves: the worst error of one parameter by bits, with the best code for each.
//
// A code is considered where every value that has to survive lies on it. Candidates are compared by
// a short search each; the two best of each number of bits then by a longer one, which starts from
// every bad point that any candidate of the parameter has shown.
#pragma once

#include "analyze/packing/radiance_search.h"
#include "analyze/packing/suggest.h"

#include <cstdint>
#include <vector>

namespace lobe::analyze {

/// A parameter to be placed. All of its components get the same bits and the same code.
struct Placed {
    std::uint32_t parameter = 0;
    int components = 1;
    ir::Range range{};                ///< to be carried
    std::vector<ir::Field> declared;  ///< fields of the source whose codes are declared: what
                                      ///< survives is known for their bits
    std::vector<std::size_t> coordinates{};  ///< per component: where it is in the box
};

/// All that a search for codes needs to know.
struct CodeSearch {
    ir::Module bare;      ///< parameters, and the functions of declared codes
    ir::Packing packing;  ///< model, measured ranges, required values; no fields
    std::vector<Placed> placed;
    RadianceBox box;
};

/// `module` as checked. Parameters that are neither placed nor measured are at their defaults.
CodeSearch subject_of(const ir::Module& module, const ir::Packing& from,
                      std::vector<Placed> placed);

/// One option: so many bits with this code, and the point where it is worst.
struct Fitted {
    CurvePoint point;
    std::vector<Steps> steps;  ///< per component
    Peak peak{};
};
using FittedCurve = std::vector<Fitted>;  ///< by bits, each once

/// A field of a parameter's component, without a place.
ir::Field field_of(const Placed& placed, int component, const CurvePoint& point);

/// The curves of these placed parameters (indices), for so many bits each.
struct BitRange {
    int least = 1;
    int most = 0;
};
std::vector<FittedCurve> fit_curves(const CodeSearch& subject,
                                    const std::vector<std::size_t>& which, BitRange bits,
                                    unsigned jobs);

}  // namespace lobe::analyze
