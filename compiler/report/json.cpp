// JSON: every number of every row, for other programs.
#include "report/markup.h"
#include "report/verification.h"

#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const analyze::Witness& at)
{
    return {{"point", at.point},
            {"component", at.component},
            {"result", json_number(at.result)},
            {"exact", json_number(at.exact)},
            {"low", json_number(at.low)},
            {"high", json_number(at.high)},
            {"kind", at.kind},
            {"inputs", at.inputs}};
}

ordered_json to_json(const analyze::WorstError& worst)
{
    ordered_json out{{"size", json_number(worst.size)}};
    if (worst.at) out["at"] = to_json(*worst.at);
    return out;
}

ordered_json to_json(const analyze::Agreement& agreement)
{
    ordered_json out{{"points", agreement.points},
                     {"undefined", agreement.undefined},
                     {"outside", agreement.outside},
                     {"not_a_number", agreement.not_a_number},
                     {"infinite", agreement.infinite},
                     {"ulp_of_99_percent", json_number(agreement.ulp_of_99_percent)},
                     {"worst_ulp", to_json(agreement.ulp)},
                     {"worst_relative", to_json(agreement.relative)},
                     {"worst_absolute", to_json(agreement.absolute)}};
    if (agreement.example) out["example"] = to_json(*agreement.example);
    return out;
}

ordered_json to_json(const analyze::Judgement& judgement)
{
    ordered_json messages = ordered_json::array();
    for (const analyze::Remark& remark : judgement.remarks)
        messages.push_back({{"line", remark.line}, {"text", remark.text}});
    return {{"artifact", judgement.artifact},
            {"target", judgement.target},
            {"judge", judgement.judge},
            {"messages", std::move(messages)}};
}

ordered_json to_json(const analyze::Row& row, bool with_times)
{
    ordered_json out{{"term", row.term},
                     {"target", row.target},
                     {"precision", name(row.precision)},
                     {"ok", row.ok()},
                     {"executed", row.executed}};
    if (!row.failure.empty()) out["failure"] = row.failure;
    if (row.executed) {
        out["direct"] = to_json(row.direct);
        out["optimized"] = to_json(row.optimized);
    }
    if (with_times)
        out["measured"] = {{"judge_seconds", row.judge_seconds}, {"run_seconds", row.run_seconds}};
    return out;
}

ordered_json to_json(const analyze::Trip& trip)
{
    ordered_json out{
        {"lost", trip.lost}, {"outside", trip.outside}, {"other_bits", trip.other_bits}};
    if (const auto& lost = trip.example)
        out["example"] = {{"channel", lost->channel},
                          {"stored", lost->stored},
                          {"expected", lost->expected},
                          {"returned", json_number(lost->returned)}};
    return out;
}

ordered_json to_json(const analyze::RoundTrip& trip)
{
    ordered_json out{
        {"packing", trip.packing},   {"target", trip.target},     {"ok", trip.ok()},
        {"executed", trip.executed}, {"channels", trip.channels}, {"codes", trip.codes},
        {"points", trip.points},     {"promised", trip.promised}, {"cpu", to_json(trip.processor)}};
    if (!trip.failure.empty()) out["failure"] = trip.failure;
    if (trip.executed) {
        out["direct"] = to_json(trip.direct);
        out["optimized"] = to_json(trip.optimized);
    }
    return out;
}

ordered_json to_json(const analyze::Verification& verification, bool with_times)
{
    ordered_json out{{"module", verification.module}, {"device", verification.device}};
    if (!verification.no_device.empty()) out["no_device"] = verification.no_device;
    out["notes"] = verification.notes;
    ordered_json refusals = ordered_json::array();
    const auto add = [&refusals](const std::vector<analyze::Judgement>& judgements) {
        for (const analyze::Judgement& judgement : judgements)
            if (!judgement.accepted) refusals.push_back(to_json(judgement));
    };
    add(verification.judgements);
    for (const analyze::Row& row : verification.rows) add(row.judgements);
    for (const analyze::RoundTrip& trip : verification.round_trips) add(trip.judgements);
    out["refusals"] = std::move(refusals);
    ordered_json rows = ordered_json::array();
    for (const analyze::Row& row : verification.rows) rows.push_back(to_json(row, with_times));
    out["rows"] = std::move(rows);
    ordered_json trips = ordered_json::array();
    for (const analyze::RoundTrip& trip : verification.round_trips) trips.push_back(to_json(trip));
    out["round_trips"] = std::move(trips);
    if (with_times)
        out["measured"] = {{"seconds", verification.seconds},
                           {"acceptance_seconds", verification.acceptance_seconds},
                           {"acceptance_points", verification.acceptance_points}};
    return out;
}

}  // namespace

std::string to_json(Verifications verifications, bool with_times)
{
    const Totals sum = totals(verifications);
    const JudgeMatrix matrix = judge_matrix(verifications);
    ordered_json judges = ordered_json::array();
    for (std::size_t target = 0; target < matrix.targets.size(); ++target)
        for (std::size_t judge = 0; judge < analyze::judge_names().size(); ++judge) {
            const Score& score = matrix.scores[target][judge];
            if (score.accepted + score.refused == 0) continue;
            judges.push_back({{"target", matrix.targets[target]},
                              {"judge", analyze::judge_names()[judge]},
                              {"accepted", score.accepted},
                              {"refused", score.refused}});
        }
    ordered_json modules = ordered_json::array();
    for (const analyze::Verification& verification : verifications)
        modules.push_back(to_json(verification, with_times));
    const ordered_json out{{"ok", sum.ok()},
                           {"summary",
                            {{"rows", sum.rows},
                             {"failed_rows", sum.failed_rows},
                             {"executions", sum.executions},
                             {"outside", sum.outside},
                             {"undefined", sum.undefined},
                             {"verdicts", sum.verdicts},
                             {"refusals", sum.refusals},
                             {"round_trips", sum.round_trips},
                             {"failed_round_trips", sum.failed_round_trips}}},
                           {"judges", std::move(judges)},
                           {"modules", std::move(modules)}};
    // A judge's message may hold bytes that are not UTF-8; they must not stop a report.
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobe::report
