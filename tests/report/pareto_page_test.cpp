// A trade drawn: what stands where, what carries a number, and what the pointer is told.
#include "report/pareto_page.h"

#include <catch2/catch.hpp>

#include <regex>

using namespace lobe;

namespace {

analyze::Cost cost(double issue)
{
    analyze::Cost out;
    for (const analyze::Family family : analyze::all_families)
        out.families[family] = {.valu = issue - 1,
                                .transcendental = 1,
                                .issue = issue * (family < analyze::Family::rdna1 ? 4 : 1),
                                .inverse_throughput = 2 * issue,
                                .latency = 5 * issue,
                                .vgprs = 16,
                                .waves = 16};
    out.spirv_instructions = static_cast<int>(issue);
    return out;
}

analyze::Candidate candidate(std::string form, double issue, double error, bool on_frontier)
{
    analyze::Candidate out;
    if (!form.empty()) out.choice["F_Schlick"] = std::move(form);
    out.spelling = optimize::Spelling::stable;
    out.cost = out.from_vectors = cost(issue);
    out.model.scaled = error;
    out.total.scaled = out.total.often = error;
    out.total.points = 100;
    for (const analyze::Family family : analyze::all_families)
        out.standing[family] = {.on_frontier = on_frontier, .dominated_by = {}};
    return out;
}

/// The definition, a cheaper form, and one that the form dominates.
analyze::Trade sample()
{
    analyze::Trade trade;
    trade.name = "F_Schlick";
    trade.search = "all 3 ways";
    trade.candidates = {candidate("", 8, 1e-7, true),
                        candidate("spherical_gaussian", 5, 4e-3, true),
                        candidate("worse", 9, 1e-2, false)};
    for (auto& at : trade.candidates[2].standing) at.second.dominated_by = 0;
    return trade;
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

}  // namespace

TEST_CASE("every family has a panel with every candidate")
{
    const std::string picture = report::trade_picture(sample());
    for (const analyze::Family family : analyze::all_families)
        CHECK(count(picture, std::string{analyze::title(family)} + "</text>") == 1);
    CHECK(count(picture, "<title>") == 5 * 3);
    CHECK(count(picture, "class=\"frontier\"") == 5);
    CHECK(count(picture, "written dominated") == 5);
    CHECK(count(picture, "dominated by 1: ") == 5);
}

TEST_CASE("more error stands higher and more cycles further right")
{
    const std::string picture = report::trade_picture(sample());
    std::smatch definition, form;
    const std::regex first{"class=\"definition\"><circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\""};
    const std::regex second{"class=\"written\"><circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\""};
    REQUIRE(std::regex_search(picture, definition, first));
    REQUIRE(std::regex_search(picture, form, second));
    CHECK(std::stod(definition[1]) > std::stod(form[1]));
    CHECK(std::stod(definition[2]) > std::stod(form[2]));  // downwards in a picture
}

TEST_CASE("what is no number stands at the top and says so")
{
    analyze::Trade trade = sample();
    trade.candidates.push_back(candidate("", 4, 0, false));
    trade.candidates.back().spelling = optimize::Spelling::naive;
    trade.candidates.back().total.not_finite = 40;
    const std::string picture = report::trade_picture(trade);
    CHECK(count(picture, "not a number at 40 of 100 points") == 5);
    CHECK(count(picture, "<g class=\"naive dominated\">") == 5);
}

TEST_CASE("without costs there is no picture, and the section still has its table")
{
    analyze::Trade trade = sample();
    for (analyze::Candidate& each : trade.candidates) {
        each.cost = {};
        each.from_vectors = {};
        each.standing.clear();
    }
    CHECK(report::trade_picture(trade).empty());
    analyze::Pareto pareto;
    pareto.module = "m";
    pareto.trades = {trade};
    pareto.about.no_statistics = "there is no driver";
    const auto sections = report::pareto_sections(pareto, "m.lobe");
    REQUIRE(sections.size() == 2);
    CHECK(sections[1].tables[0].rows.size() == 3);
    CHECK(sections[1].command == "lobec pareto m.lobe --term F_Schlick");
}

TEST_CASE("a file of its own is whole and equal every time")
{
    const std::string one = report::trade_svg(sample());
    CHECK(one.starts_with("<svg xmlns="));
    CHECK(one.ends_with("</svg>\n"));
    CHECK(one == report::trade_svg(sample()));
    CHECK(count(one, "http") == 1);  // the namespace; nothing is fetched
}
