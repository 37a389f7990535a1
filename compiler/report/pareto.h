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

/// One row per candidate, cheapest first on a family: error over the reals, rounding as
/// observed and as proved, both together, codes on a display, issue cycles, registers, and what
/// dominates it. Numbers in the first column are places in the trade, from 1. Of a whole model only
/// what stands for something: a candidate on this frontier, the definition and the naive spelling;
/// `all` shows everything.
Table trade_table(const analyze::Trade& trade, analyze::Family family, bool all);

/// The tables of all trades with their headings, and after each the command that prints it again.
/// `path` is the file of the module, `options` what was given besides: ` --on gcn4`.
std::string to_text(const analyze::Pareto& pareto, analyze::Family family, bool all,
                    std::string_view path, std::string_view options, const Look& look);

/// `0.034 %`; `0` where a difference over the reals is no more than that of the doubles it was
/// computed in.
std::string percent_of(double fraction);
/// The bound of a candidate's rounding: `1.2e-05 %`, of half perhaps `0.4 % in part`, or `none`.
std::string proved_of(const analyze::Candidate& candidate);
/// `its packing adds up to 18.7 % or 48.2 codes; 4.3 % or 6.1 codes below which 95 % stay`
std::string words_of(const analyze::Quantization& quantization);
/// `rounding, proved with exact fields: diffuse within 0.86 (0.12 found), …`
std::string words_of(const std::vector<analyze::Proof>& proofs);

std::string to_json(std::span<const analyze::Pareto> paretos);

}  // namespace lobe::report
