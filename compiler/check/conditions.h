// Conditions over a gbuffer's settings, decided for every configuration at once.
//
// `static_lighting == on and version >= v4_26` becomes the set of configurations where it holds;
// what comes after asks sets, never expressions.
#pragma once

#include "base/diagnostic.h"
#include "ir/gbuffer.h"
#include "syntax/tree.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::check {

/// Where a condition holds. Settings compare with their own values (== !=, and < <= > >= in the
/// order the values were declared in), joined by `and`, `or`, `not`; anything else is reported
/// (E0614) and gives nothing, as does poison, silently.
std::optional<ir::Configurations> decide(const syntax::Tree& tree, syntax::ExpressionId root,
                                         const ir::Gbuffer& gbuffer, Diagnostics& diagnostics);

/// All configurations, and those outside of a set.
ir::Configurations everywhere(const ir::Gbuffer& gbuffer);
ir::Configurations complement(const ir::Configurations& set);

/// What to write so that only configurations of `good` have to work, as clauses of a packing:
/// `supports version == v4_26, v4_27`. A largest box of settings inside `good` around its member
/// nearest to the engine's own configuration. Empty if `supported` and `good` have none in common.
std::vector<std::string> narrowing(const ir::Gbuffer& gbuffer, const ir::Configurations& supported,
                                   const ir::Configurations& good);

/// `where r.AllowStaticLighting = on`, for a member of a set; `in every configuration` if the set
/// has all of them.
std::string describe_where(const ir::Gbuffer& gbuffer, std::size_t configuration,
                           const ir::Configurations& set);

}  // namespace lobe::check
