// `lobec pareto`, and `lobec build` within a limit, as a user runs them. Costs need RADV, which
// runs without its hardware; where it is not installed, what is said instead is tested.
#include "command.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;
using nlohmann::json;

namespace {

/// A term with a cheap form that is 9 % off where it is 0.18 or more, and a model that calls it.
const std::string terms = R"(module small

/// A dear way.
term dear(x: unit) -> float in [0, 4] = 0.25 + x^3.5 * sqrt(x + 0.5) + 2^(x * 0.5)
  /// Off by a tenth.
  form cheap = 1.25 + x

)";
const std::string model = terms + R"(/// A model.
model small(g: geometry, s: surface) {
  diffuse = dear(g.cos_o) * s.diffuse_color * g.cos_i
}
)";

/// Results are kept in the test's own folder.
constexpr const char* pareto = "lobec pareto small.lobe --points 2048 --cache kept";

bool has_costs(const Scratch& scratch)
{
    const Outcome outcome = scratch.run(pareto);
    REQUIRE(outcome.status == 0);
    const bool has = outcome.out.find("no costs") == std::string::npos;
    if (!has) WARN("RADV is not installed: " << outcome.out);
    return has;
}

json candidate(const json& trade, const std::string& name)
{
    for (const json& each : trade["candidates"])
        if (each["name"] == name) return each;
    FAIL("no candidate " << name);
    return {};
}

/// The file, judged as a whole shader.
lobe::verify::Verdict judged(const std::string& text)
{
    return lobe::verify::compile("#version 450\n" + text + "\nvoid main() {}\n",
                                 lobe::verify::Dialect::glsl, lobe::verify::Stage::fragment);
}

}  // namespace

TEST_CASE("pareto shows every way, what dominates it, and how to see it again")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const Outcome outcome = scratch.run(fmt::format("{} --json out.json", pareto));
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("definition") && Contains("dear: cheap") &&
                                Contains("lobec pareto small.lobe --term dear"));
    const json all = json::parse(scratch.read("out.json"));
    const json& trade = all["modules"][0]["trades"][0];
    CHECK(trade["name"] == "dear");
    CHECK(candidate(trade, "definition")["model"]["worst"] == 0);
    CHECK(candidate(trade, "dear: cheap")["model"]["worst"] > 0.01);
    CHECK(candidate(trade, "dear: cheap")["forms"]["dear"] == "cheap");
    if (!has_costs(scratch)) return;
    CHECK_THAT(outcome.out, Contains("frontier"));
    CHECK(candidate(trade, "definition")["standing"]["rdna2"]["on_frontier"] == true);
    CHECK(candidate(trade, "dear: cheap")["standing"]["gcn4"]["on_frontier"] == true);
    CHECK(candidate(trade, "dear: cheap")["cost_given_fields"]["rdna2"]["issue_cycles"] <
          candidate(trade, "definition")["cost_given_fields"]["rdna2"]["issue_cycles"]);
    // Equal questions, equal answers.
    CHECK(outcome.out == scratch.run("lobec pareto small.lobe --points 2048 --no-cache -j 1").out);
}

TEST_CASE("a narrower box has another trade")
{
    const Scratch scratch;
    scratch.write(
        "small.lobe",
        "module small\nparam gain: float in [0, 4] = 1\n" +
            model.substr(model.find("\n\n"))
                .replace(model.substr(model.find("\n\n")).find("dear(g.cos_o)"), 4, "gain * dear"));
    const Outcome outcome = scratch.run(fmt::format("{} --model small --set gain=0", pareto));
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    // What is multiplied by 0 is not there, so there is nothing to choose.
    CHECK(outcome.out.find("dear: cheap") == std::string::npos);
    CHECK_THAT(outcome.out, Contains("--set gain=0"));
    CHECK(scratch.run(fmt::format("{} --set gain=5", pareto)).status == 2);
    CHECK(scratch.run(fmt::format("{} --set gain", pareto)).status == 2);
    CHECK_THAT(scratch.run(fmt::format("{} --set gian=1", pareto)).err,
               Contains("did you mean `gain`?"));
}

