// The ladder of effects: what scenes' shaders cost beside the general one, as a table for
// terminals, Markdown and JSON.
#pragma once

#include "analyze/residual/ladder.h"
#include "report/table.h"

#include <string>

namespace lobe::report {

/// One row per shader, the general one last: effects, issue cycles per family, their share of the
/// general shader's, registers, nanoseconds where they were measured.
Table ladder_table(const analyze::Ladder& ladder);
std::string to_text(const analyze::Ladder& ladder, const Look& look);
/// The table alone, to be pasted.
std::string to_markdown(const analyze::Ladder& ladder);
std::string to_json(const analyze::Ladder& ladder);

/// A table as Markdown has it.
std::string to_markdown(const Table& table);

}  // namespace lobe::report
