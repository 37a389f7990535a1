// Text to tree: the lexer's tokens in, a `Tree` out, and every syntax error reported.
#pragma once

#include "base/diagnostic.h"
#include "syntax/tree.h"

#include <optional>

namespace lobe::syntax {

/// The tree of one source. Recovers at declarations, so one mistake costs one message; stops
/// after 20 errors and says so. A tree comes back even after errors (failed parts are `Poison`
/// or missing), so that `format` may refuse while `check` reports more; ask `diagnostics`
/// whether it is whole.
///
/// Bounded on hostile input: time and memory are linear in the text, expressions nest at most 256
/// deep and their trees are at most 1024 high, so that recursion over them is safe (E0203), files
/// above 8 MiB are refused (E0003), text that is not UTF-8 is refused (E0002).
Tree parse(const Sources& sources, std::uint32_t source, Diagnostics& diagnostics);

}  // namespace lobe::syntax
