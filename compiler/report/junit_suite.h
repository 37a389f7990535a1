// JUnit XML, as continuous integration reads it: suites of cases. Who has results says which cases
// there are; what the format needs is decided here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobe::report {

struct JunitCase {
    std::string name;
    std::string failure;  ///< empty: it passed
    std::string details;  ///< of the failure
    std::string skipped;  ///< why it did not run; empty: it ran
    double seconds = 0;
};

struct JunitSuite {
    std::string name;
    std::vector<JunitCase> cases;
};

/// `name` is the command's. Times only when asked for, so that equal results give equal files.
std::string to_junit(std::string_view name, const std::vector<JunitSuite>& suites, bool with_times);

}  // namespace lobe::report
