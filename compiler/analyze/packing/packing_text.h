// A packing as its source: what `lobec pack --suggest` prints, ready to be pasted.
#pragma once

#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::analyze {

/// The block in canonical formatting. `remarks` are comments behind the fields, one per field;
/// none, or empty ones, where there is nothing to say.
std::string packing_text(const ir::Module& module, const ir::Packing& packing,
                         const std::vector<std::string>& remarks);

}  // namespace lobe::analyze
