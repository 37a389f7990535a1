// Tables of costs.
#include "report/cost.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

/// `6`, `7.5`: costs are whole but for packed ones and averages over a few evaluations.
std::string number(double value)
{
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

Cell nanoseconds(const std::optional<double>& value)
{
    return {value ? fmt::format("{:.3g}", *value) : ""};
}

bool all_same(const std::vector<CostRow>& rows, std::string CostRow::*member)
{
    return std::ranges::all_of(
        rows, [&](const CostRow& row) { return row.*member == rows.front().*member; });
}

}  // namespace

Table cost_table(const CostReport& report, std::span<const analyze::Family> families)
{
    const auto& rows = report.rows;
    const bool spellings = !all_same(rows, &CostRow::spelling);
    const bool formats = !all_same(rows, &CostRow::format);
    const bool has_families =
        std::ranges::any_of(rows, [](const CostRow& row) { return !row.cost.families.empty(); });
    const bool device = std::ranges::any_of(
        rows, [](const CostRow& row) { return row.cost.device_nanoseconds.has_value(); });
    const bool tape = std::ranges::any_of(
        rows, [](const CostRow& row) { return row.cost.tape_nanoseconds.has_value(); });
    const bool details = has_families && families.size() == 1;

    Table table;
    table.columns = {{"term or model"}};
    if (spellings) table.columns.push_back({"spelling"});
    if (formats) table.columns.push_back({"format"});
    if (details)
        for (const char* const title :
             {"issue", "VALU", "trans", "throughput", "latency", "VGPRs", "waves"})
            table.columns.push_back({title, true});
    else if (has_families)
        for (const analyze::Family family : families)
            table.columns.push_back({std::string{analyze::name(family)}, true});
    table.columns.push_back({"SPIR-V", true});
    if (device) table.columns.push_back({"device ns", true});
    if (tape) table.columns.push_back({"CPU ns", true});

    for (const CostRow& row : rows) {
        auto& cells = table.rows.emplace_back();
        cells.push_back({row.whole_model ? "model " + row.name : row.name,
                         row.whole_model ? Style::strong : Style::plain});
        if (spellings) cells.push_back({row.spelling});
        if (formats) cells.push_back({row.format});
        if (has_families && row.cost.families.empty()) {
            cells.resize(cells.size() + (details ? 7 : families.size()));
        } else if (details) {
            const analyze::FamilyCost& cost = row.cost.families.at(families.front());
            cells.push_back({number(cost.issue), Style::strong});
            for (const double value :
                 {cost.valu, cost.transcendental, cost.inverse_throughput, cost.latency})
                cells.push_back({number(value)});
            cells.push_back({std::to_string(cost.vgprs)});
            cells.push_back({std::to_string(cost.waves)});
        } else if (has_families) {
            for (const analyze::Family family : families)
                cells.push_back({number(analyze::issue_on(row.cost, family))});
        }
        cells.push_back({std::to_string(row.cost.spirv_instructions)});
        if (device) cells.push_back(nanoseconds(row.cost.device_nanoseconds));
        if (tape) cells.push_back(nanoseconds(row.cost.tape_nanoseconds));
    }
    return table;
}

}  // namespace lobe::report
