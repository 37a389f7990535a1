// The models that ship, through the whole pipeline up to emission.
#pragma once

#include "base/source.h"
#include "ir/module.h"

#include <string>

namespace lobe::tests {

struct Shipped {
    ir::Module module;
    Sources sources;
};

/// `models/<name>.lobe`, optimized. Fails the test when it does not compile.
Shipped shipped(const std::string& name);
/// The module of a text of one's own, which may import those.
Shipped written(const std::string& text);

}  // namespace lobe::tests
