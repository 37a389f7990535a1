// What every file declares and imports: scopes, callables, parameters.
#pragma once

#include "check/program.h"

namespace lobe::check {

/// Fills the scopes of all files, the callables with their signatures, the parameters, and the
/// lists of models, gbuffers and codes.
/// Reports names declared twice (E0302), imports of what is not there (E0304), standard names
/// hidden (E0310), and what is wrong in declarations.
void declare(Program& program, Diagnostics& diagnostics);

/// Warns of imported names that the root never uses (W0301).
void report_unused_imports(const Program& program, Diagnostics& diagnostics);

}  // namespace lobe::check
