// Hazards of small functions whose faults are known, and what is said about them.
#include "analyze/hazards/hazards.h"
#include "analyze/stability_cases.h"

#include <catch2/catch.hpp>

#include <map>

using namespace lobe;
using analyze::HazardKind;
using evaluate::Precision;

namespace {

std::vector<analyze::FunctionHazards>
hazards_of(const std::string& file, const analyze::Store& store = {}, unsigned jobs = 0)
{
    const tests::StabilityCase& which = tests::stability_case(file);
    analyze::HazardOptions options;
    options.points = 4096;
    options.costs = false;
    options.jobs = jobs;
    return analyze::hazards(which.module, which.sources, options, store);
}

std::string dump(const std::vector<analyze::FunctionHazards>& all)
{
    std::string text;
    for (const analyze::FunctionHazards& function : all) {
        text += function.function + " " + std::to_string(function.naive_not_finite) + " " +
                std::to_string(function.emitted_not_finite) + "\n";
        for (const auto* hazards : {&function.naive, &function.emitted})
            for (const analyze::Hazard& hazard : *hazards)
                text += std::string{name(hazard.kind)} + " " + hazard.operation + " `" +
                        hazard.expression + "` " + hazard.witness + " " + hazard.result + " " +
                        std::to_string(hazard.share) + " " + std::to_string(hazard.lost_bits) +
                        " " + (hazard.remedy ? hazard.remedy->name : "") + "\n";
    }
    return text;
}

}  // namespace

TEST_CASE("a hazard has the shortest witness, the place and the remedy")
{
    const auto all = hazards_of("12_exponent_zero");
    REQUIRE(all.size() == 2);
    CHECK(all[0].function == "H");
    CHECK(all[0].precision == Precision::float32);
    CHECK(all[1].precision == Precision::float16);
    REQUIRE(all[0].naive.size() == 1);
    const analyze::Hazard& hazard = all[0].naive[0];
    CHECK(hazard.kind == HazardKind::domain);
    CHECK(hazard.operation == "power");
    CHECK(hazard.expression == "x^(10 * (1 - n))");
    CHECK(hazard.witness == "x = 0, n = 1");
    CHECK(hazard.result == "H = NaN, exactly 1");
    CHECK(hazard.share > 0);
    REQUIRE(hazard.remedy);
    CHECK(hazard.remedy->name == "guarded_power");
    CHECK(hazard.remedy->text == "max(x, 2^-126)^y");
    CHECK(all[0].emitted.empty());
    CHECK(all[0].naive_not_finite > 0);
    CHECK(all[0].emitted_not_finite == 0);
}

TEST_CASE("a cancellation says how many bits it loses and which rule saves them")
{
    const auto all = hazards_of("01_ggx_one_plus");
    REQUIRE(!all[0].naive.empty());
    const analyze::Hazard& hazard = all[0].naive[0];
    CHECK(hazard.kind == HazardKind::cancellation);
    CHECK(hazard.operation == "add");
    CHECK(hazard.lost_bits > 12);
    REQUIRE(hazard.remedy);
    CHECK(hazard.remedy->name == "blend_of_squares");
}

TEST_CASE("what a hazard of vectors has no text for is said as a formula")
{
    bool found = false;
    for (const analyze::FunctionHazards& function : hazards_of("26_half_vector_of_opposites"))
        for (const analyze::Hazard& hazard : function.naive)
            found |= hazard.expression == "normalize(l + v)" &&
                     hazard.witness == "l = (1, 0, 0), v = (-1, 0, 0), n = (0, 0, 1)";
    CHECK(found);
}

TEST_CASE("hazards do not depend on threads, nor on being kept")
{
    const std::string fresh = dump(hazards_of("23_beckmann"));
    CHECK(!fresh.empty());
    CHECK(dump(hazards_of("23_beckmann", {}, 1)) == fresh);
    std::map<std::string, std::string> kept;
    std::size_t made = 0;
    // One thread: a map is no store for more.
    const analyze::Store store{[&](std::string_view key) -> std::optional<std::string> {
                                   const auto place = kept.find(std::string{key});
                                   if (place == kept.end()) return std::nullopt;
                                   return place->second;
                               },
                               [&](std::string_view key, std::string_view value) {
                                   kept[std::string{key}] = value;
                                   ++made;
                               }};
    CHECK(dump(hazards_of("23_beckmann", store, 1)) == fresh);
    CHECK(made == 2);
    CHECK(dump(hazards_of("23_beckmann", store, 1)) == fresh);
    CHECK(made == 2);
}
