#include "analyze/trade/trade.h"

#include "analyze/tasks.h"
#include "analyze/trade/costs.h"
#include "analyze/trade/lookup.h"
#include "analyze/trade/yardstick.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

namespace lobe::analyze {
namespace {

using optimize::Spelling;

/// So many combinations of forms are evaluated; of more, those of fewest forms.
constexpr double most_combinations = 600;
/// Of more, each gets less attention; what was worst for one is tried on all.
constexpr std::size_t many_ways = 64;

/// In this order: of two that are the same text, the first stays.
constexpr std::array all_spellings{Spelling::stable, Spelling::factored, Spelling::as_written,
                                   Spelling::naive};

/// One choice in all its spellings, as tapes from vectors.
struct Drafted {
    optimize::Choice choice;
    std::array<evaluate::Tape, all_spellings.size()> tapes;
    std::array<std::string, all_spellings.size()> texts;  ///< empty: there is none
};

std::vector<Drafted> draft(const TradeSubject& subject,
                           const std::vector<optimize::Choice>& choices, unsigned jobs)
{
    std::vector<Drafted> all(choices.size());
    for_each_task(choices.size(), jobs, [&](std::size_t i) {
        all[i].choice = choices[i];
        for (std::size_t s = 0; s < all_spellings.size(); ++s) {
            // What a hand would type is a point to compare with, no choice.
            if (all_spellings[s] == Spelling::naive && !choices[i].empty()) continue;
            all[i].tapes[s] = tape_of(subject.spelled(choices[i], all_spellings[s]));
            all[i].texts[s] = evaluate::dump(all[i].tapes[s]);
        }
    });
    return all;
}

/// Everything of a trade but its costs.
class Errors {
public:
    Errors(const TradeSubject& subject, const FoundNames& found, const ParetoOptions& options,
           const Store& store)
        : subject_{subject}, found_{found}, options_{options}, store_{store},
          yardstick_{subject.module(), subject.outputs(), subject.is_model()}
    {
        for (const optimize::Choice& choice : subject.choices(1)) {
            const Spelled chosen = subject.chosen(choice);
            yardstick_.widen(chosen.module, chosen.outputs);
        }
        most_forms_ = subject.alternatives().size();
        while (subject.combinations(most_forms_) > most_combinations) --most_forms_;
    }

    /// Fills in the candidates; which is which goes to the ledger.
    void run(Trade& out, Ledger& ledger)
    {
        std::vector<Drafted> drafts =
            draft(subject_, subject_.choices(most_forms_), options_.cost.jobs);
        const bool half = is_finite_in_half(drafts.front());
        // What is the same text as something before is the same candidate.
        std::vector<Way> ways;
        std::map<std::string, std::size_t> known;  // by text: the first of its candidates
        for (Drafted& drafted : drafts) {
            Way way;
            for (std::size_t s = 0; s < all_spellings.size(); ++s) {
                if (drafted.texts[s].empty()) continue;
                const Spelling spelling = all_spellings[s];
                const auto [at, is_new] =
                    known.try_emplace(drafted.texts[s], out.candidates.size());
                ledger.note(drafted.choice, spelling, at->second);
                if (!is_new) continue;
                add(out, way, drafted, s, Format::float32);
                if (!has_half(drafted.choice, spelling, half)) continue;
                add(out, way, drafted, s, Format::float16);
                add(out, way, drafted, s, Format::packed16);
            }
            if (way.contenders.empty()) continue;
            way.real = std::move(drafted.tapes[0]);
            ways.push_back(std::move(way));
        }
        drafts.clear();
        fill_in(out, ways);
        out.search = words(out, half);
    }

    /// Tables in place of the definition, without costs.
    std::vector<Candidate> tables() const
    {
        return lookup_candidates(subject_, yardstick_, options_);
    }

private:
    /// Where what ships is not finite in half precision, no more care can make it so by less of it;
    /// of a term its forms may be, of a model they are not looked at.
    bool has_half(const optimize::Choice& choice, Spelling spelling, bool half) const
    {
        if (spelling == Spelling::naive) return false;
        if (subject_.is_model()) return spelling == Spelling::stable && (half || choice.empty());
        return half || spelling == Spelling::stable;
    }

    bool is_finite_in_half(const Drafted& definition) const
    {
        DeviationOptions quick;
        quick.points = options_.points / 4;
        quick.climbs = 0;
        quick.jobs = options_.cost.jobs;
        const std::array ways{Way{definition.tapes[0], {{definition.tapes[0], Format::float16}}}};
        return deviations(yardstick_, ways, quick, store_)[0].contenders[0].total.not_finite == 0;
    }

    void add(Trade& out, Way& way, const Drafted& drafted, std::size_t spelling,
             Format format) const
    {
        Candidate& candidate = out.candidates.emplace_back();
        candidate.choice = drafted.choice;
        candidate.spelling = all_spellings[spelling];
        candidate.format = format;
        candidate.found = std::ranges::any_of(
            drafted.choice, [this](const auto& form) { return found_.contains(form); });
        candidate.selectable = candidate.spelling != Spelling::naive && format == Format::float32;
        if (candidate.spelling == Spelling::naive)
            candidate.note = "as typed by hand: for comparison";
        else if (!candidate.selectable)
            candidate.note = "not emitted";
        if (format != Format::packed16) way.contenders.push_back({drafted.tapes[spelling], format});
    }

