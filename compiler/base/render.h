// Diagnostics to text: for people, for editors, for programs.
//
// The only printer of diagnostics. All forms take the whole collection, print it in source
// order and depend on nothing else, so equal inputs give equal bytes. Nothing is printed when
// there are no diagnostics, except by `render_sarif`, whose log then has no results.
#pragma once

#include "base/diagnostic.h"

#include <string>
#include <string_view>

namespace lobe {

/// For people: message, place, source lines with what was seen underlined, notes, ways out and
/// the corrected line. One blank line between diagnostics. ASCII drawing; `color` adds ANSI
/// escapes. Control characters and bytes that are not UTF-8 in the source show as U+FFFD.
///
///     error[E0501]: divisor of `D` reaches zero
///      --> models/cloth.lobe:5:19
///       |
///     5 |         alpha^2 / (pi * (NoH^2 * (alpha^2 - 1) + 1)^2)
///       |                   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ is 0 at alpha = 0, NoH = 1
///       = note: over its parameters' ranges this divisor lies in [0, 3.14159]
std::string render_text(const Sources& sources, const Diagnostics& diagnostics, bool color = false);

/// For editors: `path:5:19: error[E0501]: divisor of `D` reaches zero`, one line each.
std::string render_short(const Sources& sources, const Diagnostics& diagnostics);

/// For programs: one JSON object per line, with every label, note, help and edit. Lines and
/// columns count from 1, columns in characters; `offset` and `length` are bytes.
std::string render_json(const Sources& sources, const Diagnostics& diagnostics);

/// SARIF 2.1.0 with one run. The rules are the whole registry, the edits are `fixes`.
/// `version` is the tool's, e.g. "0.1.0".
std::string render_sarif(const Sources& sources, const Diagnostics& diagnostics,
                         std::string_view version);

/// `2 errors, 1 warning`; empty when there is neither.
std::string render_count(const Diagnostics& diagnostics);

}  // namespace lobe
