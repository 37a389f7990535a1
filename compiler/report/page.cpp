// The page: templates/report/verification.html, filled.
#include "emit/template.h"
#include "report/markup.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

using emit::Record;

Record texts(std::initializer_list<std::pair<const std::string, std::string>> values)
{
    Record record;
    for (const auto& [name, value] : values) record.texts[name] = value;
    return record;
}

constexpr int bar_width = 96;

/// Where an error of so many ulps stands on the bar: bits of a float that it costs.
double bar_length(double ulp)
{
    constexpr double bits = 24;
    const double lost = std::log2(1 + std::min(ulp, 0x1p24));
    return std::clamp(lost / bits, 0.0, 1.0) * bar_width;
}

std::string bar(double most, double worst)
{
    return fmt::format("<svg width=\"{0}\" height=\"10\" viewBox=\"0 0 {0} 10\" role=\"img\" "
                       "aria-label=\"99 % below {1} ulp, worst {2} ulp\">"
                       "<rect class=\"worst\" width=\"{3:.1f}\" height=\"10\" rx=\"2\"/>"
                       "<rect class=\"most\" width=\"{4:.1f}\" height=\"10\" rx=\"2\"/></svg>",
                       bar_width, short_number(most), short_number(worst), bar_length(worst),
                       bar_length(most));
}

std::string witness(const analyze::Witness& at)
{
    return fmt::format("<details><summary>{}</summary><div>{}<br>returned {}, exact {}, allowed "
                       "[{}, {}]</div></details>",
                       escaped_xml(at.kind), escaped_xml(at.inputs), at.result, at.exact, at.low,
                       at.high);
}

Record row_record(const analyze::Row& row, bool first)
{
    Record out = texts({{"class", first ? "first" : ""},
                        {"term", escaped_xml(first ? row.term : "")},
                        {"target", row.target},
                        {"precision", std::string{name(row.precision)}},
                        {"state", !row.ok()      ? "fails"
                                  : row.executed ? "agrees"
                                                 : "judged"},
                        {"state_class", !row.ok()      ? "bad"
                                        : row.executed ? "good"
                                                       : "soft"}});
    for (const char* field :
         {"outside", "undefined", "most", "worst", "bar", "relative", "witness"})
        out.texts[field];
    if (!row.executed) return out;
    const double most = std::max(row.direct.ulp_of_99_percent, row.optimized.ulp_of_99_percent);
    const analyze::WorstError& worst = worst_ulp(row);
    out.texts["outside"] =
        row.direct.outside == row.optimized.outside
            ? grouped(row.direct.outside)
            : fmt::format("{} / {}", grouped(row.direct.outside), grouped(row.optimized.outside));
    out.texts["undefined"] = grouped(row.direct.undefined);
    out.texts["most"] = short_number(most);
    out.texts["worst"] = short_number(worst.size);
    out.texts["bar"] = bar(most, worst.size);
    out.texts["relative"] = short_number(worst_relative(row).size);
    if (worst.at) out.texts["witness"] = witness(*worst.at);
    return out;
}

Record module_record(const analyze::Verification& verification)
{
    Record out = texts({{"name", escaped_xml(verification.module)}});
    std::size_t points = 0;
    std::vector<Record>& rows = out.lists["rows"];
    std::string last;
    for (const analyze::Row& row : verification.rows) {
        points = std::max(points, row.direct.points);
        rows.push_back(row_record(row, row.term != last));
        last = row.term;
    }
    out.texts["points"] = points > 0 ? grouped(points) : "no";
    return out;
}

std::vector<Record> facts(Verifications verifications, const Totals& sum)
{
    std::string device = "none";
    for (const analyze::Verification& verification : verifications) {
        if (!verification.device.empty()) device = verification.device;
        if (!verification.no_device.empty()) device = "none: " + verification.no_device;
    }
    const auto fact = [](std::string title, std::string value, const char* style) {
        return texts({{"name", std::move(title)}, {"value", escaped_xml(value)}, {"class", style}});
    };
    return {fact("verdicts of judges", grouped(sum.verdicts), ""),
            fact("of them refusals", grouped(sum.refusals), sum.refusals > 0 ? "bad" : ""),
            fact("results computed", grouped(sum.executions), ""),
            fact("outside their interval", grouped(sum.outside), sum.outside > 0 ? "bad" : ""),
            fact("undefined by the contract", grouped(sum.undefined), ""),
            fact("device", device, "words")};
}

