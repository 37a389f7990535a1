// The files that small modules become, one feature each, byte for byte.
#include "emit/cases.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace lobe::tests {
namespace {

std::string read(const std::string& path)
{
    std::ifstream file{path};
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("each feature of emission has the text that was agreed on", "[emit][golden]")
{
    for (const GoldenCase& golden : golden_cases()) {
        INFO(golden_path(golden));
        CHECK(golden_text(golden) == read(golden_path(golden)));
    }
}

TEST_CASE("no golden file is without its case", "[emit][golden]")
{
    std::set<std::string> known;
    for (const GoldenCase& golden : golden_cases()) known.insert(golden_path(golden));
    for (const auto& entry : std::filesystem::directory_iterator{"emit/golden"})
        CHECK(known.contains("emit/golden/" + entry.path().filename().string()));
}

}  // namespace lobe::tests
