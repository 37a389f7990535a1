// The choice of shaders is the cheapest there is, serves every material, and what is made for a
// scene is exactly what it calls for.
#include "analyze/checked.h"
#include "analyze/residual/drop.h"
#include "analyze/residual/selection.h"
#include "analyze/residual/variants.h"
#include "analyze/scenes.h"
#include "optimize/rewrite.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

using namespace lobe;
using analyze::SceneFacts;
using analyze::Selection;
using analyze::Variants;
using tests::constant;
using tests::plain;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least cost of at most so many candidates, by trying all.
double least_cost(const Selection& selection, std::size_t most)
{
    double least = infinity;
    const std::size_t count = selection.prices.size();
    for (std::size_t set = 1; set < (std::size_t{1} << count); ++set) {
        if (static_cast<std::size_t>(__builtin_popcountll(set)) > most) continue;
        double cost = 0;
        for (std::size_t g = 0; g < selection.weights.size(); ++g) {
            double price = infinity;
            for (std::size_t c = 0; c < count; ++c)
                if ((set >> c & 1U) != 0 && selection.serves[c][g])
                    price = std::min(price, selection.prices[c]);
            cost += selection.weights[g] * price;
        }
        least = std::min(least, cost);
    }
    return least;
}

Selection random_selection(std::mt19937& random)
{
    std::uniform_real_distribution<double> unit{0, 1};
    Selection out;
    const std::size_t groups = 1 + random() % 6;
    const std::size_t candidates = 1 + random() % 10;
    for (std::size_t g = 0; g < groups; ++g) out.weights.push_back(unit(random));
    for (std::size_t c = 0; c < candidates; ++c) {
        // Few prices, so that some are equal.
        out.prices.push_back(1 + static_cast<double>(random() % 8));
        std::vector<bool>& serves = out.serves.emplace_back();
        for (std::size_t g = 0; g < groups; ++g) serves.push_back(c == 0 || random() % 2 == 0);
    }
    return out;
}

/// Materials of a few values of callisto's parameters: which effects they call for varies.
SceneFacts random_facts(std::mt19937& random, const ir::Module& module, std::size_t count)
{
    std::vector<scene::Material> materials;
    for (std::size_t i = 0; i < count; ++i) {
        scene::Material material = plain("m" + std::to_string(i));
        const auto maybe = [&](const char* name, double value) {
            if (random() % 3 == 0) material.parameters[name] = constant({value});
        };
        maybe("retroreflection", 2 + static_cast<double>(random() % 3));
        maybe("smooth_terminator", 0.5);
        maybe("dual_specular_opacity", 0.25);
        materials.push_back(std::move(material));
    }
    auto found = analyze::find_facts(tests::scene_of(std::move(materials)), module, "callisto");
    REQUIRE(found.facts);
    return *found.facts;
}

const tests::Checked& callisto()
{
    static const tests::Checked checked = tests::checked_model("../models/callisto.lobe");
    return checked;
}

Variants chosen(const SceneFacts& facts, const analyze::VariantOptions& options)
{
    return analyze::choose_variants(callisto().module, callisto().sources, facts, options, {});
}

/// Every material has one shader, and that shader has every effect that it calls for.
void check_serves(const SceneFacts& facts, const Variants& variants)
{
    std::vector<int> served(facts.materials.size());
    double coverage = 0;
    std::set<std::string> names;
    for (const analyze::Variant& variant : variants.chosen) {
        CHECK(names.insert(variant.name).second);
        coverage += variant.coverage;
        for (const std::size_t m : variant.materials) {
            ++served[m];
            for (std::size_t i = 0; i < facts.effects.size(); ++i)
                if (facts.materials[m].calls[i])
                    CHECK(std::ranges::count(variant.residual.off, facts.effects[i].name) == 0);
        }
    }
    CHECK(std::ranges::all_of(served, [](int times) { return times == 1; }));
    CHECK(coverage == Approx(1));
}

}  // namespace

TEST_CASE("the cheapest few candidates are found, whatever their number")
{
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random{seed};
        const Selection selection = random_selection(random);
        CAPTURE(seed);
        const auto frontier = analyze::cheapest(selection, 0);
        REQUIRE_FALSE(frontier.empty());
        double last = infinity;
        std::size_t counted = 0;
        for (const analyze::Selected& point : frontier) {
            CHECK(point.is_proved);
            CHECK(point.candidates.size() > counted);
            counted = point.candidates.size();
            CHECK(point.cost < last);
            last = point.cost;
            CHECK(point.cost == Approx(least_cost(selection, counted)));
            for (std::size_t g = 0; g < selection.weights.size(); ++g)
                CHECK(selection.serves[point.of_group[g]][g]);
        }
        // One more does not help.
        CHECK(last == Approx(least_cost(selection, selection.prices.size())));
        for (const std::size_t most : {std::size_t{1}, std::size_t{2}})
            CHECK(analyze::cheapest(selection, most).back().cost ==
                  Approx(least_cost(selection, most)));
    }
}

TEST_CASE("where no candidate serves something there is no choice")
{
    CHECK(analyze::cheapest({{1, 1}, {5}, {{true, false}}}, 0).empty());
}

TEST_CASE("a group of no area still gets its cheapest shader")
{
    const auto frontier =
        analyze::cheapest({{1, 0}, {5, 2, 9}, {{true, false}, {false, true}, {true, true}}}, 0);
    REQUIRE(frontier.size() == 2);
    CHECK(frontier.back().of_group == std::vector<std::size_t>{0, 1});
}

