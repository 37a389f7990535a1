// One small module per feature of emission, and the file it must become.
#pragma once

#include "emit/modules.h"

#include <string>
#include <vector>

namespace lobe::tests {

struct GoldenCase {
    std::string name;  ///< of the file in golden/, without extension
    std::string target;
    Builder (*build)();
};

const std::vector<GoldenCase>& golden_cases();

/// `golden/ggx.ue4.ush`
std::string golden_path(const GoldenCase& golden);

/// What the compiler makes of it now: the last file of the module, its packings if it has any.
std::string golden_text(const GoldenCase& golden);

}  // namespace lobe::tests
