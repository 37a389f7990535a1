// Error against cost: every way to compute a term, and every joint choice for a model.
//
//   form (definition, written, found)  x  spelling  x  number format
//
// each with its model error over the reals, its rounding error, and its cost on every family. A
// point is dominated on a family where another one costs no more, errs no more, and is better in
// one of the two; what a build cannot emit dominates only its like. For a model the error is end to
// end, on radiance.
#pragma once

#include "analyze/cost/cost.h"
#include "analyze/proof/proof.h"
#include "analyze/trade/deviation.h"
#include "analyze/trade/proved.h"
#include "optimize/forms.h"
#include "optimize/spelling.h"

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lobe::analyze {

/// Where a candidate stands on a family. What cannot be emitted is held against everything, what
/// can only against its like.
struct Standing {
    bool on_frontier = false;
    std::optional<std::size_t> dominated_by;  ///< another candidate of the same list
};

struct Candidate {
    optimize::Choice choice;  ///< form by term; empty: the definition everywhere
    optimize::Spelling spelling{};
    Format format{};
    bool found = false;      ///< a form that the compiler made
    bool selectable = true;  ///< false: shown, but a build cannot emit it (a table, packed half)
    std::string note;        ///< why it is not selectable, or what it is: `table 32 x 32, unorm 16`
    Deviation model;         ///< over the reals
    Deviation rounding;      ///< of the CPU's or the device's evaluation in `format`
    Deviation total;         ///< both together: what is judged
    std::optional<ProvedRounding> proved;  ///< of a term, given its fields
    Cost cost;                             ///< given its fields
    Cost from_vectors;                     ///< with what the fields take
    std::map<Family, Standing> standing;   ///< on the families that were measured
};

std::string describe(const Candidate& candidate);  ///< `F_Schlick: spherical_gaussian; half`

/// What a packing adds to the error of its model, all parameters stored: see packing/radiance.h.
struct Quantization {
    double worst = 0;        ///< greatest scaled error that was found
    double often = 0;        ///< 95 of 100 points of the box have less
    double typical = 0;      ///< the median
    double absolute = 0;     ///< at the worst point
    double codes = 0;        ///< greatest difference on a display over the box, in 8-bit codes
    double often_codes = 0;  ///< 95 of 100 points have less
    std::size_t points = 0;
    std::string at;  ///< inputs of the worst
};

struct Trade {
    std::string name;  ///< of a term or a model
    bool whole_model = false;
    bool from_vectors = false;          ///< see `cost_of`
    std::vector<Candidate> candidates;  ///< the definition, stable, float, is first
    /// What was searched, in words: `all 216 combinations`, or how far from exact it may be.
    std::string search;
    std::optional<Quantization> quantization;  ///< of the model's packing
    /// What is proved of a model's outputs as they ship, in float and given their fields; the
    /// combinations of forms are not proved one by one.
    std::vector<Proof> proofs = {};

    /// The cost that a candidate is judged by.
    const Cost& cost_of(const Candidate& candidate) const
    {
        return from_vectors ? candidate.from_vectors : candidate.cost;
    }
    /// The error that it is judged by: `total.scaled` for a term, `total.often` for a model, whose
    /// box has corners where any finite precision is as good as another; infinite where some result
    /// is not finite.
    double error_of(const Candidate& candidate) const;
};

struct ParetoOptions {
    CostOptions cost;
    std::size_t points = std::size_t{1} << 15;
    /// Proves the rounding of terms, of each way within so many boxes, and of models.
    bool proofs = true;
    std::size_t proof_boxes = std::size_t{1} << 11;
    /// Also the costs of what an estimate excludes from every frontier of a model.
    bool every_cost = false;
    bool terms = true;
    bool models = true;
    std::string only_term;   ///< empty: all
    std::string only_model;  ///< likewise
    /// Imported modules whose terms are left out: they are looked at by themselves.
    std::vector<std::string> elsewhere;
    std::function<void(const Progress&)> progress;
};

struct Pareto {
    std::string module;
    std::vector<Trade> trades;
    Costs about;  ///< drivers and devices; its `costs` are empty
    double seconds = 0;
    ir::Module checked = {};  ///< with the forms that the compiler found
    /// Those, as pairs of term and form.
    std::set<std::pair<std::string, std::string>> found = {};

    bool is_found(const std::string& term, const std::string& form) const
    {
        return found.contains({term, form});
    }
};

/// `checked` has not been through optimize.
Pareto pareto(const ir::Module& checked, const Sources& sources, const ParetoOptions& options,
              const Store& store);

/// The selectable candidate that is cheapest on a family with at most this error (`error_of`), or
/// most accurate within this many issue cycles. Nothing if there is none.
std::optional<std::size_t> cheapest_within(const Trade& trade, Family family, double max_error);
std::optional<std::size_t> most_accurate_within(const Trade& trade, Family family, double cycles);

}  // namespace lobe::analyze
