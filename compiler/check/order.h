// In what order bodies are lowered: callees first. What calls itself is refused.
#pragma once

#include "check/program.h"

#include <vector>

namespace lobe::check {

/// A mention of a callable in a body.
struct Reference {
    std::size_t callable = 0;
    Span span;
};

/// The callables that an expression calls, in the order written.
std::vector<Reference> references(const Program& program, const File& file,
                                  syntax::ExpressionId root);

/// A model, gbuffer or code that the root file declares or imports.
bool is_needed(const Program& program, NameKind kind, std::size_t index, std::size_t file);

/// All callables that the root file declares or needs, and the forms of its terms, callees first: a
/// form after its term, and before what calls the term, unless the form needs that itself.
/// Those on a cycle are left out (E0306 is reported, with the chain).
std::vector<std::size_t> lowering_order(const Program& program, Diagnostics& diagnostics);

}  // namespace lobe::check