TEST_CASE("pareto says what it does not know")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    const Outcome term = scratch.run(fmt::format("{} --term daer", pareto));
    CHECK(term.status == 2);
    CHECK_THAT(term.err, Contains("no term `daer`; did you mean `dear`?"));
    CHECK(scratch.run(fmt::format("{} --model small2", pareto)).status == 2);
    CHECK(scratch.run(fmt::format("{} --on rdna9", pareto)).status == 2);
    CHECK(scratch.run("lobec pareto missing.lobe").status == 2);
}

TEST_CASE("pareto has the error in parts, and the packing's")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    const Outcome outcome = scratch.run(fmt::format("{} --json out.json --html -", pareto));
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains(">proved</th>") && Contains("lobec pareto small.lobe"));
    const json trade = json::parse(scratch.read("out.json"))["modules"][0]["trades"][0];
    for (const std::string name : {"definition", "dear: cheap"}) {
        const json way = candidate(trade, name);
        CHECK(way["total"]["worst"] <=
              way["model"]["worst"].get<double>() + way["rounding"]["worst"].get<double>());
        CHECK(way["rounding"]["worst"] <= way["proved_rounding"]["bound"]);
        CHECK(way["total"].contains("codes"));
    }
    CHECK_THAT(scratch.run(pareto).out, Contains("rounding") && Contains("proved"));
}

TEST_CASE("pareto writes all that is asked for, or nothing")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    const auto refused = [&](const std::string& options, const std::string& message) {
        const Outcome outcome = scratch.run(fmt::format("{} {}", pareto, options));
        CAPTURE(options, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains(message));
        CHECK(scratch.read("ok.json").empty());
    };
    refused("--json ok.json --html small.lobe/x.html", "small.lobe");
    refused("--json - --html -", "only one of --json, --html can be standard output");
    refused("--points 3", "--points");
    refused("--json ok.json --term dear --model small --svg a.svg --set nothing=1", "nothing");
    scratch.write("empty.lobe", "module empty\nparam gain: float in [0, 4] = 1 \"Gain\"\n");
    for (const char* command : {"pareto", "cost"}) {
        const Outcome outcome = scratch.run(fmt::format("lobec {} empty.lobe", command));
        CAPTURE(command, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains("no term and no model"));
        CHECK(outcome.out.empty());
    }
    const Outcome without =
        scratch.run("VK_DRIVER_FILES=/none.json VK_ICD_FILENAMES=/none.json " +
                    fmt::format("{} --model small --svg a.svg --json ok.json", pareto));
    CHECK(without.status == 2);
    CHECK_THAT(without.err, Contains("--svg has no costs to draw"));
    CHECK(scratch.read("ok.json").empty());
}

TEST_CASE("build within an error takes the cheapest, and says so in every file")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    const bool has = has_costs(scratch);
    const Outcome outcome =
        scratch.run("lobec build small.lobe -o out --max-error 60% --cache kept");
    CAPTURE(outcome.out, outcome.err);
    if (!has) {
        CHECK(outcome.status == 1);
        return;
    }
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("small: dear: cheap"));
    const std::string glsl = scratch.read("out/small/glsl450/small.glsl");
    CHECK_THAT(glsl,
               Contains("// Chosen by: lobec build small.lobe --max-error 60% --on rdna2\n") &&
                   Contains("// small: dear: cheap") && Contains("dear_cheap("));
    CHECK(glsl.find("float dear(") == std::string::npos);
    CHECK(judged(glsl).accepted);
    for (const std::string file : {"ue4/Small.ush", "glsl330/small.glsl", "essl310/small.glsl",
                                   "essl300/small.glsl", "hlsl/small.hlsl"})
        CHECK_THAT(scratch.read("out/small/" + file), Contains("// Chosen by: lobec build"));
    CHECK(
        scratch.run("lobec build small.lobe -o out --max-error 60% --cache kept --check").status ==
        0);

    // Less than the form is off by: what is left is the definition.
    const Outcome exact =
        scratch.run("lobec build small.lobe -o exact --max-error 0.000001 --on gcn4 --cache kept");
    CAPTURE(exact.err);
    REQUIRE(exact.status == 0);
    const std::string defined = scratch.read("exact/small/glsl450/small.glsl");
    CHECK_THAT(defined, Contains("--max-error 0.0001% --on gcn4") && Contains("float dear("));
    CHECK(judged(defined).accepted);
    // And nothing of it is in what is built without a limit.
    REQUIRE(scratch.run("lobec build small.lobe -o plain").status == 0);
    CHECK(scratch.read("plain/small/glsl450/small.glsl").find("Chosen") == std::string::npos);
}

