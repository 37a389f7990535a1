// What of a term can be approximated: the parts that depend on one or two scalars alone.
//
// A term of one or two bounded scalars is one part. In others, parts are the largest such
// expressions: (1 - cos_d)^5 of a Fresnel term, whatever its colors.
#pragma once

#include "ir/module.h"

#include <cstdint>
#include <vector>

namespace lobe::analyze {

struct Part {
    ir::ExprId root;                    ///< in the term's graph
    std::vector<std::uint32_t> inputs;  ///< of the term; one or two
    ir::Function function;              ///< of those inputs alone; its range is what the term's
                                        ///< other expressions may rely on
};

/// In order of expressions. A call that is not the whole term is none: its callee has parts.
std::vector<Part> parts_of(const ir::Module& module, ir::FunctionId term);

}  // namespace lobe::analyze
