// What `lobec cost` prints, writes and reads back, from rows made by hand.
#include "report/cost.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <array>

using namespace lobe;
using analyze::Family;
using report::CostReport;
using report::CostRow;

namespace {

CostRow row(const std::string& name, double issue, bool whole_model = false)
{
    CostRow out{"toy", name, whole_model, "stable", "float", {}};
    for (std::size_t i = 0; i < analyze::all_families.size(); ++i) {
        const double more = static_cast<double>(i);
        out.cost.families[analyze::all_families[i]] = {.valu = issue - 1,
                                                       .transcendental = 1,
                                                       .issue = issue + more,
                                                       .inverse_throughput = 2 * issue,
                                                       .latency = 5 * issue,
                                                       .vgprs = 8,
                                                       .waves = 16};
    }
    out.cost.spirv_instructions = static_cast<int>(issue) + 2;
    return out;
}

CostReport sample()
{
    CostReport report;
    report.driver = "radv, Mesa 1";
    report.rows = {row("D_GGX", 6), row("F_Schlick", 7.5), row("skin", 100, true)};
    return report;
}

constexpr std::array two{Family::gcn4, Family::rdna2};
constexpr std::array one{Family::rdna2};

}  // namespace

TEST_CASE("several families show their issue cycles, one shows everything", "[cost]")
{
    CHECK(report::render(report::cost_table(sample(), two), {}) ==
          "term or model  gcn4  rdna2  SPIR-V\n"
          "D_GGX             6      9       8\n"
          "F_Schlick       7.5   10.5       9\n"
          "model skin      100    103     102\n");
    CHECK(report::render(report::cost_table(sample(), one), {}) ==
          "term or model  issue  VALU  trans  throughput  latency  VGPRs  waves  SPIR-V\n"
          "D_GGX              9     5      1          12       30      8     16       8\n"
          "F_Schlick       10.5   6.5      1          15     37.5      8     16       9\n"
          "model skin       103    99      1         200      500      8     16     102\n");
}

TEST_CASE("what differs between rows has a column, what is missing has none", "[cost]")
{
    CostReport report = sample();
    report.rows[1].format = "half";
    report.rows[2].spelling = "naive";
    report.rows[0].cost.tape_nanoseconds = 0.12345;
    for (CostRow& each : report.rows) each.cost.families.clear();
    CHECK(report::render(report::cost_table(report, two), {}) ==
          "term or model  spelling  format  SPIR-V  CPU ns\n"
          "D_GGX          stable    float        8   0.123\n"
          "F_Schlick      stable    half         9\n"
          "model skin     naive     float      102\n");
}

TEST_CASE("JSON says everything and reads back", "[cost]")
{
    CostReport report = sample();
    report.from_vectors = true;
    std::string why;
    const std::string text = report::to_json(report);
    CHECK(text == report::to_json(report));
    const auto read = report::read_costs(text, why);
    INFO(why);
    REQUIRE(read);
    CHECK(report::to_json(*read) == text);
    CHECK(read->from_vectors);
    CHECK(read->driver == "radv, Mesa 1");
    const auto json = nlohmann::json::parse(text);
    CHECK(json["rows"][1]["families"]["rdna2"]["issue_cycles"] == 10.5);
    CHECK_FALSE(json["rows"][1].contains("measured"));
    report.rows[0].cost.device_nanoseconds = 0.5;
    report.device = "a device";
    CHECK(nlohmann::json::parse(
              report::to_json(report))["rows"][0]["measured"]["device_nanoseconds"] == 0.5);
}

TEST_CASE("what is no file of costs is refused, whatever it is", "[cost]")
{
    std::string why;
    for (const char* const text :
         {"", "{", "[]", "null", "{}", "{\"kind\": 3}", "{\"kind\": \"another\"}", "\xff\xfe"}) {
        CHECK_FALSE(report::read_costs(text, why));
        CHECK(why == "it is not what `lobec cost --json` writes");
    }
    CHECK_FALSE(report::read_costs(R"({"kind": "lobe cost", "schema": 99})", why));
    CHECK(why == "another version of lobec wrote it; write it anew");
    // Every member is asked for, and each has its type.
    const auto whole = nlohmann::ordered_json::parse(report::to_json(sample()));
    for (const auto& [name, value] : whole["rows"][0].items()) {
        auto damaged = whole;
        damaged["rows"][0].erase(name);
        CHECK_FALSE(report::read_costs(damaged.dump(), why));
        damaged["rows"][0][name] = nullptr;
        CHECK_FALSE(report::read_costs(damaged.dump(), why));
        CHECK(why == "it is damaged");
    }
    for (const auto& [name, value] : whole["rows"][0]["families"]["gcn5"].items()) {
        auto damaged = whole;
        damaged["rows"][0]["families"]["gcn5"][name] = "much";
        CHECK_FALSE(report::read_costs(damaged.dump(), why));
    }
    auto fewer = whole;
    fewer["rows"][0]["families"].erase("rdna3");
    CHECK_FALSE(report::read_costs(fewer.dump(), why));
}

TEST_CASE("changes are told like a shader database tells them", "[cost]")
{
    const CostReport before = sample();
    CostReport now = sample();
    CHECK(report::to_text(report::compare(before, now, one), {}) ==
          "issue cycles on RDNA2 (navi21): 0 helped, 0 hurt, 3 unchanged; total 122.5 -> 122.5 "
          "(+0.00 %)\n");
    CHECK_FALSE(report::compare(before, now, one).regressed(0));

    now.rows[0] = row("D_GGX", 9);        // 9 to 12 on rdna2
    now.rows[2] = row("skin", 90, true);  // 103 to 93
    now.rows.push_back(row("fresh", 1));
    now.rows.erase(now.rows.begin() + 1);
    now.driver = "radv, Mesa 2";
    const auto comparison = report::compare(before, now, one);
    CHECK(report::to_text(comparison, {}) ==
          "the baseline is by radv, Mesa 1: differences may be the driver's\n"
          "issue cycles on RDNA2 (navi21): 1 helped, 1 hurt, 0 unchanged; total 112 -> 105 "
          "(-6.25 %); best -9.7 % at toy: model skin; worst +33.3 % at toy: D_GGX\n"
          "  hurt    toy: D_GGX: 9 -> 12 (+33.3 %)\n"
          "  helped  toy: model skin: 103 -> 93 (-9.7 %)\n"
          "new: toy: fresh\n"
          "gone: toy: F_Schlick\n");
    CHECK(comparison.regressed(0.33));
    CHECK_FALSE(comparison.regressed(0.34));

    // Of several families one is enough.
    now = sample();
    now.rows[0].cost.families[Family::gcn4].issue = 7;
    CHECK_FALSE(report::compare(before, now, one).regressed(0));
    CHECK(report::compare(before, now, two).regressed(0.1));

    // What cost nothing and costs something is worse by any share.
    CostReport nothing = sample();
    nothing.rows[0].cost.families[Family::rdna2].issue = 0;
    CHECK(report::compare(nothing, before, one).regressed(1e9));
}

TEST_CASE("without cycles on both sides SPIR-V instructions are compared", "[cost]")
{
    CostReport before = sample();
    for (CostRow& each : before.rows) each.cost.families.clear();
    CostReport now = sample();
    now.rows[0].cost.spirv_instructions = 10;
    const auto comparison = report::compare(before, now, two);
    REQUIRE(comparison.measures.size() == 1);
    CHECK(comparison.measures[0].measure == "SPIR-V instructions");
    CHECK(comparison.regressed(0.2));
    CHECK_FALSE(comparison.regressed(0.25));
}
