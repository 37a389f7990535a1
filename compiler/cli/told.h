// What `lobec build --explain` says: which rule or guard was used where, why, and what it gained.
#pragma once

#include "cli/program.h"

#include <string>

namespace lobe::cli {

/// A text per module: for every function that is emitted its float error as written and as
/// emitted, then what the passes did to it and which guards they left out, in the order written.
std::string told(const Program& program);

}  // namespace lobe::cli
