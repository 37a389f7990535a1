// `lobec build --max-error` and `--budget`: which forms, in which spelling, a module is built with.
#pragma once

#include "analyze/pareto.h"
#include "cli/cache.h"
#include "cli/program.h"

#include <optional>
#include <string>

namespace lobe::cli {

/// The options as they were given.
struct ChoiceRequest {
    std::string max_error;
    std::string budget;
    std::string family;  ///< empty: `default_family`
    CacheOptions cache;
    unsigned jobs = 0;

    bool is_set() const { return !max_error.empty() || !budget.empty(); }
    bool says_where() const { return !family.empty(); }
};

/// What the options mean.
struct Limit {
    std::optional<double> error;   ///< the cheapest within it
    std::optional<double> cycles;  ///< the most accurate within them
    analyze::Family family{};
    std::string options;  ///< as they are typed: `--max-error 0.5% --on rdna2`
};

/// Empty, or what was not understood.
std::string understand(const ChoiceRequest& request, Limit& limit);

/// The module with the chosen forms, in the chosen spelling, and with remarks that say so; or why
/// nothing fits. The models of a module share its terms: what is chosen is the same for all, and
/// each keeps the limit. Of a library every term is chosen by itself; the definition is then its
/// form `definition`.
struct Chosen {
    std::optional<ir::Module> module;  ///< through `spell`
    std::string why;                   ///< with the nearest that is possible
    std::string summary;               ///< one line per model or changed term
};
Chosen choose(const ir::Module& checked, const Sources& sources, const Limit& limit, unsigned jobs,
              Progress& progress, const analyze::Store& store);

}  // namespace lobe::cli
