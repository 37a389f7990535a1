// What the options of `lobec pack` mean: names become indices, or a message that says which name
// is unknown and what there is.
#pragma once

#include "analyze/packing/suggest.h"
#include "cli/program.h"
#include "report/packing.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::cli {

/// The options of --suggest as they were given.
struct SearchRequest {
    std::string gbuffer;
    std::vector<std::string> parameters;
    std::vector<std::string> tiers;
    std::vector<std::string> channels;
    std::vector<std::string> without;
    std::optional<int> bits;
    std::string max_error;

    bool is_set() const { return !first_option().empty(); }
    /// `--tier`: the first that was given; empty if none was.
    std::string first_option() const;
};

/// What a search starts from: a packing of a module, in a copy of that module when nothing was
/// written for the gbuffer.
struct Subject {
    const ir::Module* original = nullptr;  ///< checked
    ir::Module module;                     ///< checked, with the packing that is searched from
    std::size_t packing = 0;               ///< index into Module::packings
    bool is_written = false;               ///< it is in the source
    std::vector<std::string> notes;
};

/// Empty, or why there is none.
std::string choose_subject(const Program& program, const std::string& model,
                           const std::string& gbuffer, Subject& subject);

/// Fills parameters, room and error; adds to what the subject's packing goes without. Empty, or
/// what was not understood.
std::string understand(const SearchRequest& request, Subject& subject,
                       analyze::SuggestOptions& options);

/// A packing of an optimized module with everything that is reported of it. Requirements on
/// radiance that it does not meet go to `diagnostics`.
report::Packed measured(const ir::Module& module, const ir::Packing& packing,
                        const analyze::RadianceOptions& options, Diagnostics& diagnostics);

}  // namespace lobe::cli
