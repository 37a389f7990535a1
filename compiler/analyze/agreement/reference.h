// What a function must return, point by point: the acceptance interval of its inputs, and the
// exact value to measure quality by.
//
// Computed once per function and precision, and shared by all targets. Two different things:
// acceptance is conformance (derived from the Vulkan precision table, never chosen); the distance
// to the exact value is quality, and is only reported.
//
// The exact value is the same expressions in double, from the same inputs. A double operation
// errs 2^-29 times as much as a float operation, and conditioning multiplies both alike, so the
// error measured against it is right to about eight digits; `confirm` recomputes single points
// with MPFR at 113 bits, and the agreement check does that for every worst point it reports.
#pragma once

#include "analyze/points.h"
#include "evaluate/tape.h"

#include <string>
#include <vector>

namespace lobe::analyze {

/// The results a conforming device may return at every point, for one component of the result.
struct Allowed {
    std::vector<float> low;   ///< least float of the acceptance interval
    std::vector<float> high;  ///< greatest; an infinite end includes the infinity
    std::vector<bool> undefined;
    std::vector<double> exact;
};

struct Reference {
    ir::Function entry;
    evaluate::Tape tape;
    evaluate::Precision precision{};
    Points points;
    std::vector<float> input;  ///< as a harness reads it: the scalars of point 0, of point 1, …
    std::vector<Allowed> outputs;
    std::size_t undefined = 0;  ///< points with at least one undefined component
    double seconds = 0;         ///< for the acceptance intervals
};

Reference reference(const ir::Module& module, ir::FunctionId function,
                    evaluate::Precision precision, std::size_t count);

/// The results at one point with 113-bit operations, one per component.
std::vector<double> confirm(const Reference& reference, std::size_t point);

/// The inputs of one of its points (see points.h).
std::string describe_inputs(const Reference& reference, std::size_t point);

}  // namespace lobe::analyze
