// From the root file to all files: parsing, following imports, refusing cycles.
#pragma once

#include "check/check.h"
#include "check/program.h"

namespace lobe::check {

/// Parses the root and everything it imports, each module once, imported files first. Reports
/// modules that cannot be found (E0303) and cycles with their chain (E0305).
void load_files(Program& program, Sources& sources, std::uint32_t root, const Loader& loader,
                Diagnostics& diagnostics);

}  // namespace lobe::check
