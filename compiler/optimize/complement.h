// Which arguments of which functions should travel with their complement.
//
// `term F_Schlick(f0: color, cos_d: unit)` computes 1 - cos_d from a number that no longer
// knows it. Its caller has the vectors. So where a function needs one minus an argument, and a
// caller can make that without a subtraction, the argument gets a companion.
#pragma once

#include "ir/module.h"

#include <vector>

namespace lobe::optimize {

/// Per function and input: the function gets an argument that carries one minus this one.
/// Never for a root, whose signature is as it was declared.
using Complements = std::vector<std::vector<bool>>;
Complements find_complements(const ir::Module& module);

/// The expression y when `id` is 1 - y, in any spelling.
std::optional<ir::ExprId> one_minus(const ir::Graph& graph, ir::ExprId id);

/// The stable field that is one minus this input, if there is one.
std::optional<ir::GeometryField> stable_field(const ir::Input& input);

}  // namespace lobe::optimize
