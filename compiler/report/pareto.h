// What `lobec pareto` found, as tables and JSON. Pages and pictures are pareto_page.h's.
//
// All read the same results and compute nothing of their own.
#pragma once

#include "analyze/pareto.h"
#include "report/table.h"

#include <span>
#include <string>
#include <string_view>

namespace lobe::report {

/// One row per candidate, cheapest first on a family: error over the reals, observed rounding, both
/// together, codes on a display, issue cycles, registers, and what dominates it. Numbers in the
/// first column are places in the trade, from 1. Of a whole model only what stands for something: a
/// candidate on this frontier, the definition and the naive spelling; `all` shows everything.
Table trade_table(const analyze::Trade& trade, analyze::Family family, bool all);

/// The tables of all trades with their headings, and after each the command that prints it again.
/// `path` is the file of the module, `options` what was given besides: ` --on gcn4`.
std::string to_text(const analyze::Pareto& pareto, analyze::Family family, bool all,
                    std::string_view path, std::string_view options, const Look& look);

std::string to_json(std::span<const analyze::Pareto> paretos);

}  // namespace lobe::report