TEST_CASE("thirty effects' worth of groups are searched, not tried one by one")
{
    // Every group has a shader of its own, and unions of neighbors are a little dearer.
    Selection selection;
    for (std::size_t g = 0; g < 24; ++g)
        selection.weights.push_back(1.0 + 0.1 * static_cast<double>(g % 5));
    for (std::size_t from = 0; from < 24; ++from)
        for (std::size_t to = from; to < 24; ++to) {
            selection.prices.push_back(80 + 10.0 * static_cast<double>(to - from));
            std::vector<bool> serves(24);
            for (std::size_t g = from; g <= to; ++g) serves[g] = true;
            selection.serves.push_back(std::move(serves));
        }
    const auto frontier = analyze::cheapest(selection, 3);
    REQUIRE(frontier.size() == 3);
    for (const auto& point : frontier) CHECK(point.is_proved);
}

TEST_CASE("variants serve every material, and cost no more with more of them")
{
    for (unsigned seed = 0; seed < 3; ++seed) {
        std::mt19937 random{seed};
        const SceneFacts facts = random_facts(random, callisto().module, 8);
        const Variants all = chosen(facts, {});
        check_serves(facts, all);
        CHECK(all.is_proved);
        CHECK(all.frontier.back().variants == all.chosen.size());
        CHECK(all.frontier.back().cycles == Approx(all.cycles));
        CHECK(all.cycles <= analyze::price_of(all.general, analyze::Family::rdna2));

        analyze::VariantOptions two;
        two.most = 2;
        const Variants few = chosen(facts, two);
        check_serves(facts, few);
        CHECK(few.chosen.size() <= 2);
        CHECK(few.cycles >= all.cycles);
    }
}

TEST_CASE("the choice does not depend on the number of threads")
{
    std::mt19937 random{7};
    const SceneFacts facts = random_facts(random, callisto().module, 6);
    const auto told = [&](unsigned jobs) {
        analyze::VariantOptions options;
        options.jobs = jobs;
        std::string text;
        for (const analyze::Variant& variant : chosen(facts, options).chosen) {
            text += variant.name;
            for (const std::size_t m : variant.materials) text += " " + std::to_string(m);
            text += "\n";
        }
        return text;
    };
    CHECK(told(1) == told(4));
}

TEST_CASE("materials that call for nothing share the base, and it has no parameter left")
{
    auto found = analyze::find_facts(tests::scene_of({plain("a"), plain("b")}), callisto().module,
                                     "callisto");
    const Variants variants = chosen(*found.facts, {});
    REQUIRE(variants.chosen.size() == 1);
    CHECK(variants.chosen[0].name == "callisto_base");
    CHECK(variants.chosen[0].residual.left.empty());
    CHECK(variants.chosen[0].residual.off.size() == callisto().module.effects.size());
}

TEST_CASE("a shader for every material has its surface in it; the same are one")
{
    scene::Material a = plain("Old Skin");
    a.parameters["retroreflection"] = constant({2});
    const scene::Material b = a;
    scene::Material c = a;
    c.roughness = constant({0.75});
    auto found = analyze::find_facts(tests::scene_of({a, b, c}), callisto().module, "callisto");
    analyze::VariantOptions options;
    options.per_material = true;
    const Variants variants = chosen(*found.facts, options);
    check_serves(*found.facts, variants);
    REQUIRE(variants.chosen.size() == 2);
    CHECK(variants.chosen[0].name == "callisto_old_skin");
    CHECK(variants.chosen[1].name == "callisto_old_skin_2");
    for (const analyze::Variant& variant : variants.chosen)
        for (const ir::ModelOutput& output : variant.residual.module.models[0].outputs)
            for (const ir::Input& input : variant.residual.module[output.function].inputs)
                CHECK(input.origin == ir::Origin::geometry);
}

TEST_CASE("a variant's name is its module's, its model's and its outputs'")
{
    const auto residual = optimize::residual(callisto().module, {}, "callisto");
    const ir::Module renamed = analyze::renamed(residual.module, "callisto_skin_base");
    CHECK_FALSE(ir::verify(renamed));
    CHECK(renamed.name == "callisto_skin_base");
    CHECK(renamed.models[0].name == "callisto_skin_base");
    CHECK(renamed.find("callisto_skin_base_diffuse"));
    CHECK_FALSE(renamed.find("callisto_diffuse"));
    CHECK(renamed.roots().size() == 2);
}

TEST_CASE("what an epsilon drops is called for no more, and the certificate hears of it")
{
    scene::Material faint = plain("faint");
    faint.parameters["retroreflection"] = constant({1.0001});
    scene::Material strong = plain("strong");
    strong.parameters["retroreflection"] = constant({4});
    auto found =
        analyze::find_facts(tests::scene_of({faint, strong}), callisto().module, "callisto");
    REQUIRE(found.facts);
    // Both call for one effect and so are one group; alone the faint one goes.
    analyze::CertificateOptions options;
    SceneFacts together = *found.facts;
    CHECK(analyze::drop_effects(together, callisto().module, 0.001, options).empty());
    CHECK(together.effects[1].materials.size() == 2);

    found = analyze::find_facts(tests::scene_of({faint}), callisto().module, "callisto");
    SceneFacts alone = *found.facts;
    const auto dropped = analyze::drop_effects(alone, callisto().module, 0.001, options);
    REQUIRE(dropped.size() == 1);
    CHECK(dropped[0].effects[0].bound < 0.001);
    CHECK_FALSE(alone.effects[1].is_on);
    const Variants variants = chosen(alone, {});
    REQUIRE(variants.chosen.size() == 1);
    CHECK(variants.chosen[0].name == "callisto_base");
    CHECK(analyze::dropped_in(variants.chosen[0], dropped).size() == 1);
}
