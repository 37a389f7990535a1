// JUnit XML, as continuous integration reads it: a suite per module and target, a case per row.
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

/// Text that may stand in XML, between tags or quotes. Control characters cannot; they become
/// spaces.
std::string escaped(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '&': out += "&amp;"; break;
        case '"': out += "&quot;"; break;
        case '\n': out += "&#10;"; break;
        default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return out;
}

struct Case {
    std::string name;
    std::string failure;  ///< empty: it passed
    std::string details;
    std::string skipped;  ///< empty: it ran
    double seconds = 0;
};

Case case_of(const analyze::Row& row, const analyze::Verification& verification)
{
    Case out;
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

Case case_of(const analyze::RoundTrip& trip, const analyze::Verification& verification)
{
    Case out;
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

Case case_of(const std::string& artifact, const std::vector<analyze::Judgement>& judgements)
{
    Case out;
    out.name = artifact;
    for (const analyze::Judgement& judgement : judgements) {
        if (judgement.artifact != artifact || judgement.accepted) continue;
        if (out.failure.empty()) out.failure = judgement.judge + " rejects it";
        for (const analyze::Remark& remark : judgement.remarks) out.details += remark.text + "\n";
    }
    return out;
}

std::string write(const std::string& suite, const std::vector<Case>& cases, bool with_times)
{
    const auto count = [&cases](std::string Case::*member) {
        return std::ranges::count_if(cases,
                                     [member](const Case& c) { return !(c.*member).empty(); });
    };
    std::string out = fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n",
        escaped(suite), cases.size(), count(&Case::failure), count(&Case::skipped));
    for (const Case& c : cases) {
        out += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escaped(suite),
                           escaped(c.name));
        if (with_times) out += fmt::format(" time=\"{:.3f}\"", c.seconds);
        if (!c.failure.empty())
            out += fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                               escaped(c.failure), escaped(c.details));
        else if (!c.skipped.empty())
            out += fmt::format(">\n      <skipped message=\"{}\"/>\n    </testcase>\n",
                               escaped(c.skipped));
        else
            out += "/>\n";
    }
    return out + "  </testsuite>\n";
}

}  // namespace

std::string to_junit(Verifications verifications, bool with_times)
{
    std::string out =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"lobec verify\">\n";
    for (const analyze::Verification& verification : verifications) {
        std::vector<std::string> targets;
        const auto know = [&targets](const std::string& target) {
            if (std::ranges::find(targets, target) == targets.end()) targets.push_back(target);
        };
        for (const analyze::Judgement& judgement : verification.judgements) know(judgement.target);
        for (const analyze::Row& row : verification.rows) know(row.target);
        for (const analyze::RoundTrip& trip : verification.round_trips) know(trip.target);
        for (const std::string& target : targets) {
            std::vector<Case> cases;
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
            out += write(verification.module + "." + target, cases, with_times);
        }
    }
    return out + "</testsuites>\n";
}

}  // namespace lobe::report
