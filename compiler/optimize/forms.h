// Which way every term is computed: a checked module with calls of terms replaced by calls of their
// forms. Comes before `spell` or `optimize`.
#pragma once

#include "ir/module.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::optimize {

/// A term of a module that has forms, its own or an imported one's, and them.
struct Alternatives {
    ir::FunctionId term;
    std::vector<ir::FunctionId> forms;  ///< in their order; the definition is not among them
};

/// Every term with forms that one of `roots` calls, or is; in order of functions.
std::vector<Alternatives> alternatives(const ir::Module& module,
                                       const std::vector<ir::FunctionId>& roots);

/// Form names by the name of their term: `{{"F_Schlick", "spherical_gaussian"}}`.
using Choice = std::map<std::string, std::string>;

/// The module in which every call of a chosen term calls the form instead. Names that are no term
/// or form are ignored: the caller checks them. Terms and forms stay in the module as they are.
ir::Module choose(const ir::Module& module, const Choice& choice);

}  // namespace lobe::optimize
