#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

using analyze::Agreement;
using analyze::Judgement;
using analyze::RoundTrip;
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
        for (const RoundTrip& trip : verification.round_trips)
            for (const Judgement& judgement : trip.judgements) visit(judgement);
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

Cell state_of(const RoundTrip& trip)
{
    if (!trip.ok()) return {"FAIL", Style::bad};
    if (!trip.executed) return {"on the CPU", Style::faint};
    return {"ok", Style::good};
}

/// What the round trips of all modules come to, in one line; empty without packings.
std::string summary_of_trips(Verifications verifications, const Look& look)
{
    std::size_t codes = 0, channels = 0, lost = 0, promised = 0, points = 0;
    std::vector<std::string> targets;
    bool executed = true;
    for (const Verification& verification : verifications) {
        std::string last;
        for (const RoundTrip& trip : verification.round_trips) {
            executed &= trip.executed;
            lost += trip.processor.lost + trip.direct.lost + trip.optimized.lost;
            if (std::ranges::find(targets, trip.target) == targets.end())
                targets.push_back(trip.target);
            // What the CPU and the contract say is the same for every target.
            if (trip.packing == last) continue;
            last = trip.packing;
            codes += trip.codes;
            channels += trip.channels;
            promised += trip.promised;
            points += trip.points;
        }
    }
    if (points == 0) return {};
    const std::string where =
        executed ? fmt::format(" and on the device, {} targets", targets.size()) : "";
    const std::string outcome =
        lost == 0 ? styled("none lost", Style::good, look.color)
                  : styled(grouped(lost) + " points lost", Style::bad, look.color);
    const std::string contract = promised == points
                                     ? "no conforming device can lose one"
                                     : fmt::format("the contract promises {} of {} points",
                                                   grouped(promised), grouped(points));
    return fmt::format(
        "codes     {} codes of {} channels unpacked and packed, on the CPU{}: {}, {}\n",
        grouped(codes), channels, where, outcome, contract);
}

/// What is wrong with a round trip, one paragraph per machine.
std::string findings_of(const RoundTrip& trip, const Look& look)
{
    const auto title = [&](std::string_view what) {
        return fmt::format("{} {}, {}", styled(what, Style::bad, look.color), trip.packing,
                           trip.target);
    };
    std::string out;
    if (!trip.failure.empty()) out += fmt::format("{}: {}\n", title("not run"), trip.failure);
    for (const auto& [machine, result] :
         {std::pair{"the CPU", &trip.processor}, std::pair{"direct", &trip.direct},
          std::pair{"optimized", &trip.optimized}}) {
        if (result->ok()) continue;
        out += fmt::format("{}, {}: {} of {} points came back with another code, {} have a value "
                           "outside its interval\n",
                           title("lost"), machine, grouped(result->lost), grouped(trip.points),
                           grouped(result->outside));
        if (const auto& lost = result->example)
            out += fmt::format("      at {}\n      {} came back as {}, not {}\n", lost->stored,
                               lost->channel, lost->returned, lost->expected);
    }
    return out;
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
    for (const Verification& verification : verifications) {
        for (const Row& row : verification.rows) {
            ++out.rows;
            out.failed_rows += !row.ok();
            out.executions += row.direct.points + row.optimized.points;
            out.outside += row.direct.outside + row.optimized.outside;
            out.undefined += row.direct.undefined + row.optimized.undefined;
        }
        for (const RoundTrip& trip : verification.round_trips) {
            ++out.round_trips;
            out.failed_round_trips += !trip.ok();
        }
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

Table round_trip_table(Verifications verifications)
{
    Table table;
    table.columns = {{"packing", false},   {"target", false}, {"", false},    {"channels", true},
                     {"codes", true},      {"points", true},  {"lost", true}, {"outside", true},
                     {"other bits", true}, {"promised", true}};
    for (const Verification& verification : verifications)
        for (const RoundTrip& trip : verification.round_trips) {
            std::vector<Cell> cells{{trip.packing}, {trip.target}, state_of(trip)};
            const Style style = trip.ok() ? Style::plain : Style::bad;
            cells.push_back({grouped(trip.channels)});
            cells.push_back({grouped(trip.codes)});
            cells.push_back({grouped(trip.points)});
            cells.push_back(
                {grouped(trip.processor.lost + trip.direct.lost + trip.optimized.lost), style});
            cells.push_back({grouped(trip.direct.outside + trip.optimized.outside), style});
            cells.push_back({grouped(trip.direct.other_bits + trip.optimized.other_bits)});
            cells.push_back({grouped(trip.promised)});
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
    out += summary_of_trips(verifications, look);
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
    for (const Verification& verification : verifications)
        for (const RoundTrip& trip : verification.round_trips) out += findings_of(trip, look);
    return out;
}

}  // namespace lobe::report
