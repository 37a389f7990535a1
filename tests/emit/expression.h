// Reads shading-language expressions back, to see what a compiler would see: the same expression
// with every parenthesis written out.
#pragma once

#include "ir/graph.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::tests {

/// `a - b * c` is `(a - (b * c))`. Names found in `locals` are replaced by what they stand for.
std::string fully_parenthesized(const std::string& expression,
                                const std::map<std::string, std::string>& locals);

/// The same form, straight from the graph.
std::string fully_parenthesized(const ir::Graph& graph, ir::ExprId id,
                                const std::vector<std::string>& inputs);

}  // namespace lobe::tests
