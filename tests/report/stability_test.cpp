// The forms of one stability report agree with each other and with the results.
#include "report/stability.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <limits>

using namespace lobe;
using Catch::Contains;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

analyze::Proof proof(std::string function, std::size_t open = 0)
{
    analyze::Proof out;
    out.function = std::move(function);
    out.finite = open == 0;
    out.open_count = open;
    if (open > 0) out.open.push_back({{{"cos_i", {0, 0x1p-20}}}});
    out.ieee = {4e-7, infinite, 1e-7, 3e-7, "alpha = 1"};
    out.vulkan = {8e-7, infinite, 0, 0, ""};
    out.boxes = 1234;
    return out;
}

analyze::Stability sample(std::size_t open = 0, std::size_t bad = 0)
{
    analyze::Stability out;
    out.module = "sample";
    out.proofs = {proof("V", open)};
    analyze::Proof half = proof("V");
    half.precision = evaluate::Precision::float16;
    half.finite = false;
    half.refused = "divide overflows";
    out.proofs.push_back(half);

    analyze::FunctionHazards of;
    of.function = "V";
    analyze::Hazard hazard;
    hazard.kind = analyze::HazardKind::domain;
    hazard.operation = "divide";
    hazard.expression = "0.5 / (i + o)";
    hazard.witness = "cos_i = 0, cos_o = 0";
    hazard.share = 0.01;
    hazard.remedy =
        analyze::Remedy{"guarded limit", "select", std::array<double, 5>{8, 8, 2, 2, 2}};
    of.naive = {hazard};
    out.hazards = {of};

    analyze::CornerRow row;
    row.function = "V";
    row.target = "glsl450";
    row.points = 2000;
    row.not_a_number = bad;
    if (bad > 0) row.example = "cos_i = 0: NaN";
    out.corners.rows = {row};
    out.corners.continuity = {{"V", "n.l = 0", 0.06, 0.3, false, "alpha = 1"},
                              {"V", "v.l = 0", 0, 0.3, true, ""}};
    out.physics = {{"V", analyze::Law::positive, "everywhere", 0, 0, 0, true, ""}};
    return out;
}

}  // namespace

TEST_CASE("tables show what was found")
{
    const analyze::Stability stability = sample();
    const std::string text = report::to_text(stability, {});
    CHECK_THAT(text, Contains("proved") && Contains("no: divide overflows"));
    CHECK_THAT(text, Contains("0.5 / (i + o)") && Contains("guarded limit") && Contains("+2"));
    CHECK_THAT(text, Contains("n.l = 0"));
    CHECK_THAT(text, !Contains("v.l = 0"));  // continuous
    // The bound in the measure that was proved: 4e-7 / 1e-7.
    CHECK(report::proof_table(stability.proofs).rows[0][5].text == "4");
}

TEST_CASE("an open box or a NaN is said by every form")
{
    const bool open = GENERATE(true, false);
    const analyze::Stability stability = open ? sample(3, 0) : sample(0, 5);
    REQUIRE_FALSE(stability.ok());
    CHECK(nlohmann::json::parse(report::to_json({&stability, 1}))["ok"] == false);
    const std::string junit = report::to_junit({&stability, 1});
    CHECK_THAT(junit, Contains("failures=\"1\""));
    CHECK_THAT(junit, Contains(open ? "cos_i" : "cos_i = 0: NaN"));
    CHECK(report::stability_verdict({&stability, 1}).style == report::Style::bad);
    CHECK_THAT(report::summary({&stability, 1}, {}),
               Contains(open ? "3 open boxes" : "5 NaN, infinite or not run"));
}

TEST_CASE("a bound that says nothing is told as none")
{
    analyze::Stability stability = sample();
    analyze::Proof vague = proof("integral");
    vague.ieee.absolute = 1e30;
    stability.proofs.push_back(vague);
    CHECK_THAT(report::summary({&stability, 1}, {}),
               Contains("at most 4 times the observed error (V); none for integral\n"));
}

TEST_CASE("nothing open and nothing infinite is a success in every form")
{
    const analyze::Stability stability = sample();
    REQUIRE(stability.ok());
    const auto json = nlohmann::json::parse(report::to_json({&stability, 1}));
    CHECK(json["ok"] == true);
    const auto& proof_json = json["modules"][0]["proofs"][0];
    CHECK(proof_json["cpu"]["relative"] == "inf");
    CHECK(proof_json["cpu"]["ratio"] == 4);
    CHECK_THAT(report::to_junit({&stability, 1}), !Contains("<failure"));
    CHECK(report::stability_sections(stability, "m.lobe").front().command ==
          "lobec stability m.lobe");
}

TEST_CASE("half does not fail a run that does not claim it")
{
    analyze::Stability stability = sample();
    analyze::CornerRow row = stability.corners.rows[0];
    row.precision = emit::Precision::float16;
    row.required = false;
    row.infinite = 9;
    stability.corners.rows.push_back(row);
    CHECK(stability.ok());
    CHECK_THAT(report::to_junit({&stability, 1}), Contains("not claimed: 9 results"));
}

TEST_CASE("half fails a run where a proof claims it")
{
    analyze::Stability stability = sample();
    analyze::CornerRow row = stability.corners.rows[0];
    row.precision = emit::Precision::float16;
    row.claim = "x in [0, 1]";
    stability.corners.rows.push_back(row);
    CHECK(stability.ok());
    stability.corners.rows.back().infinite = 9;
    CHECK_FALSE(stability.ok());
    CHECK_THAT(report::to_junit({&stability, 1}), Contains("where proved"));
}
