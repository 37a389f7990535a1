// What `lobec stability` found, as tables, JSON, JUnit XML and sections of a page.
//
// All read the same results and compute nothing of their own but sums.
#pragma once

#include "analyze/stability.h"
#include "report/document.h"
#include "report/table.h"

#include <span>
#include <string>
#include <vector>

namespace lobe::report {

using Stabilities = std::span<const analyze::Stability>;

/// One row per function: finite or open boxes, the bound of its rounding error by the rules of the
/// CPU and of Vulkan, the worst observed, and what half allows.
Table proof_table(std::span<const analyze::Proof> proofs);

/// One row per hazard of the naive spelling in one number format, with its witness and remedy.
Table hazard_table(const analyze::Stability& stability, evaluate::Precision precision);
/// What is left in the emitted spelling, in float.
Table remaining_table(const analyze::Stability& stability);

/// One row per function: corner points, and what was no number or infinite, by format.
Table corner_table(const analyze::Corners& corners);
/// The boundaries at which something jumps.
Table jump_table(const analyze::Corners& corners);
Table physics_table(std::span<const analyze::PhysicsRow> rows);

/// All tables with their headings, for a terminal.
std::string to_text(const analyze::Stability& stability, const Look& look);
/// The outcome of a run in a few lines.
std::string summary(Stabilities stabilities, const Look& look);

std::string to_json(Stabilities stabilities);
std::string to_junit(Stabilities stabilities);
std::vector<Section> stability_sections(const analyze::Stability& stability,
                                        const std::string& path);
/// The verdict that a page opens with.
Paragraph stability_verdict(Stabilities stabilities);

}  // namespace lobe::report
