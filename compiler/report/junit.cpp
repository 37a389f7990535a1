// A verification as JUnit cases: a suite per module and target, a case per row.
#include "report/junit_suite.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

JunitCase case_of(const analyze::Row& row, const analyze::Verification& verification)
{
    JunitCase out;
    out.name = fmt::format("{} {}", row.term, name(row.precision));
    out.seconds = row.judge_seconds + row.run_seconds;
    if (!row.ok()) {
        out.failure = !row.failure.empty()
                          ? row.failure
                          : fmt::format("{} points outside direct, {} after the optimizer",
                                        row.direct.outside, row.optimized.outside);
        for (const analyze::Judgement& judgement : row.judgements)
            if (!judgement.accepted)
                out.failure = fmt::format("{} rejects {}", judgement.judge, judgement.artifact);
        analyze::Verification one;
        one.rows.push_back(row);
        out.details = findings({&one, 1}, {});
    } else if (!row.executed) {
        out.skipped = verification.no_device.empty() ? "not executed" : verification.no_device;
    }
    return out;
}

JunitCase case_of(const analyze::RoundTrip& trip, const analyze::Verification& verification)
{
    JunitCase out;
    out.name = fmt::format("{} round trip", trip.packing);
    if (!trip.ok()) {
        out.failure =
            !trip.failure.empty()
                ? trip.failure
                : fmt::format("{} points lost on the CPU, {} direct, {} after the optimizer",
                              trip.processor.lost, trip.direct.lost, trip.optimized.lost);
        for (const analyze::Judgement& judgement : trip.judgements)
            if (!judgement.accepted)
                out.failure = fmt::format("{} rejects {}", judgement.judge, judgement.artifact);
        analyze::Verification one;
        one.round_trips.push_back(trip);
        out.details = findings({&one, 1}, {});
    } else if (!trip.executed) {
        out.skipped = verification.no_device.empty() ? "only on the CPU" : verification.no_device;
    }
    return out;
}

JunitCase case_of(const std::string& artifact, const std::vector<analyze::Judgement>& judgements)
{
    JunitCase out;
    out.name = artifact;
    for (const analyze::Judgement& judgement : judgements) {
        if (judgement.artifact != artifact || judgement.accepted) continue;
        if (out.failure.empty()) out.failure = judgement.judge + " rejects it";
        for (const analyze::Remark& remark : judgement.remarks) out.details += remark.text + "\n";
    }
    return out;
}

}  // namespace

std::string to_junit(Verifications verifications, bool with_times)
{
    std::vector<JunitSuite> suites;
    for (const analyze::Verification& verification : verifications) {
        std::vector<std::string> targets;
        const auto know = [&targets](const std::string& target) {
            if (std::ranges::find(targets, target) == targets.end()) targets.push_back(target);
        };
        for (const analyze::Judgement& judgement : verification.judgements) know(judgement.target);
        for (const analyze::Row& row : verification.rows) know(row.target);
        for (const analyze::RoundTrip& trip : verification.round_trips) know(trip.target);
        for (const std::string& target : targets) {
            std::vector<JunitCase> cases;
            std::string last;
            for (const analyze::Judgement& judgement : verification.judgements) {
                if (judgement.target != target || judgement.artifact == last) continue;
                last = judgement.artifact;
                cases.push_back(case_of(last, verification.judgements));
            }
            for (const analyze::Row& row : verification.rows)
                if (row.target == target) cases.push_back(case_of(row, verification));
            for (const analyze::RoundTrip& trip : verification.round_trips)
                if (trip.target == target) cases.push_back(case_of(trip, verification));
            suites.push_back({verification.module + "." + target, std::move(cases)});
        }
    }
    return to_junit("lobec verify", suites, with_times);
}

}  // namespace lobe::report
