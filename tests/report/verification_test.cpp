// The four forms of one verification say the same, and equal results give equal bytes.
#include "report/verification.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <limits>

using namespace lobe;

namespace {

analyze::WorstError worst(double size)
{
    analyze::Witness at;
    at.point = 7;
    at.result = 0.25;
    at.exact = 0.2500001;
    at.low = 0.2499999;
    at.high = std::numeric_limits<double>::infinity();
    at.inputs = "roughness = 0.5, l = (0, 0, 1)";
    at.kind = "l = v; values at 0";
    return {size, at};
}

analyze::Agreement agreement(std::size_t outside)
{
    analyze::Agreement out;
    out.points = 65536;
    out.undefined = 12;
    out.outside = outside;
    out.not_a_number = outside / 2;
    out.ulp = worst(3.5);
    out.ulp_of_99_percent = 1.25;
    out.relative = worst(2.1e-7);
    out.absolute = worst(1e-6);
    if (outside > 0) out.example = worst(1).at;
    return out;
}

analyze::Row row(std::string term, std::string target, std::size_t outside = 0)
{
    analyze::Row out;
    out.term = std::move(term);
    out.target = std::move(target);
    out.executed = true;
    out.direct = agreement(0);
    out.optimized = agreement(outside);
    out.run_seconds = 0.125;
    out.judgements.push_back({"harness of " + out.term, out.target, "glslang", true, {}});
    return out;
}

analyze::Verification sample()
{
    analyze::Verification out;
    out.module = "sample";
    out.device = "a device";
    out.notes = {"float16: the device does not compute in it"};
    out.rows = {row("D_GGX", "glsl450"), row("D_GGX", "ue4")};
    out.judgements.push_back({"sample.glsl", "glsl450", "glslang", true, {}});
    out.seconds = 1.5;
    return out;
}

analyze::Verification failing()
{
    analyze::Verification out = sample();
    out.rows.push_back(row("F<x> & \"y\"", "hlsl", 4));
    out.judgements.push_back({"sample.ush",
                              "ue4",
                              "spirv-val",
                              false,
                              {{3, "error: 'a < b' is \x01 not \"it\"", std::nullopt}}});
    return out;
}

/// Two targets of a packing; of the second, the optimizer loses a code.
analyze::Verification with_round_trips()
{
    analyze::Verification out = sample();
    analyze::RoundTrip trip;
    trip.packing = "callisto on ue4";
    trip.target = "glsl450";
    trip.channels = 4;
    trip.codes = 1024;
    trip.points = 3072;
    trip.promised = 3072;
    trip.executed = true;
    trip.judgements.push_back({"harness of callisto", "glsl450", "glslang", true, {}});
    out.round_trips.push_back(trip);
    trip.target = "ue4";
    trip.optimized = {2, 1, 3, analyze::LostCode{"d.b", "d.r = 1/255, d.b = 37/255", 37, 38.25}};
    trip.judgements[0].target = "ue4";
    out.round_trips.push_back(trip);
    return out;
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
        ++found;
    return found;
}

}  // namespace

TEST_CASE("totals count rows, results and verdicts", "[report]")
{
    const analyze::Verification both[] = {sample(), failing()};
    const report::Totals sum = report::totals(both);
    CHECK(sum.rows == 5);
    CHECK(sum.failed_rows == 1);
    CHECK(sum.executions == 5 * 2 * 65536);
    CHECK(sum.outside == 4);
    CHECK(sum.undefined == 5 * 2 * 12);
    CHECK(sum.verdicts == 8);
    CHECK(sum.refusals == 1);
    CHECK_FALSE(sum.ok());
    CHECK(report::totals({both, 1}).ok());
}

TEST_CASE("the table has one row per term, target and precision", "[report]")
{
    const analyze::Verification one = failing();
    const report::Table table = report::verification_table({&one, 1});
    REQUIRE(table.rows.size() == 3);
    for (const auto& cells : table.rows) CHECK(cells.size() == table.columns.size());
    CHECK(table.rows[0][3].text == "ok");
    CHECK(table.rows[2][3].text == "FAIL");
    CHECK(table.rows[2][5].text == "0 / 4");
}

TEST_CASE("findings tell where, and are empty when there are none", "[report]")
{
    const analyze::Verification good = sample();
    CHECK(report::findings({&good, 1}, {}).empty());
    const analyze::Verification bad = failing();
    const std::string text = report::findings({&bad, 1}, {});
    CHECK(text.find("optimized: 4 of 65,536 points, 2 of them NaN") != std::string::npos);
    CHECK(text.find("roughness = 0.5, l = (0, 0, 1)") != std::string::npos);
    CHECK(text.find("spirv-val rejects sample.ush") != std::string::npos);
}

TEST_CASE("JSON reads back, with what is not finite as text", "[report]")
{
    const analyze::Verification bad = failing();
    const auto json = nlohmann::json::parse(report::to_json({&bad, 1}, false));
    CHECK(json["ok"] == false);
    CHECK(json["summary"]["outside"] == 4);
    const auto& last = json["modules"][0]["rows"][2];
    CHECK(last["term"] == "F<x> & \"y\"");
    CHECK(last["optimized"]["example"]["high"] == "inf");
    CHECK(last["direct"]["worst_ulp"]["size"] == 3.5);
    CHECK(json["modules"][0]["refusals"].size() == 1);
    CHECK_FALSE(last.contains("measured"));
    const auto timed = nlohmann::json::parse(report::to_json({&bad, 1}, true));
    CHECK(timed["modules"][0]["measured"]["seconds"] == 1.5);
}

