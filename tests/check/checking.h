// Checking short texts in memory, for the tests of this folder.
#pragma once

#include "check/check.h"

#include <map>
#include <string>

namespace lobe::tests {

struct Checked {
    Sources sources;
    Diagnostics diagnostics;
    std::optional<ir::Module> module;

    /// The function of this name; the test fails if there is none.
    const ir::Function& function(std::string_view name) const;
    /// `E0301 E0402`, in source order; warnings are left out.
    std::string errors() const;
    std::string warnings() const;
};

/// Checks a module, with the others by name. `text` is what follows `module m`.
Checked check_text(const std::string& text, const std::map<std::string, std::string>& others = {});

/// `cos_i cos_d gain`
std::string inputs_of(const ir::Function& function);

/// One component of a function's result at a point: one value per scalar input, in order.
double value_at(const ir::Module& module, const ir::Function& function,
                const std::vector<double>& point, int component = 0);

}  // namespace lobe::tests
