// Modules as the checker leaves them, with the texts that they were made from.
#pragma once

#include "base/source.h"
#include "ir/module.h"

#include <string>

namespace lobe::tests {

struct Checked {
    Sources sources;
    ir::Module module;
};

/// Imports come from models/. Fails the test, with the diagnostics, if the text has errors.
Checked checked_model(const std::string& path);
Checked checked_text(const std::string& text);

}  // namespace lobe::tests
