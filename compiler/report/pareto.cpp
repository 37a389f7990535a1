#include "report/pareto.h"

#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lobe::report {
namespace {

using analyze::Candidate;
using analyze::Deviation;
using analyze::Family;
using analyze::Standing;
using analyze::Trade;

/// Below it a difference over the reals is that of the doubles it was computed in.
constexpr double least_error = 1e-12;

double cycles_of(const Trade& trade, const Candidate& candidate, Family family)
{
    return trade.cost_of(candidate).families.contains(family)
               ? issue_on(trade.cost_of(candidate), family)
               : std::numeric_limits<double>::infinity();
}

bool is_shown(const Trade& trade, std::size_t index, Family family)
{
    const Candidate& candidate = trade.candidates[index];
    return index == 0 || candidate.spelling == optimize::Spelling::naive ||
           !candidate.standing.contains(family) || candidate.standing.at(family).on_frontier;
}

std::string standing_of(const Trade& trade, const Candidate& candidate, Family family)
{
    if (candidate.spelling == optimize::Spelling::naive || !candidate.standing.contains(family))
        return candidate.note;
    const Standing& standing = candidate.standing.at(family);
    std::string text;
    if (standing.on_frontier)
        text = candidate.selectable ? "frontier" : "beyond the frontier";
    else if (standing.dominated_by)
        text = fmt::format("dominated by {}: {}", *standing.dominated_by + 1,
                           describe(trade.candidates[*standing.dominated_by]));
    if (!candidate.note.empty()) text += (text.empty() ? "" : "; ") + candidate.note;
    return text;
}

std::string not_finite(const Deviation& total)
{
    const double share = static_cast<double>(total.not_finite) / static_cast<double>(total.points);
    return fmt::format("NaN, inf at {} %", short_number(100 * share));
}

}  // namespace

std::string percent_of(double fraction)
{
    if (fraction < least_error) return "0";
    return fmt::format("{} %", short_number(100 * fraction));
}

std::string proved_of(const Candidate& candidate)
{
    if (!candidate.proved) return "";
    if (!std::isfinite(candidate.proved->bound)) return "none";
    return percent_of(candidate.proved->bound) + (candidate.proved->over.empty() ? "" : " in part");
}

std::string words_of(const analyze::Quantization& quantization)
{
    return fmt::format("its packing adds up to {}, or {} codes; 95 % of points stay below {}, or "
                       "{} codes",
                       percent_of(quantization.worst), short_number(quantization.codes),
                       percent_of(quantization.often), short_number(quantization.often_codes));
}

std::string words_of(const std::vector<analyze::Proof>& proofs)
{
    std::string text = "rounding of the definition, proved where its fields are exact:";
    for (const analyze::Proof& proof : proofs)
        text +=
            fmt::format("{} {} within {} (worst found: {})", &proof == &proofs.front() ? "" : ",",
                        proof.function, short_number(proof.ieee.absolute),
                        short_number(proof.ieee.observed_absolute));
    return text;
}

Table trade_table(const Trade& trade, Family family, bool all)
{
    Table table;
    table.columns = {{"", true},
                     {"form; spelling; format"},
                     {"model", true},
                     {"rounding", true},
                     {"worst", true},
                     {"99 %", true},
                     {"median", true},
                     {"codes", true},
                     {std::string{analyze::name(family)}, true},
                     {"regs", true},
                     {""}};
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < trade.candidates.size(); ++i)
        if (all || !trade.whole_model || is_shown(trade, i, family)) order.push_back(i);
    std::ranges::stable_sort(
        order, {}, [&](std::size_t i) { return cycles_of(trade, trade.candidates[i], family); });
    for (const std::size_t i : order) {
        const Candidate& candidate = trade.candidates[i];
        const bool best =
            candidate.standing.contains(family) && candidate.standing.at(family).on_frontier;
        const Style style = best ? Style::strong : Style::plain;
        const analyze::Cost& cost = trade.cost_of(candidate);
        const bool finite = candidate.total.not_finite == 0;
        const bool has_cost = cost.families.contains(family);
        table.rows.push_back(
            {{std::to_string(i + 1), Style::faint},
             {describe(candidate), style},
             {percent_of(candidate.model.scaled)},
             {percent_of(candidate.rounding.scaled)},
             {finite ? percent_of(candidate.total.scaled) : not_finite(candidate.total),
              finite ? Style::plain : Style::bad},
             {percent_of(candidate.total.often)},
             {percent_of(candidate.total.typical)},
             {fmt::format("{:.1f}", candidate.total.codes)},
             {has_cost ? fmt::format("{:.1f}", cost.families.at(family).issue) : "-", style},
             {has_cost ? std::to_string(cost.families.at(family).vgprs) : "-"},
             {standing_of(trade, candidate, family), best ? Style::good : Style::faint}});
        // Of a model its outputs are proved, not its candidates.
        if (!trade.whole_model)
            table.rows.back().insert(table.rows.back().begin() + 4, Cell{proved_of(candidate)});
    }
    if (!trade.whole_model) table.columns.insert(table.columns.begin() + 4, {"proved", true});
    return table;
}

std::string to_text(const analyze::Pareto& pareto, Family family, bool all, std::string_view path,
                    std::string_view options, const Look& look)
{
    std::string text;
    for (const Trade& trade : pareto.trades) {
        const Table table = trade_table(trade, family, all);
        text +=
            styled(fmt::format("{}{}: {}", pareto.module.empty() ? "" : pareto.module + ", ",
                               trade.whole_model ? fmt::format("model {}", trade.name) : trade.name,
                               trade.search),
                   Style::strong, look.color);
        text += fmt::format("\n{}", render(table, look));
        if (table.rows.size() < trade.candidates.size())
            text += fmt::format("{} of {} candidates: those on the frontier of {}\n",
                                table.rows.size(), trade.candidates.size(), analyze::title(family));
        if (trade.quantization) text += words_of(*trade.quantization) + "\n";
        if (!trade.proofs.empty()) text += words_of(trade.proofs) + "\n";
        text += styled(fmt::format("lobec pareto {} --{} {}{}", path,
                                   trade.whole_model ? "model" : "term", trade.name, options),
                       Style::faint, look.color);
        text += "\n\n";
    }
    return text;
}

}  // namespace lobe::report
