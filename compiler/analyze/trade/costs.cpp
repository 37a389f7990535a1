#include "analyze/trade/costs.h"

#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace lobe::analyze {
namespace {

/// So few are all measured.
constexpr std::size_t always_measured = 64;
/// Off by as much as there is: nobody builds it, however cheap.
constexpr double useless = 1;
/// So few are measured together, though some of them might exclude others.
constexpr std::size_t few = 12;
/// Modules that are held at once while their costs are measured.
constexpr std::size_t batch = 48;
/// How far off an estimate is thought to be at first: cycles, and of the definition's cost.
constexpr double least_margin = 2;
constexpr double margin_share = 0.04;

using FamilyCycles = std::map<Family, double>;

class CostSearch {
public:
    CostSearch(Trade& trade, const TradeSubject& subject, const Ledger& ledger,
               const ParetoOptions& options, const Measurer& measurer)
        : trade_{trade}, subject_{subject}, ledger_{ledger}, options_{options}, measurer_{measurer},
          families_{options.cost.families}, measured_(trade.candidates.size())
    {
    }

    std::string run()
    {
        const std::size_t all = trade_.candidates.size();
        if (!trade_.whole_model || options_.every_cost || all <= always_measured) {
            measure(of([](std::size_t) { return true; }));
            return {};
        }
        measure(single_changes());
        if (trade_.cost_of(trade_.candidates.front()).families.empty()) {
            keep_measured();
            return fmt::format("costs of {} of them", trade_.candidates.size());
        }
        estimate();
        for (;;) {
            const std::vector<std::size_t> left =
                of([this](std::size_t i) { return !measured_[i] && !is_excluded(i); });
            if (left.empty()) break;
            measure(most_promising(left));
            learn();
        }
        const Family told =
            std::ranges::count(families_, Family::rdna2) > 0 ? Family::rdna2 : families_.front();
        const std::size_t count = of([this](std::size_t i) { return measured_[i]; }).size();
        std::string words = fmt::format(
            "costs of {}; every other one is off by more than 100 %, or dominated on every family "
            "by its estimate from single changes, also if that were {:.1f} cycles too high on "
            "{}; the worst of {} estimates that were measured was {:.1f} off",
            count, margin_[told], title(told), compared_, worst_[told]);
        keep_measured();
        return words;
    }

private:
    template <class Wanted>
    std::vector<std::size_t> of(const Wanted& wanted) const
    {
        std::vector<std::size_t> result;
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i)
            if (wanted(i)) result.push_back(i);
        return result;
    }

    /// The definitions in all spellings, and single forms in the stable one; in all formats.
    std::vector<std::size_t> single_changes() const
    {
        return of([this](std::size_t i) {
            const Candidate& candidate = trade_.candidates[i];
            return candidate.choice.empty() || (candidate.choice.size() == 1 &&
                                                candidate.spelling == optimize::Spelling::stable);
        });
    }

    void measure(const std::vector<std::size_t>& candidates)
    {
        for (std::size_t first = 0; first < candidates.size(); first += batch) {
            const std::size_t count = std::min(batch, candidates.size() - first);
            measure_batch(std::span{candidates}.subspan(first, count));
        }
        done_ += candidates.size();
    }

