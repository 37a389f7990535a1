#include "report/pareto_page.h"

#include "report/pareto.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

using analyze::Candidate;
using analyze::Trade;

bool is_anywhere_on_a_frontier(const Candidate& candidate)
{
    return std::ranges::any_of(candidate.standing,
                               [](const auto& at) { return at.second.on_frontier; });
}

/// The definition as it ships comes first; the naive spelling shows what care costs.
bool is_shown(const Trade& trade, std::size_t index)
{
    const Candidate& candidate = trade.candidates[index];
    return index == 0 || is_anywhere_on_a_frontier(candidate) ||
           (candidate.spelling == optimize::Spelling::naive && candidate.choice.empty() &&
            candidate.format == analyze::Format::float32) ||
           !trade.whole_model;
}

Table candidate_table(const Trade& trade)
{
    Table table;
    table.columns = {{"", true},      {"form, spelling, format"},
                     {"model", true}, {"rounding", true},
                     {"worst", true}, {"99 %", true},
                     {"codes", true}};
    // Of a model its outputs are proved, not its candidates.
    if (!trade.whole_model) table.columns.insert(table.columns.begin() + 4, {"proved", true});
    for (const analyze::Family family : analyze::all_families)
        table.columns.push_back({std::string{analyze::name(family)}, true});
    table.columns.push_back({"registers", true});
    table.columns.push_back({"SPIR-V", true});
    table.columns.push_back({"on RDNA2"});
    constexpr analyze::Family judged_on = analyze::Family::rdna2;
    for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
        if (!is_shown(trade, i)) continue;
        const Candidate& candidate = trade.candidates[i];
        const analyze::Cost& cost = trade.cost_of(candidate);
        std::vector<Cell> row;
        row.push_back({std::to_string(i + 1), Style::faint});
        row.push_back({analyze::describe(candidate)});
        row.push_back({percent_of(candidate.model.scaled)});
        row.push_back({percent_of(candidate.rounding.scaled)});
        if (!trade.whole_model) row.push_back({proved_of(candidate)});
        if (candidate.total.not_finite > 0)
            row.push_back(
                {fmt::format("NaN at {} %",
                             short_number(100.0 * static_cast<double>(candidate.total.not_finite) /
                                          static_cast<double>(candidate.total.points))),
                 Style::bad});
        else
            row.push_back({percent_of(candidate.total.scaled)});
        row.push_back({percent_of(candidate.total.often)});
        row.push_back({short_number(candidate.total.codes)});
        for (const analyze::Family family : analyze::all_families) {
            const auto standing = candidate.standing.find(family);
            const bool best = standing != candidate.standing.end() && standing->second.on_frontier;
            row.push_back(
                {cost.families.contains(family) ? short_number(issue_on(cost, family)) : "-",
                 best ? Style::strong : Style::plain});
        }
        row.push_back({cost.families.contains(judged_on)
                           ? std::to_string(cost.families.at(judged_on).vgprs)
                           : "-"});
        row.push_back({std::to_string(cost.spirv_instructions)});
        std::string standing = candidate.note;
        if (candidate.standing.contains(judged_on)) {
            const analyze::Standing& at = candidate.standing.at(judged_on);
            if (at.on_frontier)
                standing =
                    candidate.selectable ? "frontier" : "beyond the frontier; " + candidate.note;
            else if (at.dominated_by)
                standing = fmt::format("dominated by {}", *at.dominated_by + 1);
        }
        row.push_back({standing, Style::faint});
        table.rows.push_back(std::move(row));
    }
    return table;
}

Section section_of(const Trade& trade, const std::string& path, const std::string& options)
{
    Section out;
    out.level = 3;
    out.title = trade.name;
    out.paragraphs.push_back(
        {fmt::format("{}{}. Issue cycles of one evaluation, {}; bold on that family's frontier. "
                     "Errors are relative to the exact value or to {} where that is brighter: the "
                     "worst, and what 99 % of points stay below{}.",
                     trade.whole_model ? "The joint choice of forms: " : "", trade.search,
                     trade.from_vectors ? "from vectors" : "given its arguments",
                     trade.whole_model ? "an 18 % grey card lit alike" : "0.18",
                     trade.whole_model ? ", by which frontiers are drawn" : ""),
         Style::faint});
    if (trade.quantization)
        out.paragraphs.push_back(
            {fmt::format("To any of these errors {}; `lobec pack` shows where.",
                         words_of(*trade.quantization)),
             Style::faint});
    if (!trade.proofs.empty())
        out.paragraphs.push_back({words_of(trade.proofs) + ".", Style::faint});
    if (std::string picture = trade_picture(trade); !picture.empty())
        out.pictures.push_back(std::move(picture));
    Table table = candidate_table(trade);
    if (table.rows.size() < trade.candidates.size())
        out.paragraphs.push_back(
            {fmt::format("{} of {} candidates, those on a frontier of some family; `--json` has "
                         "all of them.",
                         table.rows.size(), trade.candidates.size()),
             Style::faint});
    out.tables.push_back(std::move(table));
    out.command = fmt::format("lobec pareto {} --{} {}{}", path,
                              trade.whole_model ? "model" : "term", trade.name, options);
    return out;
}

}  // namespace

std::vector<Section> pareto_sections(const analyze::Pareto& pareto, const std::string& path,
                                     const std::string& options)
{
    std::vector<Section> out;
    Section head;
    head.title = fmt::format("Error against cost: {}", pareto.module);
    head.paragraphs.push_back(
        {pareto.about.no_statistics.empty()
             ? fmt::format("Costs by {}, without the hardware.", pareto.about.driver)
             : fmt::format("No costs per family: {}.", pareto.about.no_statistics),
         Style::faint});
    out.push_back(std::move(head));
    for (const bool whole_model : {true, false})
        for (const Trade& trade : pareto.trades)
            if (trade.whole_model == whole_model) out.push_back(section_of(trade, path, options));
    return out;
}

}  // namespace lobe::report
