#include "cli/choice.h"

#include "cli/settings.h"
#include "emit/listing.h"
#include "optimize/forms.h"
#include "optimize/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lobe::cli {
namespace {

using analyze::Candidate;
using analyze::Trade;
using optimize::Spelling;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string percent_of(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

/// One candidate of every trade, which together are one way to build the module.
using Picks = std::vector<std::size_t>;

/// All ways to build a module, tried one after the other: candidates of its models that agree on
/// the spelling and on the forms of the terms that they share.
class Picking {
public:
    Picking(const analyze::Pareto& pareto, const Limit& limit)
        : trades_{pareto.trades}, limit_{limit}
    {
        for (const Trade& trade : trades_) {
            std::set<std::string>& terms = terms_.emplace_back();
            for (const Candidate& candidate : trade.candidates)
                for (const auto& form : candidate.choice) terms.insert(form.first);
        }
    }

    std::optional<Picks> best()
    {
        extend({}, 0, 0);
        return best_;
    }

    /// The least error and the fewest cycles that are possible at all, of the worst model.
    std::string nearest() const
    {
        double error = 0;
        double cycles = 0;
        for (const Trade& trade : trades_) {
            double least_error = infinity;
            double least_cycles = infinity;
            for (const Candidate& candidate : trade.candidates) {
                if (!is_usable(trade, candidate)) continue;
                least_error = std::min(least_error, trade.error_of(candidate));
                if (std::isfinite(trade.error_of(candidate)))
                    least_cycles = std::min(least_cycles, cycles_of(trade, candidate));
            }
            error = std::max(error, least_error);
            cycles = std::max(cycles, least_cycles);
        }
        return limit_.error ? fmt::format("the least error possible is {}", percent_of(error))
                            : fmt::format("the fewest cycles possible are {:.1f}", cycles);
    }

    /// What each model would take if it were chosen for alone: the fewest cycles of all together,
    /// or the least of the worst error. No joint choice has less.
    double alone() const
    {
        double cycles = 0;
        double error = 0;
        for (const Trade& trade : trades_) {
            double fewest = infinity;
            double least = infinity;
            for (const Candidate& candidate : trade.candidates) {
                if (!fits(trade, candidate)) continue;
                fewest = std::min(fewest, cycles_of(trade, candidate));
                least = std::min(least, trade.error_of(candidate));
            }
            cycles += fewest;
            error = std::max(error, least);
        }
        return limit_.error ? cycles : error;
    }

private:
    bool fits(const Trade& trade, const Candidate& candidate) const
    {
        return is_usable(trade, candidate) && std::isfinite(trade.error_of(candidate)) &&
               trade.error_of(candidate) <= limit_.error.value_or(infinity) &&
               cycles_of(trade, candidate) <= limit_.cycles.value_or(infinity);
    }

    bool is_usable(const Trade& trade, const Candidate& candidate) const
    {
        return candidate.selectable && !trade.cost_of(candidate).families.empty();
    }

    double cycles_of(const Trade& trade, const Candidate& candidate) const
    {
        return analyze::issue_on(trade.cost_of(candidate), limit_.family);
    }

    /// They compute the terms that both models have in one way.
    bool agree(std::size_t a, std::size_t in_a, std::size_t b, std::size_t in_b) const
    {
        const Candidate& one = trades_[a].candidates[in_a];
        const Candidate& other = trades_[b].candidates[in_b];
        if (one.spelling != other.spelling) return false;
        const auto form_of = [](const Candidate& candidate, const std::string& term) {
            const auto found = candidate.choice.find(term);
            return found == candidate.choice.end() ? std::string{} : found->second;
        };
        return std::ranges::all_of(terms_[a], [&](const std::string& term) {
            return !terms_[b].contains(term) || form_of(one, term) == form_of(other, term);
        });
    }

    /// Tries every candidate of the next model with those that were picked before.
    void extend(const Picks& picks, double error, double cycles)
    {
        // The worst error and the sum of cycles only grow.
        const auto order = [&](double e, double c) {
            return limit_.error ? std::pair{c, e} : std::pair{e, c};
        };
        if (best_ && order(error, cycles) >= best_order_) return;
        const std::size_t next = picks.size();
        if (next == trades_.size()) {
            best_ = picks;
            best_order_ = order(error, cycles);
            return;
        }
        const Trade& trade = trades_[next];
        for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
            const Candidate& candidate = trade.candidates[i];
            if (!fits(trade, candidate)) continue;
            bool agrees = true;
            for (std::size_t k = 0; k < next && agrees; ++k) agrees = agree(k, picks[k], next, i);
            if (!agrees) continue;
            Picks more = picks;
            more.push_back(i);
            extend(more, std::max(error, trade.error_of(candidate)),
                   cycles + cycles_of(trade, candidate));
        }
    }

    const std::vector<Trade>& trades_;
    const Limit& limit_;
    std::vector<std::set<std::string>> terms_;  ///< that a candidate of each trade has a form of
    std::optional<Picks> best_;
    std::pair<double, double> best_order_{infinity, infinity};
};

/// `callisto: V_SmithGGX: schlick. 99 % of points are within 0.3 %; 87.5 issue cycles (0.001 % and
/// 112.0 as defined).`
std::string line_of(const Trade& trade, const Candidate& candidate, analyze::Family family)
{
    const Candidate& definition = trade.candidates.front();
    return fmt::format("{}: {}. {} {}; {:.1f} issue cycles ({} and {:.1f} as defined).", trade.name,
                       trade.whole_model ? describe(candidate) : candidate.choice.begin()->second,
                       trade.whole_model ? "99 % of points are within" : "Within",
                       percent_of(trade.error_of(candidate)),
                       analyze::issue_on(trade.cost_of(candidate), family),
                       percent_of(trade.error_of(definition)),
                       analyze::issue_on(trade.cost_of(definition), family));
}

/// Forms that the compiler found and nobody chose are not part of what is built.
void hide_found(ir::Module& module, const analyze::Pareto& pareto, const optimize::Choice& choice)
{
    for (ir::Function& function : module.functions) {
        if (function.kind != ir::Function::Kind::form) continue;
        const std::string& term = module[function.form_of].name;
        const auto chosen = choice.find(term);
        const bool is_chosen = chosen != choice.end() && chosen->second == function.form_name;
        if (pareto.is_found(term, function.form_name) && !is_chosen)
            function.kind = ir::Function::Kind::storage;
    }
}

/// The form takes the term's name, and the definition becomes a form of it.
void promote(ir::Module& module, const std::string& term_name, const std::string& form_name)
{
    const auto term = module.find(term_name);
    std::optional<ir::FunctionId> form;
    for (std::size_t i = 0; i < module.functions.size(); ++i)
        if (module.functions[i].form_of == *term && module.functions[i].form_name == form_name)
            form = ir::FunctionId{i};
    for (ir::Function& function : module.functions)
        if (function.form_of == *term) function.form_of = *form;
    ir::Function& definition = module.functions[term->index];
    ir::Function& chosen = module.functions[form->index];
    chosen.kind = ir::Function::Kind::term;
    chosen.name = term_name;
    chosen.form_of = {};
    chosen.form_name.clear();
    definition.kind = ir::Function::Kind::form;
    definition.name = term_name + "_definition";
    definition.form_of = *form;
    definition.form_name = "definition";
}

/// How far a joint choice may be from the best one; empty where it is the best.
std::string apart_from(double alone, double joint, const Limit& limit)
{
    if (!(joint > alone)) return {};
    return limit.error ? fmt::format("The models share their terms: chosen for one by one they "
                                     "would take {:.1f} issue cycles, not {:.1f}.",
                                     alone, joint)
                       : fmt::format("The models share their terms: chosen for one by one they "
                                     "would be within {}, not {}.",
                                     percent_of(alone), percent_of(joint));
}

Chosen choose_for_models(const analyze::Pareto& pareto, const Limit& limit)
{
    Picking picking{pareto, limit};
    const auto picks = picking.best();
    if (!picks) return {std::nullopt, picking.nearest(), {}};
    optimize::Choice choice;
    Spelling spelling{};
    Chosen out;
    std::vector<std::string> remarks;
    double cycles = 0;
    double error = 0;
    for (std::size_t k = 0; k < picks->size(); ++k) {
        const Trade& trade = pareto.trades[k];
        const Candidate& candidate = trade.candidates[(*picks)[k]];
        choice.insert(candidate.choice.begin(), candidate.choice.end());
        spelling = candidate.spelling;
        cycles += analyze::issue_on(trade.cost_of(candidate), limit.family);
        error = std::max(error, trade.error_of(candidate));
        remarks.push_back(line_of(trade, candidate, limit.family));
        out.summary += remarks.back() + "\n";
    }
    if (const std::string apart = apart_from(picking.alone(), limit.error ? cycles : error, limit);
        !apart.empty()) {
        remarks.push_back(apart);
        out.summary += apart + "\n";
    }
    ir::Module module = optimize::choose(pareto.checked, choice);
    hide_found(module, pareto, choice);
    out.module = optimize::spell(module, spelling);
    out.module->remarks = std::move(remarks);
    return out;
}

Chosen choose_for_library(const analyze::Pareto& pareto, const Limit& limit)
{
    optimize::Choice choice;
    Chosen out;
    std::vector<std::string> remarks;
    for (const Trade& whole : pareto.trades) {
        // A file is written in one spelling.
        Trade trade = whole;
        for (Candidate& candidate : trade.candidates)
            candidate.selectable = candidate.selectable && candidate.spelling == Spelling::stable;
        const auto pick = limit.error
                              ? analyze::cheapest_within(trade, limit.family, *limit.error)
                              : analyze::most_accurate_within(trade, limit.family, *limit.cycles);
        if (!pick) {
            const analyze::Pareto alone{pareto.module, {trade}, {}, 0};
            return {std::nullopt,
                    fmt::format("of `{}` {}", trade.name, Picking{alone, limit}.nearest()),
                    {}};
        }
        const Candidate& candidate = trade.candidates[*pick];
        if (candidate.choice.empty()) continue;
        choice.insert(candidate.choice.begin(), candidate.choice.end());
        remarks.push_back(line_of(trade, candidate, limit.family));
        out.summary += remarks.back() + "\n";
    }
    ir::Module module = optimize::choose(pareto.checked, choice);
    hide_found(module, pareto, choice);
    for (const auto& [term, form] : choice) promote(module, term, form);
    out.module = optimize::spell(module, Spelling::stable);
    out.module->remarks = std::move(remarks);
    return out;
}

}  // namespace

