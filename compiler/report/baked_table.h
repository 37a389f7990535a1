// What `lobec table` made, as text and JSON: a table and its errors, or fits and theirs.
#pragma once

#include "analyze/environment/analytic_fit.h"
#include "analyze/environment/baked_table.h"
#include "report/table.h"

#include <span>
#include <string>

namespace lobe::report {

/// What is in the table and how to address it, then a row per component: what storing loses, what
/// interpolating loses, both together, and where that is worst.
std::string to_text(const analyze::BakedTable& table, const Look& look);
std::string to_json(const analyze::BakedTable& table);

/// Constants, and how far they are from the integrals.
struct NamedFit {
    std::string name;  ///< `published`, `least mean square`
    analyze::AnalyticFit fit;
    analyze::FitError error;
};

/// A row per fit, then each fit's body for a model file.
std::string to_text(const std::string& subject, std::span<const NamedFit> fits, const Look& look);
std::string to_json(const std::string& subject, std::span<const NamedFit> fits);

}  // namespace lobe::report