    void fill_in(Trade& out, const std::vector<Way>& ways) const
    {
        DeviationOptions deviation;
        deviation.points = options_.points;
        deviation.jobs = options_.cost.jobs;
        deviation.progress = options_.progress;
        if (ways.size() > many_ways) {
            deviation.points /= 2;
            deviation.climbs = 1;
            deviation.rounds = 16;
            deviation.every_contender = false;
        }
        const std::vector<Deviations> errors = deviations(yardstick_, ways, deviation, store_);
        std::size_t next = 0;
        for (std::size_t w = 0; w < ways.size(); ++w)
            for (std::size_t k = 0; k < ways[w].contenders.size(); ++k) {
                const int copies = ways[w].contenders[k].format == Format::float16 ? 2 : 1;
                for (int copy = 0; copy < copies; ++copy) {
                    Candidate& candidate = out.candidates[next++];
                    candidate.model = errors[w].model;
                    candidate.rounding = errors[w].contenders[k].rounding;
                    candidate.total = errors[w].contenders[k].total;
                    if (!candidate.choice.empty()) continue;
                    // It is its own exact value, and all that is left is rounding.
                    candidate.model = {};
                    candidate.rounding = candidate.total;
                }
            }
    }

    std::string words(const Trade& out, bool half) const
    {
        const double all = subject_.combinations(subject_.alternatives().size());
        const double evaluated = subject_.combinations(most_forms_);
        std::string text =
            evaluated == all
                ? fmt::format("errors of all {} combinations of forms", all)
                : fmt::format("errors of {} of {} combinations of forms, those of at most {} forms "
                              "(more may be better)",
                              evaluated, all, most_forms_);
        text += fmt::format(", {} ways in all", out.candidates.size());
        if (!half && subject_.is_model())
            text += "; in half only of the definitions, which are not finite in it";
        return text;
    }

    const TradeSubject& subject_;
    const FoundNames& found_;
    const ParetoOptions& options_;
    const Store& store_;
    Yardstick yardstick_;
    std::size_t most_forms_ = 0;
};

/// The rounding of what could be emitted, in both formats that the evaluator has; packed half is
/// half twice.
void prove(Trade& trade, const TradeSubject& subject, const ParetoOptions& options)
{
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
        const Candidate& candidate = trade.candidates[i];
        if (candidate.spelling != Spelling::naive && candidate.format != Format::packed16)
            asked.push_back(i);
    }
    std::mutex mutex;
    Progress progress{0, asked.size(), "proofs"};
    for_each_task(asked.size(), options.cost.jobs, [&](std::size_t task) {
        Candidate& candidate = trade.candidates[asked[task]];
        candidate.proved =
            proved_rounding(subject.spelled(candidate.choice, candidate.spelling),
                            candidate.format == Format::float32 ? evaluate::Precision::float32
                                                                : evaluate::Precision::float16,
                            grey_albedo, options.proof_boxes);
        const std::scoped_lock lock{mutex};
        ++progress.done;
        if (options.progress) options.progress(progress);
    });
    for (std::size_t i = 1; i < trade.candidates.size(); ++i) {
        const Candidate& half = trade.candidates[i - 1];
        Candidate& packed = trade.candidates[i];
        if (packed.format == Format::packed16 && half.format == Format::float16 &&
            half.choice == packed.choice && half.spelling == packed.spelling)
            packed.proved = half.proved;
    }
}

}  // namespace

Trade trade(const TradeSubject& subject, const FoundNames& found, const ParetoOptions& options,
            const Measurer& measurer, const Store& store)
{
    Trade out;
    out.name = subject.name();
    out.whole_model = subject.is_model();
    out.from_vectors = subject.has_geometry();
    Ledger ledger;
    Errors errors{subject, found, options, store};
    errors.run(out, ledger);
    const std::string costs = fill_in_costs(out, subject, ledger, options, measurer);
    if (!costs.empty()) out.search += "; " + costs;
    if (options.proofs && !subject.is_model()) prove(out, subject, options);
    for (Candidate& table : errors.tables()) out.candidates.push_back(std::move(table));
    judge(out);
    return out;
}

bool may_dominate(const Candidate& one, const Candidate& other)
{
    return one.spelling != Spelling::naive && (one.selectable || !other.selectable);
}

void judge(Trade& trade)
{
    const auto stands = [&trade](const Candidate& candidate, Family family) {
        return trade.cost_of(candidate).families.contains(family) &&
               candidate.spelling != Spelling::naive && std::isfinite(trade.error_of(candidate));
    };
    for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
        Candidate& one = trade.candidates[i];
        const double error = trade.error_of(one);
        one.standing.clear();
        for (const auto& [family, measured] : trade.cost_of(one).families) {
            const double cost = measured.issue;
            // Of those that dominate, the cheapest and among them the most accurate: nothing
            // dominates that one.
            std::optional<std::size_t> best;
            for (std::size_t j = 0; j < trade.candidates.size(); ++j) {
                const Candidate& other = trade.candidates[j];
                if (j == i || !may_dominate(other, one) || !stands(other, family)) continue;
                const double its_cost = issue_on(trade.cost_of(other), family);
                const double its_error = trade.error_of(other);
                const bool dominates = its_cost <= cost && its_error <= error &&
                                       (its_cost < cost || its_error < error);
                if (!dominates) continue;
                if (best) {
                    const Candidate& before = trade.candidates[*best];
                    const double least = issue_on(trade.cost_of(before), family);
                    if (its_cost > least ||
                        (its_cost == least && its_error >= trade.error_of(before)))
                        continue;
                }
                best = j;
            }
            one.standing[family] = {!best && stands(one, family), best};
        }
    }
}

}  // namespace lobe::analyze
