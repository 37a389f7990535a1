// What `lobec patch` found and did, in words and as JSON.
#pragma once

#include "analyze/agreement/engine_shaders.h"
#include "engine/patch.h"
#include "report/table.h"

#include <string>
#include <vector>

namespace lobe::report {

/// Everything about one run.
struct PatchReport {
    std::string model;  ///< as in the marks: `Callisto`
    engine::Plan plan;
    std::vector<analyze::EngineShaderVerdict> shaders;
    bool reverts = false;
    bool applied = false;

    /// Nothing stands in the way, and no shader is broken.
    bool ok() const;
};

/// A line per file with what happens to it, then a line that sums up.
std::string patch_summary(const PatchReport& report, const Look& look);

/// Every obstacle: file and line, what was seen, the anchor, what to do. Ends with their number.
std::string patch_obstacles(const PatchReport& report, const Look& look);

/// The shaders that do not compile, or of which nothing is known, with the compiler's words. Says
/// that nothing was written if one is broken.
std::string patch_shaders(const PatchReport& report, const Look& look);

std::string patch_json(const PatchReport& report);

}  // namespace lobe::report
