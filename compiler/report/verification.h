// What `lobec verify` found, as a table, JSON, JUnit XML and a page.
//
// All four read the same results and compute nothing of their own but sums. Text only; whoever
// calls owns the files. Measured times are left out unless asked for, so that equal results give
// equal files.
#pragma once

#include "analyze/verify.h"
#include "report/table.h"

#include <span>
#include <string>
#include <vector>

namespace lobe::report {

using Verifications = std::span<const analyze::Verification>;

/// Sums over modules.
struct Totals {
    std::size_t rows = 0;
    std::size_t failed_rows = 0;
    std::size_t executions = 0;  ///< points times routes, of all rows
    std::size_t outside = 0;
    std::size_t undefined = 0;
    std::size_t verdicts = 0;
    std::size_t refusals = 0;
    std::size_t round_trips = 0;  ///< a packing on a target
    std::size_t failed_round_trips = 0;
    bool ok() const { return failed_rows == 0 && refusals == 0 && failed_round_trips == 0; }
};
Totals totals(Verifications verifications);

/// How many texts for a target a judge accepted and refused; `of` counts none where the judge
/// was never asked.
struct Score {
    std::size_t accepted = 0;
    std::size_t refused = 0;
};
/// One per judge (columns of analyze::judge_names()), for the targets of the verification in
/// their order of appearance.
struct JudgeMatrix {
    std::vector<std::string> targets;
    std::vector<std::vector<Score>> scores;  ///< [target][judge]
};
JudgeMatrix judge_matrix(Verifications verifications);

/// One row per term, target and precision: points, outside, undefined, worst error and where.
Table verification_table(Verifications verifications);

/// The judges' matrix as a table.
Table judge_table(Verifications verifications);

/// One row per packing and target: codes, those that were lost, and for how many the contract
/// allows nothing but the right one. Without packings it has no rows.
Table round_trip_table(Verifications verifications);

/// What was checked, on what, and the outcome: a few lines for the end of a run.
std::string summary(Verifications verifications, const Look& look, bool with_times);

/// What went wrong, one paragraph per finding with its witness; empty if nothing did.
std::string findings(Verifications verifications, const Look& look);

std::string to_json(Verifications verifications, bool with_times);
std::string to_junit(Verifications verifications, bool with_times);

/// A page that needs no other file: inline style and inline SVG, light and dark.
std::string to_page(Verifications verifications, bool with_times);

/// `float32`, `float16`
std::string_view name(emit::Precision precision);
/// The greater of both routes.
const analyze::WorstError& worst_ulp(const analyze::Row& row);
const analyze::WorstError& worst_relative(const analyze::Row& row);
/// `3.2e-7`, `0`
std::string short_number(double value);

}  // namespace lobe::report
