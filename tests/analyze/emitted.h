// Modules as they ship, with the texts that they were made from.
#pragma once

#include "base/source.h"
#include "ir/module.h"

#include <string>

namespace lobe::tests {

struct Emitted {
    Sources sources;
    ir::Module module;  ///< through optimize
};

/// models/<name>.lobe; read once.
const Emitted& emitted_model(const std::string& name);
/// A text, which may import shipped models. Fails the test, with the diagnostics, if it has errors.
Emitted emitted_text(const std::string& text);

}  // namespace lobe::tests