    void measure_batch(std::span<const std::size_t> candidates)
    {
        std::vector<Spelled> spelled(candidates.size());
        for_each_task(candidates.size(), options_.cost.jobs, [&](std::size_t i) {
            const Candidate& candidate = trade_.candidates[candidates[i]];
            spelled[i] = subject_.spelled(candidate.choice, candidate.spelling);
        });
        std::vector<CostSubject> subjects;
        std::vector<Cost*> places;
        const auto ask = [&](std::size_t i, bool from_vectors) {
            Candidate& candidate = trade_.candidates[candidates[i]];
            subjects.push_back(
                {&spelled[i].module, spelled[i].outputs, candidate.format, from_vectors});
            places.push_back(from_vectors ? &candidate.from_vectors : &candidate.cost);
        };
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            // Given its fields it is worth knowing of what ships; frontiers are drawn from vectors.
            const bool ships = trade_.candidates[candidates[i]].format == Format::float32;
            if (!trade_.from_vectors || (!trade_.whole_model && ships)) ask(i, false);
            if (trade_.from_vectors) ask(i, true);
            measured_[candidates[i]] = true;
        }
        Costs costs = measurer_(subjects);
        for (std::size_t i = 0; i < places.size(); ++i) *places[i] = std::move(costs.costs[i]);
    }

    double issue(std::size_t candidate, Family family) const
    {
        return issue_on(trade_.cost_of(trade_.candidates[candidate]), family);
    }

    /// Of all candidates, from what single forms change in the same format.
    void estimate()
    {
        estimates_.resize(trade_.candidates.size());
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i) {
            const Candidate& candidate = trade_.candidates[i];
            const auto format = static_cast<std::size_t>(candidate.format);
            const std::size_t plain = ledger_({}, candidate.spelling) + format;
            const std::size_t stable = ledger_({}, optimize::Spelling::stable) + format;
            for (const Family family : families_) {
                double cycles = issue(plain, family);
                for (const auto& form : candidate.choice) {
                    const std::size_t one = ledger_({form}, optimize::Spelling::stable) + format;
                    cycles += issue(one, family) - issue(stable, family);
                }
                estimates_[i][family] = cycles;
            }
        }
        for (const Family family : families_)
            margin_[family] = std::max(least_margin, margin_share * issue(0, family));
    }

    /// How far estimates were off where both are known. What was wrong is thought to be wrong
    /// again, and a bit more.
    void learn()
    {
        compared_ = 0;
        worst_ = {};
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i) {
            if (!measured_[i] || trade_.candidates[i].choice.size() < 2) continue;
            ++compared_;
            for (const Family family : families_)
                worst_[family] =
                    std::max(worst_[family], std::abs(estimates_[i][family] - issue(i, family)));
        }
        for (const Family family : families_)
            margin_[family] = std::max(margin_[family], 1.25 * worst_[family]);
    }

    /// On every family something that was measured costs less than this can, and errs no more.
    bool is_excluded(std::size_t i) const
    {
        const double error = trade_.error_of(trade_.candidates[i]);
        if (error > useless) return true;
        for (const Family family : families_) {
            const double least = estimates_[i].at(family) - margin_.at(family);
            bool dominated = false;
            for (std::size_t j = 0; j < trade_.candidates.size() && !dominated; ++j)
                dominated = measured_[j] && trade_.error_of(trade_.candidates[j]) <= error &&
                            may_dominate(trade_.candidates[j], trade_.candidates[i]) &&
                            issue(j, family) <= least;
            if (!dominated) return false;
        }
        return true;
    }

    /// Those of `left` that no other of them dominates by estimate, on some family; all, if they
    /// are few.
    std::vector<std::size_t> most_promising(const std::vector<std::size_t>& left) const
    {
        if (left.size() <= few) return left;
        std::vector<std::size_t> result;
        for (const std::size_t i : left) {
            const double error = trade_.error_of(trade_.candidates[i]);
            bool promising = false;
            for (const Family family : families_) {
                const double cycles = estimates_[i].at(family);
                promising = promising || std::ranges::none_of(left, [&](std::size_t j) {
                                const double its_error = trade_.error_of(trade_.candidates[j]);
                                const double its_cycles = estimates_[j].at(family);
                                return may_dominate(trade_.candidates[j], trade_.candidates[i]) &&
                                       its_error <= error && its_cycles <= cycles &&
                                       (its_error < error || its_cycles < cycles);
                            });
            }
            if (promising) result.push_back(i);
        }
        return result;
    }

    void keep_measured()
    {
        std::vector<Candidate> kept;
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i)
            if (measured_[i]) kept.push_back(std::move(trade_.candidates[i]));
        trade_.candidates = std::move(kept);
    }

    Trade& trade_;
    const TradeSubject& subject_;
    const Ledger& ledger_;
    const ParetoOptions& options_;
    const Measurer& measurer_;
    const std::vector<Family>& families_;
    std::vector<bool> measured_;
    std::vector<FamilyCycles> estimates_;
    FamilyCycles margin_;
    FamilyCycles worst_;
    std::size_t compared_ = 0;
    std::size_t done_ = 0;
};

}  // namespace

std::string fill_in_costs(Trade& trade, const TradeSubject& subject, const Ledger& ledger,
                          const ParetoOptions& options, const Measurer& measurer)
{
    return CostSearch{trade, subject, ledger, options, measurer}.run();
}

}  // namespace lobe::analyze
