// Costs as JSON, and back.
#include "report/cost.h"
#include "report/markup.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace lobe::report {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kind = "lobe cost";
/// Changes when a file of before would be misread.
constexpr int schema = 1;

ordered_json to_json(const CostRow& row)
{
    ordered_json families = ordered_json::object();
    for (const auto& [family, cost] : row.cost.families)
        families[std::string{analyze::name(family)}] = {
            {"issue_cycles", json_number(cost.issue)},
            {"valu", json_number(cost.valu)},
            {"transcendental", json_number(cost.transcendental)},
            {"inverse_throughput", json_number(cost.inverse_throughput)},
            {"latency", json_number(cost.latency)},
            {"vgprs", cost.vgprs},
            {"waves", cost.waves}};
    ordered_json out{{"module", row.module},
                     {"name", row.name},
                     {"whole_model", row.whole_model},
                     {"spelling", row.spelling},
                     {"format", row.format},
                     {"families", std::move(families)},
                     {"spirv_instructions", row.cost.spirv_instructions}};
    ordered_json measured = ordered_json::object();
    if (row.cost.device_nanoseconds)
        measured["device_nanoseconds"] = json_number(*row.cost.device_nanoseconds);
    if (row.cost.tape_nanoseconds)
        measured["tape_nanoseconds"] = json_number(*row.cost.tape_nanoseconds);
    if (!measured.empty()) out["measured"] = std::move(measured);
    return out;
}

/// Missing or of another type: nothing, and the file is not one of ours.
template <class T>
bool read(const json& object, const char* name, T& value)
{
    const auto found = object.find(name);
    if (found == object.end()) return false;
    if constexpr (std::is_same_v<T, bool>) {
        if (!found->is_boolean()) return false;
    } else if constexpr (std::is_arithmetic_v<T>) {
        if (!found->is_number()) return false;
    } else {
        if (!found->is_string()) return false;
    }
    value = found->get<T>();
    return true;
}

bool read(const json& object, CostRow& row)
{
    if (!object.is_object() || !read(object, "module", row.module) ||
        !read(object, "name", row.name) || !read(object, "whole_model", row.whole_model) ||
        !read(object, "spelling", row.spelling) || !read(object, "format", row.format) ||
        !read(object, "spirv_instructions", row.cost.spirv_instructions))
        return false;
    const auto families = object.find("families");
    if (families == object.end() || !families->is_object()) return false;
    for (const analyze::Family family : analyze::all_families) {
        const auto found = families->find(std::string{analyze::name(family)});
        if (found == families->end()) continue;
        analyze::FamilyCost& cost = row.cost.families[family];
        if (!found->is_object() || !read(*found, "issue_cycles", cost.issue) ||
            !read(*found, "valu", cost.valu) ||
            !read(*found, "transcendental", cost.transcendental) ||
            !read(*found, "inverse_throughput", cost.inverse_throughput) ||
            !read(*found, "latency", cost.latency) || !read(*found, "vgprs", cost.vgprs) ||
            !read(*found, "waves", cost.waves))
            return false;
    }
    return true;
}

/// All rows that have cycles have them on the same families.
bool is_even(const CostReport& report)
{
    const auto first = std::ranges::find_if(
        report.rows, [](const CostRow& row) { return !row.cost.families.empty(); });
    return std::all_of(first, report.rows.end(), [&](const CostRow& row) {
        return row.cost.families.empty() ||
               std::ranges::equal(row.cost.families, first->cost.families,
                                  [](const auto& a, const auto& b) { return a.first == b.first; });
    });
}

}  // namespace

std::string to_json(const CostReport& report)
{
    ordered_json rows = ordered_json::array();
    for (const CostRow& row : report.rows) rows.push_back(to_json(row));
    ordered_json out{{"kind", kind},
                     {"schema", schema},
                     {"driver", report.driver},
                     {"from_vectors", report.from_vectors}};
    if (!report.device.empty()) out["device"] = report.device;
    out["rows"] = std::move(rows);
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::optional<CostReport> read_costs(std::string_view text, std::string& why)
{
    const json file = json::parse(text, nullptr, false);
    std::string what;
    if (!file.is_object() || !read(file, "kind", what) || what != kind) {
        why = "it is not what `lobec cost --json` writes";
        return std::nullopt;
    }
    int version = 0;
    if (!read(file, "schema", version) || version != schema) {
        why = fmt::format("another version of lobec wrote it; write it anew");
        return std::nullopt;
    }
    CostReport report;
    const auto rows = file.find("rows");
    bool ok = read(file, "driver", report.driver) &&
              read(file, "from_vectors", report.from_vectors) && rows != file.end() &&
              rows->is_array();
    if (ok)
        for (const json& row : *rows) ok = ok && read(row, report.rows.emplace_back());
    if (ok && is_even(report)) return report;
    why = "it is damaged";
    return std::nullopt;
}

}  // namespace lobe::report
