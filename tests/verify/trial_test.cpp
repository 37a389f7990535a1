// A text goes from judge to judge until one refuses.
#include "verify/harness_texts.h"
#include "verify/trial.h"

#include <catch2/catch.hpp>

#include <string>

using namespace lobe::verify;

namespace {

std::vector<std::string> names(const Trial& trial)
{
    std::vector<std::string> result;
    for (const Step& step : trial.steps) result.push_back(step.name);
    return result;
}

}  // namespace

TEST_CASE("float shaders of every dialect pass all judges in four languages")
{
    for (const HarnessText& harness : harness_texts) {
        if (harness.float16) continue;
        CAPTURE(harness.name);
        const Trial trial = chain(harness.text, harness.dialect, Stage::compute, Route::vulkan);
        CHECK(names(trial) ==
              std::vector<std::string>{"compile", "validate", "optimize", "validate optimized",
                                       "to glsl450", "glsl450 again", "to essl310", "essl310 again",
                                       "to hlsl50", "hlsl50 again", "to msl21"});
        if (const Step* refusal = trial.first_refusal())
            FAIL(refusal->name << ": " << refusal->verdict.messages.at(0).text);
        CHECK(trial.accepted());
    }
}

TEST_CASE("one cross-compiler's refusal does not silence the others")
{
    // ESSL 3.10 has no half floats in core.
    for (const HarnessText& harness : harness_texts) {
        if (!harness.float16) continue;
        const Trial trial = chain(harness.text, harness.dialect, Stage::compute, Route::vulkan);
        REQUIRE_FALSE(trial.accepted());
        CHECK(trial.first_refusal()->name.find("essl310") != std::string::npos);
        CHECK(trial.steps.back().name == "to msl21");
        CHECK(trial.steps.back().verdict.accepted);
    }
}

TEST_CASE("a trial ends where there is nothing left to judge")
{
    const Trial trial =
        chain("#version 450\nvoid main() { x; }\n", Dialect::glsl, Stage::compute, Route::vulkan);
    CHECK(names(trial) == std::vector<std::string>{"compile"});
    CHECK_FALSE(trial.accepted());
    REQUIRE(trial.first_refusal() != nullptr);
    CHECK(trial.first_refusal()->verdict.messages.at(0).line == 2);
}

TEST_CASE("under OpenGL rules a text is only parsed")
{
    const Trial trial =
        chain("#version 330\nvoid main() {}\n", Dialect::glsl, Stage::fragment, Route::opengl);
    CHECK(names(trial) == std::vector<std::string>{"parse"});
    CHECK(trial.accepted());
    CHECK(trial.first_refusal() == nullptr);
}
