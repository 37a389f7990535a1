// A function's body as the language writes it, for text that people paste into a model.
#pragma once

#include "ir/module.h"

#include <optional>
#include <string>

namespace lobe::analyze {

/// The body as one expression that means the graph, operation by operation: what is shared is
/// written again. Geometry is `g` and surface `s`, as everywhere in models/. Nothing where one
/// expression does not say it: with vectors that are no colors, with divisions that a choice
/// guards, or at more than 4096 characters.
std::optional<std::string> formula_of(const ir::Module& module, const ir::Function& function);

}  // namespace lobe::analyze
