// Unified diffs as `git apply` takes them: any line ends, files without a last newline, new files
// and files that go.
#pragma once

#include "engine/patch.h"

#include <string>
#include <vector>

namespace lobe::engine {

/// One diff for all changes, three lines of context, with `a/` and `b/` before the paths and the
/// mode of new files (100644). Empty for no changes.
std::string unified_diff(const std::vector<Change>& changes);

}  // namespace lobe::engine
