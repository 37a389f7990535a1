#include "report/ladder.h"

#include "report/markup.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace lobe::report {
namespace {

using analyze::Cost;
using analyze::Family;
using analyze::Ladder;
using analyze::Rung;
using nlohmann::ordered_json;

/// The families that registers are told of: a table has no room for all.
constexpr Family family_of_registers = Family::rdna2;

std::vector<const Rung*> rungs_of(const Ladder& ladder)
{
    std::vector<const Rung*> out;
    for (const Rung& rung : ladder.references) out.push_back(&rung);
    for (const Rung& rung : ladder.scenes) out.push_back(&rung);
    out.push_back(&ladder.general);
    return out;
}

std::string with_share(double value, double general)
{
    const std::string share = general > 0 ? fmt::format(" ({:.2f})", value / general) : "";
    return fmt::format("{:.0f}{}", value, share);
}

std::string nanoseconds(const std::optional<double>& value, const std::optional<double>& general)
{
    if (!value) return "-";
    const std::string share =
        general && *general > 0 ? fmt::format(" ({:.2f})", *value / *general) : "";
    return fmt::format("{:.3g}{}", *value, share);
}

std::string effects_of(const Ladder& ladder, const Rung& rung)
{
    if (rung.effects.empty()) return "none";
    if (rung.effects.size() == ladder.general.effects.size() && rung.effects.size() > 1)
        return fmt::format("all {}", rung.effects.size());
    return fmt::format("{}", fmt::join(rung.effects, ", "));
}

ordered_json rung_json(const Ladder& ladder, const Rung& rung)
{
    const Cost& general = ladder.general.cost;
    ordered_json families = ordered_json::object();
    for (const auto& [family, cost] : rung.cost.families) {
        const double whole = analyze::issue_on(general, family);
        families[std::string{analyze::name(family)}] = {
            {"issue_cycles", json_number(cost.issue)},
            {"of_general", json_number(whole > 0 ? cost.issue / whole : 0)},
            {"vgprs", cost.vgprs},
            {"waves", cost.waves}};
    }
    ordered_json out{{"name", rung.name},
                     {"effects", rung.effects},
                     {"spirv_instructions", rung.cost.spirv_instructions},
                     {"families", std::move(families)}};
    if (rung.cost.device_nanoseconds)
        out["device_nanoseconds"] = json_number(*rung.cost.device_nanoseconds);
    if (rung.cost.tape_nanoseconds)
        out["tape_nanoseconds"] = json_number(*rung.cost.tape_nanoseconds);
    return out;
}

}  // namespace

Table ladder_table(const Ladder& ladder)
{
    const Cost& general = ladder.general.cost;
    const auto timed = [&](auto member) {
        return std::ranges::any_of(
            rungs_of(ladder), [&](const Rung* rung) { return (rung->cost.*member).has_value(); });
    };
    const bool device = timed(&Cost::device_nanoseconds);
    const bool tape = timed(&Cost::tape_nanoseconds);
    Table table{{{"scene"}, {"effects"}}, {}};
    for (const auto& [family, cost] : general.families)
        table.columns.push_back({std::string{analyze::name(family)}, true});
    const bool registers = general.families.contains(family_of_registers);
    if (registers) table.columns.push_back({"VGPRs", true});
    if (general.families.empty()) table.columns.push_back({"SPIR-V", true});
    if (device) table.columns.push_back({"device ns", true});
    if (tape) table.columns.push_back({"CPU ns", true});
    for (const Rung* rung : rungs_of(ladder)) {
        auto& cells = table.rows.emplace_back();
        cells.push_back({rung->name, Style::strong});
        cells.push_back({effects_of(ladder, *rung)});
        for (const auto& [family, cost] : general.families)
            cells.push_back({with_share(analyze::issue_on(rung->cost, family), cost.issue)});
        if (registers) {
            const auto found = rung->cost.families.find(family_of_registers);
            cells.push_back(
                {found == rung->cost.families.end() ? "-" : std::to_string(found->second.vgprs)});
        }
        if (general.families.empty())
            cells.push_back(
                {with_share(rung->cost.spirv_instructions, general.spirv_instructions)});
        if (device)
            cells.push_back(
                {nanoseconds(rung->cost.device_nanoseconds, general.device_nanoseconds)});
        if (tape)
            cells.push_back({nanoseconds(rung->cost.tape_nanoseconds, general.tape_nanoseconds)});
    }
    return table;
}

std::string to_text(const Ladder& ladder, const Look& look)
{
    std::string out = render(ladder_table(ladder), look) + "\n";
    if (ladder.about.no_statistics.empty())
        out +=
            fmt::format("issue cycles of one evaluation more from vectors, by {}; in parentheses "
                        "the share of\nthe general shader's; VGPRs on {}\n",
                        ladder.about.driver, analyze::name(family_of_registers));
    else
        out += fmt::format("no cycles: {}\n", ladder.about.no_statistics);
    if (!ladder.about.device.empty())
        out += fmt::format("nanoseconds of one evaluation on {}, and on one core\n",
                           ladder.about.device);
    return out;
}

std::string to_markdown(const Table& table)
{
    const auto line = [](const auto& cells, const auto& text) {
        std::string out = "|";
        for (const auto& cell : cells) out += fmt::format(" {} |", text(cell));
        return out + "\n";
    };
    std::string out = line(table.columns, [](const Column& column) { return column.title; });
    out += "|";
    for (const Column& column : table.columns) out += column.numeric ? "---:|" : "---|";
    out += "\n";
    for (const auto& row : table.rows) out += line(row, [](const Cell& cell) { return cell.text; });
    return out;
}

std::string to_markdown(const Ladder& ladder) { return to_markdown(ladder_table(ladder)); }

std::string to_json(const Ladder& ladder)
{
    ordered_json scenes = ordered_json::array(), references = ordered_json::array();
    for (const Rung& rung : ladder.scenes) scenes.push_back(rung_json(ladder, rung));
    for (const Rung& rung : ladder.references) references.push_back(rung_json(ladder, rung));
    ordered_json out{{"kind", "lobe ladder"},
                     {"schema", 1},
                     {"module", ladder.module},
                     {"model", ladder.model},
                     {"driver", ladder.about.driver}};
    if (!ladder.about.device.empty()) out["device"] = ladder.about.device;
    out["general"] = rung_json(ladder, ladder.general);
    out["scenes"] = std::move(scenes);
    out["references"] = std::move(references);
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobe::report
