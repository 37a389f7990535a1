// What a value of a scene can be, wherever on the surface one looks: a factor, times what a
// texture's channels hold, plus an offset.
#pragma once

#include "ir/declarations.h"
#include "scene/scene.h"

#include <vector>

namespace lobe::analyze {

struct Reach {
    std::vector<ir::Range> components;  ///< over the reals; a constant's ends are equal
    /// For shaders, which multiply floats: where an end that is no constant was rounded, moved
    /// outward by what a float factor and a float product can be off.
    std::vector<ir::Range> in_floats;
    bool is_binary = false;  ///< 0 or 1 and nothing between
    bool is_finite = true;
};

Reach reach(const scene::Scene& scene, const scene::Value& value);

ir::Range hull(const ir::Range& a, const ir::Range& b);

/// Everything that a float product of two can be; exact where both are constants.
ir::Range product_in_floats(const ir::Range& a, const ir::Range& b);

/// Where an end is no float, moved outward by what a few operations of a host in float are off.
ir::Range rounded_by_hosts(const ir::Range& range);

/// As optimize/decimal.h has it.
ir::Range in_digits(const ir::Range& range);

}  // namespace lobe::analyze
