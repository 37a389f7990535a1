#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

using analyze::Agreement;
using analyze::Judgement;
using analyze::Row;
using analyze::Verification;
using analyze::Witness;
using analyze::WorstError;

const WorstError& greater(const WorstError& a, const WorstError& b)
{
    return b.size > a.size ? b : a;
}

template <class Visit>
void for_each_judgement(Verifications verifications, const Visit& visit)
{
    for (const Verification& verification : verifications) {
        for (const Judgement& judgement : verification.judgements) visit(judgement);
        for (const Row& row : verification.rows)
            for (const Judgement& judgement : row.judgements) visit(judgement);
    }
}

/// `direct / optimized`, or one number when they are equal.
std::string both(std::size_t direct, std::size_t optimized)
{
    if (direct == optimized) return grouped(direct);
    return grouped(direct) + " / " + grouped(optimized);
}

Cell state_of(const Row& row)
{
    if (!row.ok()) return {"FAIL", Style::bad};
    if (!row.executed) return {"judged", Style::faint};
    return {"ok", Style::good};
}

std::string witness_text(const Witness& at)
{
    return fmt::format("      at {}\n      returned {}, allowed [{}, {}], exact {} ({})\n",
                       at.inputs, at.result, at.low, at.high, at.exact, at.kind);
}

}  // namespace

std::string_view name(emit::Precision precision)
{
    return precision == emit::Precision::float16 ? "float16" : "float32";
}

const WorstError& worst_ulp(const Row& row) { return greater(row.direct.ulp, row.optimized.ulp); }

const WorstError& worst_relative(const Row& row)
{
    return greater(row.direct.relative, row.optimized.relative);
}

std::string short_number(double value)
{
    if (value == 0) return "0";
    if (std::abs(value) >= 0.01 && std::abs(value) < 1000) return fmt::format("{:.3g}", value);
    return fmt::format("{:.1e}", value);
}

Totals totals(Verifications verifications)
{
    Totals out;
    for (const Verification& verification : verifications)
        for (const Row& row : verification.rows) {
            ++out.rows;
            out.failed_rows += !row.ok();
            out.executions += row.direct.points + row.optimized.points;
            out.outside += row.direct.outside + row.optimized.outside;
            out.undefined += row.direct.undefined + row.optimized.undefined;
        }
    for_each_judgement(verifications, [&out](const Judgement& judgement) {
        ++out.verdicts;
        out.refusals += !judgement.accepted;
    });
    return out;
}

JudgeMatrix judge_matrix(Verifications verifications)
{
    const auto& judges = analyze::judge_names();
    JudgeMatrix out;
    for_each_judgement(verifications, [&](const Judgement& judgement) {
        auto target = std::ranges::find(out.targets, judgement.target);
        if (target == out.targets.end()) {
            out.targets.push_back(judgement.target);
            out.scores.emplace_back(judges.size());
            target = out.targets.end() - 1;
        }
        const auto judge = std::ranges::find(judges, judgement.judge);
        Score& score = out.scores[static_cast<std::size_t>(target - out.targets.begin())]
                                 [static_cast<std::size_t>(judge - judges.begin())];
        ++(judgement.accepted ? score.accepted : score.refused);
    });
    return out;
}

Table verification_table(Verifications verifications)
{
    Table table;
    table.columns = {{"term", false},     {"target", false},  {"precision", false},
                     {"", false},         {"points", true},   {"outside", true},
                     {"undefined", true}, {"ulp 99 %", true}, {"worst ulp", true},
                     {"relative", true},  {"worst at", false}};
    for (const Verification& verification : verifications)
        for (const Row& row : verification.rows) {
            std::vector<Cell> cells{{row.term, Style::plain},
                                    {row.target, Style::plain},
                                    {std::string{name(row.precision)}, Style::plain},
                                    state_of(row)};
            if (row.executed) {
                const WorstError& ulp = worst_ulp(row);
                cells.push_back({grouped(row.direct.points), Style::plain});
                cells.push_back({both(row.direct.outside, row.optimized.outside),
                                 row.ok() ? Style::plain : Style::bad});
                cells.push_back({grouped(row.direct.undefined), Style::plain});
                cells.push_back({short_number(std::max(row.direct.ulp_of_99_percent,
                                                       row.optimized.ulp_of_99_percent)),
                                 Style::plain});
                cells.push_back({short_number(ulp.size), Style::plain});
                cells.push_back({short_number(worst_relative(row).size), Style::plain});
                cells.push_back({ulp.at ? ulp.at->inputs : "", Style::faint});
            }
            table.rows.push_back(std::move(cells));
        }
    return table;
}

