// The whole compiler as three functions of values: front, middle, back. Read compile.cpp first.
#pragma once

#include "base/diagnostic.h"
#include "check/check.h"
#include "emit/emit.h"
#include "ir/module.h"

#include <optional>
#include <vector>

namespace lobe {

/// Text to module. Nothing comes out if anything was wrong with what went in.
std::optional<ir::Module> front(Sources& sources, std::uint32_t root, const check::Loader& loader,
                                Diagnostics& diagnostics);

/// Module to module: what evaluate, emit and verify read. Cannot fail.
ir::Module middle(const ir::Module& module);

/// Module to text, one set of files per target, in the order of the targets.
std::vector<emit::Artifact> back(const ir::Module& module, const Sources& sources,
                                 const std::vector<const emit::Target*>& targets);

}  // namespace lobe
