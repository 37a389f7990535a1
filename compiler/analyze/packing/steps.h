// A field as a staircase: the values that it tells apart, and what each becomes.
//
// A code is monotone, so all there is to know of encode and decode is where one code ends and the
// next begins (found by bisection between floats, all codes at once) and what every code decodes
// to. Both come from the field's own functions, in float.
#pragma once

#include "ir/module.h"

#include <cstddef>
#include <vector>

namespace lobe::analyze {

struct Steps {
    float low = 0;  ///< the carried range, rounded inwards
    float high = 0;
    std::size_t first = 0;       ///< code of `low`
    std::vector<float> borders;  ///< borders[i]: the least float with code first + i + 1 or more
    std::vector<float>
        values;  ///< values[i]: what code first + i decodes to; one more than borders

    /// Index into `values` of the code that a value gets. Outside the range, that of the nearest
    /// end.
    std::size_t step_of(float value) const;
    float stored(float value) const { return values[step_of(value)]; }
};

/// `field.encode` and `field.decode` are functions of the module, which may have been through
/// optimize.
Steps steps_of(const ir::Module& module, const ir::Field& field);

}  // namespace lobe::analyze
