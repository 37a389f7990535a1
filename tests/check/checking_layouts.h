// Checking packings against the small engine and model of tests/diagnostics.
#pragma once

#include "check/checking.h"

namespace lobe::tests {

/// `text` follows the imports of the model `cloth` and the gbuffer `console`.
Checked check_layout(const std::string& text);

/// What the only error says: its id, message, labels, notes, helps, fix, one line each. The test
/// fails if there is not exactly one.
std::string only_error(const Checked& checked);

/// Everything one diagnostic says, one line each.
std::string words(const Diagnostic& diagnostic);

/// The text of a file; the test fails if there is none. Tests run in tests/.
std::string file_text(const std::string& path);

}  // namespace lobe::tests
