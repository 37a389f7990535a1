// Type clauses, signatures and parameters: what declarations say before any body is read.
#pragma once

#include "check/program.h"

namespace lobe::check {

enum class Place {
    argument,
    result,
    parameter
};

/// The type that a clause names, with its range. Nothing if it named none (reported: E0405,
/// E0406, E0505, E0508).
std::optional<DeclaredType> resolve_type(const syntax::Tree& tree, const syntax::TypeClause& clause,
                                         Place place, Diagnostics& diagnostics);

/// The ends of `in [low, high]`, low < high. False if they are no range (reported: E0505, E0508).
bool resolve_range(const syntax::Tree& tree, const syntax::RangeClause& clause, ir::Range& range,
                   Diagnostics& diagnostics);

/// The declared arguments of a term or model. At most one geometry and one surface.
Signature resolve_signature(const syntax::Tree& tree,
                            const std::vector<syntax::ParameterClause>& parameters,
                            const std::optional<syntax::TypeClause>& result,
                            Diagnostics& diagnostics);

/// A `param` of a file. `broken` is set when something about it was reported.
ir::Parameter resolve_parameter(const File& file, const syntax::Item& item,
                                const syntax::ParamItem& param, bool& broken,
                                Diagnostics& diagnostics);

}  // namespace lobe::check