std::vector<Record> judge_records(const JudgeMatrix& matrix)
{
    std::vector<Record> out;
    for (std::size_t judge = 0; judge < analyze::judge_names().size(); ++judge) {
        Record record = texts({{"name", escaped_xml(analyze::judge_names()[judge])}});
        std::vector<Record>& scores = record.lists["scores"];
        for (const auto& row : matrix.scores) {
            const Score& score = row[judge];
            if (score.refused > 0)
                scores.push_back(texts({{"class", "bad"},
                                        {"text", fmt::format("{} of {} refused", score.refused,
                                                             score.refused + score.accepted)}}));
            else if (score.accepted > 0)
                scores.push_back(texts({{"class", ""}, {"text", grouped(score.accepted)}}));
            else
                scores.push_back(texts({{"class", "soft"}, {"text", "–"}}));
        }
        out.push_back(std::move(record));
    }
    return out;
}

/// The table of round trips: a list of one, or none without packings.
std::vector<Record> code_records(Verifications verifications)
{
    const Table table = round_trip_table(verifications);
    if (table.rows.empty()) return {};
    Record section;
    for (const Column& column : table.columns)
        section.lists["titles"].push_back(
            texts({{"text", escaped_xml(column.title)}, {"class", column.numeric ? "n" : ""}}));
    for (const auto& row : table.rows) {
        std::vector<Record>& cells = section.lists["rows"].emplace_back().lists["cells"];
        for (std::size_t i = 0; i < row.size(); ++i) {
            const char* style = row[i].style == Style::good    ? "good"
                                : row[i].style == Style::bad   ? "bad"
                                : row[i].style == Style::faint ? "soft"
                                                               : "";
            cells.push_back(texts(
                {{"text", escaped_xml(row[i].text)},
                 {"class", fmt::format("{}{}", table.columns[i].numeric ? "n " : "", style)}}));
        }
    }
    return {section};
}

}  // namespace

std::string to_page(Verifications verifications, bool with_times)
{
    const Totals sum = totals(verifications);
    const JudgeMatrix matrix = judge_matrix(verifications);
    std::string names;
    for (const analyze::Verification& verification : verifications)
        names += (names.empty() ? "" : ", ") + verification.module;

    Record page = texts({{"title", escaped_xml("Verification of " + names)},
                         {"verdict_class", sum.ok() ? "good" : "bad"}});
    page.texts["verdict"] =
        !sum.ok() ? fmt::format("{} of {} rows fail, {} texts were refused{}.",
                                grouped(sum.failed_rows), grouped(sum.rows), grouped(sum.refusals),
                                sum.failed_round_trips == 0
                                    ? ""
                                    : fmt::format(", {} of {} round trips lose codes",
                                                  sum.failed_round_trips, sum.round_trips))
        : sum.executions > 0
            ? "Every text was accepted, and every defined result lies where the specification "
              "allows it."
            : "Every text was accepted. Nothing was executed.";
    page.lists["facts"] = facts(verifications, sum);
    std::vector<Record>& notes = page.lists["notes"];
    std::vector<std::string> said;
    for (const analyze::Verification& verification : verifications)
        for (const std::string& note : verification.notes) {
            if (std::ranges::find(said, note) != said.end()) continue;
            said.push_back(note);
            notes.push_back(texts({{"text", escaped_xml(note)}}));
        }
    std::vector<Record>& found = page.lists["findings"];
    if (const std::string text = findings(verifications, {}); !text.empty())
        found.push_back(texts({{"text", escaped_xml(text)}}));
    std::vector<Record>& targets = page.lists["targets"];
    for (const std::string& target : matrix.targets)
        targets.push_back(texts({{"name", escaped_xml(target)}}));
    page.lists["judges"] = judge_records(matrix);
    page.lists["codes"] = code_records(verifications);
    std::vector<Record>& modules = page.lists["modules"];
    for (const analyze::Verification& verification : verifications)
        modules.push_back(module_record(verification));
    std::vector<Record>& times = page.lists["times"];
    if (with_times) {
        double seconds = 0;
        for (const analyze::Verification& verification : verifications)
            seconds += verification.seconds;
        times.push_back(texts({{"text", fmt::format("{:.1f} s for everything.", seconds)}}));
    }
    return emit::render_embedded("report/verification.html", page).text;
}

}  // namespace lobe::report
