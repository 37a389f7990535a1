// The models that ship agree with every witness, on every target. `lobec verify models` does the
// same at all 65,536 points; an eighth of them keeps the test quick.
#include "analyze/checked.h"
#include "analyze/verify.h"
#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>

#include <set>

using namespace lobe;

namespace {

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
    const tests::Checked checked = tests::checked_model("../models/" + name + ".lobe");
    const Sources& sources = checked.sources;
    const ir::Module legal = middle(checked.module);
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
    const tests::Checked checked =
        tests::checked_text("module scene\n"
                            "import callisto { callisto_lambert }\n"
                            "import lights { punctual, spot, capsule }\n");
    const Sources& sources = checked.sources;
    const ir::Module legal = middle(checked.module);
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
