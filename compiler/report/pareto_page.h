// Error against cost, drawn: one panel per GPU family, the frontier as a staircase, every point
// with its numbers under the pointer; and the page that has the pictures with their tables.
#pragma once

#include "analyze/pareto.h"
#include "report/document.h"

#include <span>
#include <string>
#include <vector>

namespace lobe::report {

/// A complete `<svg …>` element for a page (its frame has the styles). Candidates on some frontier
/// carry their number, which is their place in the trade, from 1. Empty if nothing has a cost.
std::string trade_picture(const analyze::Trade& trade);

/// The same as a file of its own: styles inside, light and dark.
std::string trade_svg(const analyze::Trade& trade);

/// One section per trade: picture, a row per candidate that is on a frontier or stands for
/// something (the definition, the naive spelling), and the command that prints it again: of the
/// file `path`, with `options` that change what is measured, ` --set gain=1`.
std::vector<Section> pareto_sections(const analyze::Pareto& pareto, const std::string& path,
                                     const std::string& options = {});

}  // namespace lobe::report
