// Trees to module: the only stage that can reject a program. Names, types, ranges.
#pragma once

#include "base/diagnostic.h"
#include "ir/module.h"
#include "syntax/tree.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lobe::check {

/// How imported modules are found: given the name and the path of the importing file, adds the
/// text to `sources` and returns its index; nothing when there is no such module. The check
/// itself reads no disk.
using Loader = std::function<std::optional<std::uint32_t>(Sources& sources, std::string_view module,
                                                          std::string_view importing_path)>;

/// The module that one source means, with what it imports. Nothing comes out if anything was
/// wrong with what went in, and everything wrong was reported. Parses `root` and every import
/// (each once); a file's own syntax errors keep its names from being blamed.
std::optional<ir::Module> check(Sources& sources, std::uint32_t root, const Loader& loader,
                                Diagnostics& diagnostics);

}  // namespace lobe::check
