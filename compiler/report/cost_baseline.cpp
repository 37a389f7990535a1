// Costs of now against costs of before.
#include "report/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace lobe::report {
namespace {

/// More than rounding to JSON and back changes, less than any instruction.
constexpr double least_change = 1e-6;

/// A row by name, its module and what is unusual of it in front and behind.
std::string label(const CostRow& row)
{
    std::string text = fmt::format("{}: {}", row.module, row.name);
    if (row.whole_model) text = fmt::format("{}: model {}", row.module, row.name);
    if (row.spelling != "stable") text += ", " + row.spelling;
    if (row.format != "float") text += ", " + row.format;
    return text;
}

bool is_same(const CostRow& a, const CostRow& b)
{
    return a.module == b.module && a.name == b.name && a.whole_model == b.whole_model &&
           a.spelling == b.spelling && a.format == b.format;
}

const CostRow* counterpart(const CostReport& report, const CostRow& row)
{
    const auto found = std::ranges::find_if(
        report.rows, [&](const CostRow& other) { return is_same(row, other); });
    return found == report.rows.end() ? nullptr : &*found;
}

CostChanges changes(const CostReport& before, const CostReport& now, std::string measure,
                    const std::function<double(const analyze::Cost&)>& value)
{
    CostChanges out;
    out.measure = std::move(measure);
    for (const CostRow& row : now.rows) {
        const CostRow* const old = counterpart(before, row);
        if (old == nullptr) continue;
        const CostChange change{label(row), value(old->cost), value(row.cost)};
        out.total_before += change.before;
        out.total_now += change.now;
        if (std::abs(change.now - change.before) < least_change)
            ++out.unchanged;
        else
            (change.now > change.before ? out.hurt : out.helped).push_back(change);
    }
    std::ranges::stable_sort(out.hurt, std::greater{}, &CostChange::relative);
    std::ranges::stable_sort(out.helped, std::less{}, &CostChange::relative);
    return out;
}

std::string percent(double relative)
{
    if (std::isinf(relative)) return "it cost nothing";
    return fmt::format("{:+.1f} %", 100 * relative);
}

bool has_cycles(const CostReport& report, analyze::Family family)
{
    return std::ranges::all_of(
        report.rows, [family](const CostRow& row) { return row.cost.families.contains(family); });
}

}  // namespace

double CostChange::relative() const
{
    if (before <= 0) return now > 0 ? std::numeric_limits<double>::infinity() : 0;
    return now / before - 1;
}

bool CostComparison::regressed(double limit) const
{
    return std::ranges::any_of(measures, [&](const CostChanges& each) {
        return !each.hurt.empty() && each.hurt.front().relative() > limit;
    });
}

CostComparison compare(const CostReport& before, const CostReport& now,
                       std::span<const analyze::Family> families)
{
    CostComparison out;
    if (before.driver != now.driver) out.before_driver = before.driver;
    for (const analyze::Family family : families)
        if (has_cycles(before, family) && has_cycles(now, family))
            out.measures.push_back(changes(
                before, now, fmt::format("issue cycles on {}", analyze::title(family)),
                [family](const analyze::Cost& cost) { return analyze::issue_on(cost, family); }));
    if (out.measures.empty())
        out.measures.push_back(
            changes(before, now, "SPIR-V instructions", [](const analyze::Cost& cost) {
                return static_cast<double>(cost.spirv_instructions);
            }));
    for (const CostRow& row : now.rows)
        if (counterpart(before, row) == nullptr) out.added.push_back(label(row));
    for (const CostRow& row : before.rows)
        if (counterpart(now, row) == nullptr) out.gone.push_back(label(row));
    return out;
}

std::string to_text(const CostComparison& comparison, const Look& look)
{
    std::string out;
    if (!comparison.before_driver.empty())
        out += fmt::format("the baseline is by {}: differences may be the driver's\n",
                           comparison.before_driver);
    for (const CostChanges& each : comparison.measures) {
        const auto list = [&](const std::vector<CostChange>& all, std::string_view word,
                              Style style) {
            for (const CostChange& change : all)
                out +=
                    fmt::format("  {}  {}: {:g} -> {:g} ({})\n", styled(word, style, look.color),
                                change.what, change.before, change.now, percent(change.relative()));
        };
        out += fmt::format("{}: {} helped, {} hurt, {} unchanged; total {:g} -> {:g}", each.measure,
                           each.helped.size(), each.hurt.size(), each.unchanged, each.total_before,
                           each.total_now);
        if (each.total_before > 0)
            out += fmt::format(" ({:+.2f} %)", 100 * (each.total_now / each.total_before - 1));
        if (!each.helped.empty())
            out += fmt::format("; best {} at {}", percent(each.helped.front().relative()),
                               each.helped.front().what);
        if (!each.hurt.empty())
            out += fmt::format("; worst {} at {}", percent(each.hurt.front().relative()),
                               each.hurt.front().what);
        out += "\n";
        list(each.hurt, "hurt  ", Style::bad);
        list(each.helped, "helped", Style::good);
    }
    for (const std::string& row : comparison.added) out += fmt::format("new: {}\n", row);
    for (const std::string& row : comparison.gone) out += fmt::format("gone: {}\n", row);
    return out;
}

}  // namespace lobe::report
