#include "report/junit_suite.h"

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

std::string write(const JunitSuite& suite, bool with_times)
{
    const auto count = [&suite](std::string JunitCase::*member) {
        return std::ranges::count_if(suite.cases,
                                     [member](const JunitCase& c) { return !(c.*member).empty(); });
    };
    std::string out = fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n",
        escaped(suite.name), suite.cases.size(), count(&JunitCase::failure),
        count(&JunitCase::skipped));
    for (const JunitCase& c : suite.cases) {
        out += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escaped(suite.name),
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

std::string to_junit(std::string_view name, const std::vector<JunitSuite>& suites, bool with_times)
{
    std::string out = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\">\n", escaped(name));
    for (const JunitSuite& suite : suites) out += write(suite, with_times);
    return out + "</testsuites>\n";
}

}  // namespace lobe::report
