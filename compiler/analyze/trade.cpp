#include "analyze/trade.h"

#include "analyze/tasks.h"
#include "analyze/trade_costs.h"
#include "analyze/yardstick.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace lobe::analyze {
namespace {

using optimize::Spelling;

/// So many combinations of forms are evaluated; of more, those of fewest forms.
constexpr double most_combinations = 600;

/// In this order: of two that are the same text, the first stays.
constexpr std::array all_spellings{Spelling::stable, Spelling::factored, Spelling::as_written,
                                   Spelling::naive};

/// Whether a spelling is looked at in half precision, too. Of a whole model only what ships is.
bool has_half(const TradeSubject& subject, Spelling spelling)
{
    return spelling == Spelling::stable || (!subject.is_model() && spelling != Spelling::naive);
}

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

}  // namespace

Trade trade(const TradeSubject& subject, const FoundNames& found, const ParetoOptions& options,
            const Measurer& measurer, const Store& store)
{
    Trade out;
    out.name = subject.name();
    out.whole_model = subject.is_model();
    out.from_vectors = subject.has_geometry();

    std::size_t most_forms = subject.alternatives().size();
    while (subject.combinations(most_forms) > most_combinations) --most_forms;
    std::vector<Drafted> drafts = draft(subject, subject.choices(most_forms), options.cost.jobs);

    Yardstick yardstick{subject.module(), subject.outputs(), subject.is_model()};
    for (const optimize::Choice& choice : subject.choices(1)) {
        const Spelled chosen = subject.chosen(choice);
        yardstick.widen(chosen.module, chosen.outputs);
    }

    // What is the same text as something before is the same candidate.
    std::vector<Way> ways;
    Ledger ledger;
    std::map<std::string, std::size_t> known;  // by text: the first of its candidates
    for (Drafted& drafted : drafts) {
        Way way;
        for (std::size_t s = 0; s < all_spellings.size(); ++s) {
            if (drafted.texts[s].empty()) continue;
            const auto [at, is_new] = known.try_emplace(drafted.texts[s], out.candidates.size());
            ledger.note(drafted.choice, all_spellings[s], at->second);
            if (!is_new) continue;
            for (const Format format : {Format::float32, Format::float16, Format::packed16}) {
                if (format != Format::float32 && !has_half(subject, all_spellings[s])) break;
                Candidate& candidate = out.candidates.emplace_back();
                candidate.choice = drafted.choice;
                candidate.spelling = all_spellings[s];
                candidate.format = format;
                candidate.found = std::ranges::any_of(
                    drafted.choice, [&found](const auto& form) { return found.contains(form); });
                if (format != Format::packed16)
                    way.contenders.push_back({drafted.tapes[s], format});
            }
        }
        if (way.contenders.empty()) continue;
        way.real = std::move(drafted.tapes[0]);
        ways.push_back(std::move(way));
    }
    drafts.clear();

    DeviationOptions deviation;
    deviation.points = options.points;
    deviation.jobs = options.cost.jobs;
    deviation.progress = options.progress;
    if (ways.size() > 64) {
        deviation.points /= 2;
        deviation.climbs = 1;
        deviation.rounds = 16;
    }
    const std::vector<Deviations> errors = deviations(yardstick, ways, deviation, store);
    std::size_t next = 0;
    for (std::size_t w = 0; w < ways.size(); ++w)
        for (std::size_t k = 0; k < ways[w].contenders.size(); ++k) {
            const int copies = ways[w].contenders[k].format == Format::float16 ? 2 : 1;
            for (int copy = 0; copy < copies; ++copy) {
                Candidate& candidate = out.candidates[next++];
                candidate.model = errors[w].model;
                // Where the exact value jumps, no arithmetic lands on the same side every time.
                if (candidate.choice.empty()) candidate.model = {};
                candidate.rounding = errors[w].contenders[k].rounding;
                candidate.total = errors[w].contenders[k].total;
            }
        }
    for (Candidate& candidate : out.candidates) {
        candidate.selectable =
            candidate.spelling != Spelling::naive && candidate.format == Format::float32;
        if (candidate.spelling == Spelling::naive)
            candidate.note = "as typed by hand: for comparison";
        else if (!candidate.selectable)
            candidate.note = "no target is written in half precision";
    }

    const double all = subject.combinations(subject.alternatives().size());
    const double evaluated = subject.combinations(most_forms);
    out.search = evaluated == all
                     ? fmt::format("errors of all {} combinations of forms, {} ways in all", all,
                                   out.candidates.size())
                     : fmt::format("errors of {} of {} combinations of forms, those of at most {} "
                                   "forms, {} ways in all: combinations of more may be better",
                                   evaluated, all, most_forms, out.candidates.size());
    const std::string costs = fill_in_costs(out, subject, ledger, options, measurer);
    if (!costs.empty()) out.search += "; " + costs;
    judge(out);
    return out;
}

void judge(Trade& trade)
{
    for (Candidate& candidate : trade.candidates) {
        candidate.standing.clear();
        candidate.standing.resize(trade.cost_of(candidate).families.size());
    }
    const auto stands = [&trade](const Candidate& candidate, std::size_t family) {
        return family < trade.cost_of(candidate).families.size() &&
               candidate.spelling != Spelling::naive;
    };
    for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
        Candidate& one = trade.candidates[i];
        const double error = trade.error_of(one);
        for (std::size_t family = 0; family < one.standing.size(); ++family) {
            const double cost = trade.cost_of(one).families[family].issue;
            // Of those that dominate, the cheapest and among them the most accurate: nothing
            // dominates that one.
            std::optional<std::size_t> best;
            for (std::size_t j = 0; j < trade.candidates.size(); ++j) {
                const Candidate& other = trade.candidates[j];
                if (j == i || !stands(other, family)) continue;
                const double its_cost = trade.cost_of(other).families[family].issue;
                const double its_error = trade.error_of(other);
                const bool dominates = its_cost <= cost && its_error <= error &&
                                       (its_cost < cost || its_error < error);
                if (!dominates) continue;
                if (best) {
                    const Candidate& before = trade.candidates[*best];
                    const double least = trade.cost_of(before).families[family].issue;
                    if (its_cost > least ||
                        (its_cost == least && its_error >= trade.error_of(before)))
                        continue;
                }
                best = j;
            }
            one.standing[family].dominated_by = best;
            one.standing[family].on_frontier = !best && stands(one, family) && std::isfinite(error);
        }
    }
}

}  // namespace lobe::analyze
