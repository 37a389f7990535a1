// The shipped models, compiled, and their terms as functions of columns.
#pragma once

#include "analyze/columns.h"
#include "ir/module.h"

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace lobe::tests {

/// A file of models/ as the checker leaves it: what was written, no pass run.
const ir::Module& definition(const std::string& name);
/// The same after every pass: what is emitted.
const ir::Module& optimized(const std::string& name);

/// The module that a text means, which may import the shipped ones. Fails the test, with the
/// diagnostics, if the text has errors.
ir::Module module_of(const std::string& text);
/// `module_of` after every pass.
ir::Module compiled(const std::string& text);

/// Named columns of equal length.
using Points = std::vector<std::pair<std::string, std::vector<double>>>;

/// A function's results at every point: one column per component of the result. Inputs that have
/// no column take their defaults.
template <class Number>
std::vector<std::vector<Number>> run(const ir::Module& module, const std::string& function,
                                     const Points& points);

}  // namespace lobe::tests