TEST_CASE("JUnit has a case per row and per file, escaped", "[report]")
{
    const analyze::Verification bad = failing();
    const std::string xml = report::to_junit({&bad, 1}, false);
    CHECK(count(xml, "<testsuite ") == 3);
    CHECK(count(xml, "<testcase ") == 5);
    CHECK(count(xml, "<failure ") == 2);
    CHECK(xml.find("F&lt;x&gt; &amp; &quot;y&quot;") != std::string::npos);
    CHECK(xml.find('\x01') == std::string::npos);
    CHECK(xml.find("time=") == std::string::npos);
    CHECK(report::to_junit({&bad, 1}, true).find("time=\"0.125\"") != std::string::npos);
}

TEST_CASE("rows that did not run are skipped in JUnit, with the reason", "[report]")
{
    analyze::Verification none = sample();
    none.device.clear();
    none.no_device = "no Vulkan driver";
    for (analyze::Row& row : none.rows) row.executed = false;
    const std::string xml = report::to_junit({&none, 1}, false);
    CHECK(count(xml, "<skipped message=\"no Vulkan driver\"/>") == 2);
    CHECK(report::summary({&none, 1}, {}, false).find("no Vulkan driver") != std::string::npos);
}

TEST_CASE("the page stands alone and shows every row", "[report]")
{
    const analyze::Verification bad = failing();
    const std::string page = report::to_page({&bad, 1}, false);
    for (const char* outside : {"http:", "https:", "src=", "href=", "<script", "@import"})
        CHECK(page.find(outside) == std::string::npos);
    CHECK(count(page, "<svg ") == 3);
    CHECK(page.find("F&lt;x&gt; &amp; &quot;y&quot;") != std::string::npos);
    CHECK(page.find("prefers-color-scheme: dark") != std::string::npos);
    CHECK(page.find("1 of 1 refused") != std::string::npos);
}

TEST_CASE("round trips are in every form, with the code that was lost", "[report][round_trip]")
{
    analyze::Verification one = with_round_trips();
    const report::Verifications all{&one, 1};
    const report::Totals sum = report::totals(all);
    CHECK(sum.round_trips == 2);
    CHECK(sum.failed_round_trips == 1);
    CHECK(sum.verdicts == 3 + 2);
    CHECK_FALSE(sum.ok());

    const report::Table table = report::round_trip_table(all);
    REQUIRE(table.rows.size() == 2);
    for (const auto& cells : table.rows) CHECK(cells.size() == table.columns.size());
    CHECK(table.rows[0][2].text == "ok");
    CHECK(table.rows[1][2].text == "FAIL");
    CHECK(table.rows[1][6].text == "2");

    CHECK(report::findings(all, {}) ==
          "lost callisto on ue4, ue4, optimized: 2 of 3,072 points came back with another code, 1 "
          "have a value outside its interval\n"
          "      at d.r = 1/255, d.b = 37/255\n"
          "      d.b came back as 38.25, not 37\n");
    CHECK(
        report::summary(all, {}, false)
            .find("codes     1,024 codes of 4 channels unpacked and packed, on the CPU and on the "
                  "device, 2 targets: 2 points lost, no conforming device can lose one\n") !=
        std::string::npos);

    const auto json = nlohmann::json::parse(report::to_json(all, false));
    CHECK(json["ok"] == false);
    CHECK(json["summary"]["failed_round_trips"] == 1);
    const auto& lost = json["modules"][0]["round_trips"][1];
    CHECK(lost["optimized"]["example"]["channel"] == "d.b");
    CHECK(lost["optimized"]["example"]["expected"] == 37);
    CHECK(lost["cpu"]["lost"] == 0);

    const std::string xml = report::to_junit(all, false);
    CHECK(count(xml, "name=\"callisto on ue4 round trip\"") == 2);
    CHECK(count(xml, "<failure message=\"0 points lost on the CPU, 0 direct, 2 after") == 1);

    const std::string page = report::to_page(all, false);
    CHECK(count(page, "<td class=\"\">callisto on ue4</td>") == 2);
    CHECK(page.find("1 of 2 round trips lose codes") != std::string::npos);

    one.round_trips[1].optimized = {};
    CHECK(report::totals(all).ok());
    CHECK(report::findings(all, {}).empty());
    CHECK(report::summary(all, {}, false).find("none lost") != std::string::npos);
    // Without a device the CPU's word is all there is.
    for (analyze::RoundTrip& trip : one.round_trips) trip.executed = false;
    CHECK(report::summary(all, {}, false).find("packed, on the CPU: none lost") !=
          std::string::npos);
}

TEST_CASE("without packings nothing is said of codes", "[report][round_trip]")
{
    const analyze::Verification one = sample();
    CHECK(report::round_trip_table({&one, 1}).rows.empty());
    CHECK(report::summary({&one, 1}, {}, false).find("codes") == std::string::npos);
    CHECK(report::to_page({&one, 1}, false).find("<h2>Codes</h2>") == std::string::npos);
}

TEST_CASE("measured times do not reach files unless asked for", "[report]")
{
    const analyze::Verification one = sample();
    analyze::Verification slower = one;
    slower.seconds = 99;
    slower.rows[0].run_seconds = 77;
    const auto equal = [&](const auto& write) {
        CHECK(write({&one, 1}, false) == write({&slower, 1}, false));
        CHECK(write({&one, 1}, true) != write({&slower, 1}, true));
    };
    equal([](report::Verifications v, bool times) { return report::to_json(v, times); });
    equal([](report::Verifications v, bool times) { return report::to_junit(v, times); });
    equal([](report::Verifications v, bool times) { return report::to_page(v, times); });
    equal([](report::Verifications v, bool times) { return report::summary(v, {}, times); });
}