std::string understand(const ChoiceRequest& request, Limit& limit)
{
    if (!request.max_error.empty() && !request.budget.empty())
        return "give --max-error or --budget, not both";
    limit.family = request.family.empty() ? default_family : *analyze::find_family(request.family);
    if (!request.max_error.empty()) {
        limit.error = fraction_of(request.max_error);
        if (!limit.error)
            return fmt::format("--max-error takes a share above 0, such as 0.5% or 0.005; got `{}`",
                               request.max_error);
        limit.options = fmt::format("--max-error {:.6g}%", 100 * *limit.error);
    } else {
        limit.cycles = positive_number(request.budget);
        if (!limit.cycles)
            return fmt::format("--budget takes issue cycles above 0, such as 90; got `{}`",
                               request.budget);
        limit.options = fmt::format("--budget {}", *limit.cycles);
    }
    limit.options += fmt::format(" --on {}", analyze::name(limit.family));
    return {};
}

Chosen choose(const ir::Module& checked, const Sources& sources, const Limit& limit, unsigned jobs,
              Progress& progress, const analyze::Store& store)
{
    analyze::ParetoOptions options;
    options.models = !checked.models.empty();
    options.terms = checked.models.empty();
    options.cost.jobs = jobs;
    options.cost.families = {limit.family};
    options.proofs = false;
    options.progress = [&](const analyze::Progress& at) {
        progress.show(fmt::format("{}: {} of {} {}", checked.name, at.done, at.total, at.what));
    };
    options.cost.progress = options.progress;
    const analyze::Pareto pareto = analyze::pareto(checked, sources, options, store);
    if (!pareto.about.no_statistics.empty()) return {std::nullopt, pareto.about.no_statistics, {}};
    Chosen out =
        options.models ? choose_for_models(pareto, limit) : choose_for_library(pareto, limit);
    if (out.module)
        out.module->remarks.insert(out.module->remarks.begin(),
                                   fmt::format("Chosen by: lobec build {} {}",
                                               emit::shown_path(checked.path), limit.options));
    return out;
}

}  // namespace lobe::cli
