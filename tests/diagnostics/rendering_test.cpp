// Every .lobe file here named after a code is checked, and what the check says is compared with the
// .txt beside it, to the byte. To take over a changed rendering after reading it:
//
//     LOBE_REWRITE=1 build/<preset>/tests/diagnostics/test-diagnostics
#include "base/render.h"
#include "check/check.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace lobe;
namespace fs = std::filesystem;

namespace {

std::optional<std::string> read(const fs::path& path)
{
    std::ifstream in{path, std::ios::binary};
    if (!in) return std::nullopt;
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Paths in messages are relative to the root of the repository; tests run in tests/.
std::optional<std::uint32_t> add(Sources& sources, const fs::path& name)
{
    const fs::path shown = fs::path{"tests/diagnostics"} / name;
    for (std::size_t i = 0; i < sources.size(); ++i)
        if (sources[static_cast<std::uint32_t>(i)].path() == shown.generic_string())
            return static_cast<std::uint32_t>(i);
    auto text = read(fs::path{"diagnostics"} / name);
    if (!text) return std::nullopt;
    return sources.add(shown.generic_string(), std::move(*text));
}

std::string rendered(const fs::path& name, Diagnostics& diagnostics)
{
    Sources sources;
    const auto root = add(sources, name);
    const check::Loader loader = [](Sources& all, std::string_view module, std::string_view) {
        return add(all, std::string{module} + ".lobe");
    };
    const auto module = check::check(sources, *root, loader, diagnostics);
    CHECK(module.has_value() == !diagnostics.has_errors());
    return render_text(sources, diagnostics);
}

std::vector<fs::path> cases()
{
    std::vector<fs::path> names;
    for (const auto& entry : fs::directory_iterator{"diagnostics"}) {
        const fs::path name = entry.path().filename();
        const bool coded = find_code(name.string().substr(0, name.string().find('_'))).has_value();
        if (name.extension() == ".lobe" && coded) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST_CASE("what a diagnostic says is what is on file", "[diagnostics]")
{
    const auto names = cases();
    REQUIRE(names.size() > 20);
    for (const fs::path& name : names) {
        CAPTURE(name.string());
        Diagnostics diagnostics;
        const std::string text = rendered(name, diagnostics);
        const fs::path expected =
            fs::path{"diagnostics"} / fs::path{name}.replace_extension(".txt");
        if (std::getenv("LOBE_REWRITE") != nullptr)
            std::ofstream{expected, std::ios::binary} << text;
        CHECK(read(expected).value_or("(no file)") == text);
    }
}

TEST_CASE("a file named after a code shows that code", "[diagnostics]")
{
    for (const fs::path& name : cases()) {
        CAPTURE(name.string());
        const auto code = find_code(name.string().substr(0, name.string().find('_')));
        Diagnostics diagnostics;
        rendered(name, diagnostics);
        CHECK(std::any_of(diagnostics.all().begin(), diagnostics.all().end(),
                          [&](const Diagnostic& diagnostic) { return diagnostic.code == *code; }));
    }
}

TEST_CASE("edits stay inside the text and change it", "[diagnostics]")
{
    for (const fs::path& name : cases()) {
        CAPTURE(name.string());
        Diagnostics diagnostics;
        rendered(name, diagnostics);
        Sources sources;
        const auto root = add(sources, name);
        for (const Diagnostic& diagnostic : diagnostics.all()) {
            if (!diagnostic.fix || diagnostic.fix->span.source != *root) continue;
            const Span span = diagnostic.fix->span;
            CAPTURE(diagnostic.message);
            CHECK(span.begin <= span.end);
            REQUIRE(span.end <= sources[*root].text().size());
            CHECK(sources.text(span) != diagnostic.fix->replacement);
        }
    }
}
