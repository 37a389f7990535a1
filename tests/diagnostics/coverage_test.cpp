// Every code of the registry has a page and a test. Codes that no .lobe file alone can cause are
// proved by a C++ test, which is named here and must name them.
#include "base/diagnostic.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

using namespace lobe;
namespace fs = std::filesystem;

namespace {

/// Code to the test that proves it, relative to tests/.
const std::map<std::string, std::string> elsewhere{
    {"E0001", "cli/bad_input_test.cpp"},    {"E0003", "cli/bad_input_test.cpp"},
    {"E0612", "analyze/radiance_test.cpp"}, {"E0701", "analyze/verify_test.cpp"},
    {"E0702", "cli/bad_input_test.cpp"},
};

std::string read(const fs::path& path)
{
    std::ifstream in{path, std::ios::binary};
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

bool has_case(const std::string& id)
{
    for (const auto& entry : fs::directory_iterator{"diagnostics"}) {
        const fs::path path = entry.path();
        if (path.extension() != ".lobe" || !path.filename().string().starts_with(id + "_"))
            continue;
        if (fs::exists(fs::path{path}.replace_extension(".txt"))) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("every code has a test", "[diagnostics][coverage]")
{
    for (const Code code : all_codes()) {
        const std::string name{id(code)};
        CAPTURE(name);
        const auto found = elsewhere.find(name);
        if (found == elsewhere.end()) {
            CHECK(has_case(name));
        } else {
            CAPTURE(found->second);
            CHECK(read(found->second).find(name) != std::string::npos);
        }
    }
}

TEST_CASE("every code has a page", "[diagnostics][coverage]")
{
    for (const Code code : all_codes()) {
        const std::string name{id(code)};
        CAPTURE(name);
        const std::string page = read(fs::path{"../docs/diagnostics"} / (name + ".md"));
        CHECK(page.starts_with("# " + name));
        // What, why, an example, ways out: not less than that fits in this.
        CHECK(page.size() > 300);
    }
}

TEST_CASE("there is no page and no case of a code that does not exist", "[diagnostics][coverage]")
{
    for (const auto& entry : fs::directory_iterator{"../docs/diagnostics"}) {
        CAPTURE(entry.path().string());
        CHECK(find_code(entry.path().stem().string()).has_value());
    }
    for (const auto& entry : fs::directory_iterator{"diagnostics"}) {
        const std::string name = entry.path().filename().string();
        const bool numbered =
            name.size() > 5 && (name[0] == 'E' || name[0] == 'W') && name[5] == '_';
        CAPTURE(name);
        if (numbered) CHECK(find_code(name.substr(0, 5)).has_value());
        if (entry.path().extension() == ".txt" && numbered)
            CHECK(fs::exists(fs::path{entry.path()}.replace_extension(".lobe")));
    }
}
