// Writes what the golden files of emission would be now: the `regenerate-emit` target. Read the
// difference before committing it.
#include "emit/cases.h"

#include <fmt/format.h>

#include <fstream>

int main(int, char** arguments)
{
    for (const lobe::tests::GoldenCase& golden : lobe::tests::golden_cases()) {
        const std::string path = fmt::format("{}/{}", arguments[1], golden_path(golden));
        std::ofstream{path} << golden_text(golden);
    }
}