TEST_CASE("build within a budget takes the most accurate, or names the nearest possible")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    if (!has_costs(scratch)) return;
    const Outcome rich = scratch.run("lobec build small.lobe -o out --budget 1000 --cache kept");
    REQUIRE(rich.status == 0);
    CHECK_THAT(scratch.read("out/small/glsl450/small.glsl"),
               Contains("--budget 1000 --on rdna2") && Contains("float dear("));
    const Outcome poor = scratch.run("lobec build small.lobe -o poor --budget 0.5 --cache kept");
    CHECK(poor.status == 1);
    CHECK_THAT(poor.err, Contains("nothing in small.lobe fits --budget 0.5 --on rdna2") &&
                             Contains("the fewest cycles possible are"));
    CHECK(scratch.read("poor/small/glsl450/small.glsl").empty());
    const Outcome strict =
        scratch.run("lobec build small.lobe -o poor --max-error 0.0000001% --cache kept");
    CHECK(strict.status == 1);
    CHECK_THAT(strict.err, Contains("the least error possible is"));
    CHECK_FALSE(std::filesystem::exists(scratch.path() / "poor"));
}

TEST_CASE("models of a module are chosen for together, and it says what that costs")
{
    const Scratch scratch;
    // Alone, the first model would take the form, which is off by more than it is allowed to be in
    // the second.
    scratch.write("small.lobe", model + R"(
/// The same term, lit more.
model bright(g: geometry, s: surface) {
  diffuse = (dear(g.cos_o) + dear(g.cos_o)^3) * s.diffuse_color * g.cos_i
}
)");
    if (!has_costs(scratch)) return;
    const Outcome each = scratch.run(fmt::format("{} --json out.json", pareto));
    REQUIRE(each.status == 0);
    double limit = 0;
    const json all = json::parse(scratch.read("out.json"));
    for (const json& trade : all["modules"][0]["trades"])
        if (trade["name"] == "small") limit = candidate(trade, "dear: cheap")["error"];
    REQUIRE(limit > 0);
    const Outcome together = scratch.run(
        fmt::format("lobec build small.lobe -o out --max-error {} --cache kept", limit * 1.01));
    CAPTURE(together.out, together.err);
    REQUIRE(together.status == 0);
    CHECK_THAT(together.out, Contains("chosen for one by one they would take"));
    CHECK(together.out.find("dear: cheap") == std::string::npos);
    std::string banner = scratch.read("out/small/glsl450/small.glsl");
    banner = banner.substr(0, banner.find("#ifndef"));
    CHECK_THAT(banner, Contains("chosen for one by one"));
}

TEST_CASE("a term of a library takes its form's place, and its definition stays beside it")
{
    const Scratch scratch;
    scratch.write("small.lobe", terms);
    if (!has_costs(scratch)) return;
    const Outcome outcome =
        scratch.run("lobec build small.lobe -o out --max-error 60% --cache kept");
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    const std::string glsl = scratch.read("out/small/glsl450/small.glsl");
    CHECK_THAT(glsl, Contains("// dear: cheap.") && Contains("float dear(float x)") &&
                         Contains("float dear_definition(float x)"));
    CHECK(glsl.find("dear_cheap") == std::string::npos);
    CHECK(glsl.find("minimax") == std::string::npos);
    CHECK(judged(glsl).accepted);
}

TEST_CASE("limits that mean nothing are refused")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    for (const char* options :
         {"--max-error nope", "--max-error -1%", "--max-error 0", "--max-error 5%%", "--budget x",
          "--budget 0", "--budget 10%", "--max-error 1% --budget 10", "--on rdna2",
          "--max-error 1% --on rdna9"}) {
        CAPTURE(options);
        const Outcome outcome =
            scratch.run(fmt::format("lobec build small.lobe -o out {}", options));
        CHECK(outcome.status == 2);
        CHECK_FALSE(outcome.err.empty());
    }
    CHECK(scratch.entries() == 1);
}