Table judge_table(Verifications verifications)
{
    const JudgeMatrix matrix = judge_matrix(verifications);
    Table table;
    table.columns.push_back({"judge", false});
    for (const std::string& target : matrix.targets) table.columns.push_back({target, true});
    for (std::size_t judge = 0; judge < analyze::judge_names().size(); ++judge) {
        std::vector<Cell> cells{{analyze::judge_names()[judge], Style::plain}};
        for (const auto& scores : matrix.scores) {
            const Score& score = scores[judge];
            if (score.refused > 0)
                cells.push_back(
                    {fmt::format("{} of {} refused", score.refused, score.refused + score.accepted),
                     Style::bad});
            else if (score.accepted > 0)
                cells.push_back({fmt::format("{} ok", score.accepted), Style::good});
            else
                cells.push_back({"-", Style::faint});
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::string summary(Verifications verifications, const Look& look, bool with_times)
{
    const Totals sum = totals(verifications);
    std::string out;
    out += fmt::format("judges    {} verdicts, {}\n", grouped(sum.verdicts),
                       sum.refusals == 0
                           ? styled("no refusal", Style::good, look.color)
                           : styled(grouped(sum.refusals) + " refusals", Style::bad, look.color));
    for (const Verification& verification : verifications) {
        if (!verification.no_device.empty()) {
            out += fmt::format("device    {}: {}\n", styled("none", Style::bad, look.color),
                               verification.no_device);
            break;
        }
        if (!verification.device.empty()) {
            out += fmt::format("device    {}\n", verification.device);
            break;
        }
    }
    if (sum.executions > 0)
        out += fmt::format(
            "executed  {} results in {} rows: {}, {} undefined by the contract\n",
            grouped(sum.executions), grouped(sum.rows),
            sum.outside == 0
                ? styled("none outside its acceptance interval", Style::good, look.color)
                : styled(grouped(sum.outside) + " outside their acceptance intervals", Style::bad,
                         look.color),
            grouped(sum.undefined));
    std::vector<std::string> notes;
    for (const Verification& verification : verifications)
        for (const std::string& note : verification.notes)
            if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
    for (const std::string& note : notes) out += fmt::format("left out  {}\n", note);
    if (with_times) {
        double seconds = 0, acceptance = 0;
        std::size_t points = 0;
        for (const Verification& verification : verifications) {
            seconds += verification.seconds;
            acceptance += verification.acceptance_seconds;
            points += verification.acceptance_points;
        }
        out += fmt::format("time      {:.1f} s", seconds);
        if (points > 0)
            out += fmt::format(", of which {:.2f} us a point and core for acceptance intervals",
                               1e6 * acceptance / static_cast<double>(points));
        out += "\n";
    }
    return out;
}

std::string findings(Verifications verifications, const Look& look)
{
    std::string out;
    for_each_judgement(verifications, [&](const Judgement& judgement) {
        if (judgement.accepted) return;
        out += fmt::format("{} {} rejects {} ({})\n", styled("refused", Style::bad, look.color),
                           judgement.judge, judgement.artifact, judgement.target);
        for (const analyze::Remark& remark : judgement.remarks)
            out += fmt::format("      {}\n", remark.text);
    });
    for (const Verification& verification : verifications)
        for (const Row& row : verification.rows) {
            const auto title = [&](std::string_view what) {
                return fmt::format("{} {}, {}, {}", styled(what, Style::bad, look.color), row.term,
                                   row.target, name(row.precision));
            };
            if (!row.failure.empty()) out += fmt::format("{}: {}\n", title("not run"), row.failure);
            for (const auto& [route, agreement] :
                 {std::pair{analyze::Route::direct, &row.direct},
                  std::pair{analyze::Route::optimized, &row.optimized}}) {
                if (agreement->agrees()) continue;
                out += fmt::format("{}, {}: {} of {} points, {} of them NaN\n", title("outside"),
                                   analyze::name(route), grouped(agreement->outside),
                                   grouped(agreement->points), grouped(agreement->not_a_number));
                if (agreement->example) out += witness_text(*agreement->example);
            }
        }
    return out;
}

}  // namespace lobe::report
