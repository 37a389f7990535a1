// What the codes of a packing mean: the values they decode to, in the float arithmetic of a shader.
#pragma once

#include "ir/module.h"

#include <vector>

namespace lobe::analyze {

struct FieldCodes {
    int codes = 0;                 ///< different values; fewer than codes where the end clamps
    double default_value = 0;      ///< of the parameter, for the component that is stored
    int default_code = 0;          ///< what it is stored as
    double default_decoded = 0;    ///< what is read back
    double largest_step = 0;       ///< between values of neighboring codes
    double largest_step_from = 0;  ///< where it begins
    double low = 0;                ///< the values that can come back
    double high = 0;
};

/// One for each field of the packing, whose functions are those of the module.
std::vector<FieldCodes> field_codes(const ir::Module& module, const ir::Packing& packing);

}  // namespace lobe::analyze
