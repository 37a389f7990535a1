// The models that ship agree with every witness, on every target. `lobec verify models` does the
// same at all 65,536 points; an eighth of them keeps the test quick.
#include "analyze/verify.h"
#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <set>

using namespace lobe;

namespace {

std::optional<std::uint32_t> add_model(Sources& sources, std::string_view name)
{
    const std::string path = "models/" + std::string{name} + ".lobe";
    std::ifstream in{"../" + path, std::ios::binary};
    if (!in) return std::nullopt;
    return sources.add(path, {std::istreambuf_iterator<char>{in}, {}});
}

/// One line per thing that is wrong, so that a failure says what to look at.
std::string complaints_of(const analyze::Verification& verification, const ir::Module& module,
                          const Sources& sources)
{
    std::string out = render_text(sources, analyze::complaints(verification, module));
    for (const analyze::Row& row : verification.rows) {
        if (!row.failure.empty()) out += row.term + " on " + row.target + ": " + row.failure + "\n";
        for (const analyze::Agreement* agreement : {&row.direct, &row.optimized})
            if (agreement->example)
                out += row.term + " on " + row.target + ": " + std::to_string(agreement->outside) +
                       " outside, one at " + agreement->example->inputs + "\n";
    }
    return out;
}

}  // namespace

TEST_CASE("every shipped function agrees on every target and both routes", "[shipped][device]")
{
    const std::string name = GENERATE("microfacet", "callisto", "ue4", "environment", "lights");
    CAPTURE(name);
    Sources sources;
    Diagnostics diagnostics;
    const auto root = add_model(sources, name);
    REQUIRE(root);
    const auto module = front(
        sources, *root,
        [](Sources& all, std::string_view imported, std::string_view) {
            return add_model(all, imported);
        },
        diagnostics);
    INFO(render_text(sources, diagnostics));
    REQUIRE(module);

    const ir::Module legal = middle(*module);
    analyze::VerifyOptions options;
    options.points = 8192;
    const analyze::Verification result = analyze::verify(legal, sources, options);
    REQUIRE(result.no_device == "");
    CHECK(complaints_of(result, legal, sources) == "");
    CHECK(result.ok());

    std::set<std::string> terms;
    for (const analyze::Row& row : result.rows) {
        CAPTURE(row.term, row.target);
        CHECK(row.executed);
        terms.insert(row.term);
        // In half, the square of a distance ends at 256.
        if (name == "lights" && row.precision == emit::Precision::float16) continue;
        // Undefined points are few: a check of nothing would pass everything.
        const std::size_t half = options.points / 2;
        CHECK(row.direct.undefined < half);
    }
    for (const ir::FunctionId function : analyze::checked_functions(legal))
        CHECK(terms.count(legal[function].name) == 1);
}

TEST_CASE("what shades a model under a light agrees on every target", "[shipped][device][lights]")
{
    Sources sources;
    Diagnostics diagnostics;
    const auto root = sources.add("scene.lobe", "module scene\n"
                                                "import callisto { callisto_lambert }\n"
                                                "import lights { punctual, spot, capsule }\n");
    const auto module = front(
        sources, root,
        [](Sources& all, std::string_view imported, std::string_view) {
            return add_model(all, imported);
        },
        diagnostics);
    INFO(render_text(sources, diagnostics));
    REQUIRE(module);
    const ir::Module legal = middle(*module);
    analyze::VerifyOptions options;
    options.points = 1024;
    options.precisions = {emit::Precision::float32};
    const analyze::Verification result = analyze::verify(legal, sources, options);
    CHECK(complaints_of(result, legal, sources) == "");
    CHECK(result.ok());
    // Three lights on six targets.
    CHECK(result.rows.size() == 18);
    for (const analyze::Row& row : result.rows) {
        CAPTURE(row.term, row.target);
        CHECK(row.executed);
        CHECK(row.direct.undefined == 0);
    }
}
