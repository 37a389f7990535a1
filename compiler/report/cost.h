// What `lobec cost` found, as tables and JSON, and against what it found before.
//
// All read the same rows and measure nothing of their own.
#pragma once

#include "analyze/cost/cost.h"
#include "report/table.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::report {

struct CostRow {
    std::string module;
    std::string name;  ///< of a term, a form, an output or a model
    bool whole_model = false;
    std::string spelling;  ///< `stable`
    std::string format;    ///< `float`
    analyze::Cost cost;
};

struct CostReport {
    std::vector<CostRow> rows;
    std::string driver;         ///< empty where there are no families' costs
    std::string device;         ///< empty without nanoseconds
    bool from_vectors = false;  ///< with what the fields of the geometry take
};

/// One row per row: for one family everything known of it, for several the issue cycles of each.
/// Spellings and formats are shown where there is more than one of them.
Table cost_table(const CostReport& report, std::span<const analyze::Family> families);

/// The same bytes whenever the rows are the same.
std::string to_json(const CostReport& report);

/// What `to_json` wrote; or why this is nothing of the kind.
std::optional<CostReport> read_costs(std::string_view json, std::string& why);

/// One number of one row, then and now.
struct CostChange {
    std::string what;  ///< `D_GGX`, and its spelling and format where these are not the usual
    double before = 0;
    double now = 0;

    /// 0.02 where it costs 2 % more; infinite where it cost nothing.
    double relative() const;
};

/// What became of one number: issue cycles on a family, or SPIR-V instructions.
struct CostChanges {
    std::string measure;             ///< `issue cycles on RDNA2 (navi21)`
    std::vector<CostChange> hurt;    ///< worst first
    std::vector<CostChange> helped;  ///< best first
    std::size_t unchanged = 0;
    double total_before = 0;  ///< of the rows that are in both
    double total_now = 0;
};

struct CostComparison {
    std::vector<CostChanges> measures;
    std::vector<std::string> added;  ///< rows that there were not, and are not any more
    std::vector<std::string> gone;
    std::string before_driver;  ///< where it is another than now

    /// Anything costs more by more than this share.
    bool regressed(double limit) const;
};

/// Issue cycles on each family that both have cycles of; where that is none, SPIR-V instructions.
CostComparison compare(const CostReport& before, const CostReport& now,
                       std::span<const analyze::Family> families);

/// Like a shader database: what was hurt and helped, by name, and the totals.
std::string to_text(const CostComparison& comparison, const Look& look);

}  // namespace lobe::report
