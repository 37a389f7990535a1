// The patch of the 4.27 stand-in tree, as a diff that people can read.
#pragma once

#include <string>

namespace lobe::engine {

inline const std::string golden_path = "engine/golden/4.27.diff";

/// With a line in place of each generated shader: those have goldens of their own.
std::string golden_diff();

}  // namespace lobe::engine
