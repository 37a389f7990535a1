// Two models in one tree: the second on top of the first.
#include "engine/tree.h"

#include <catch2/catch.hpp>

#include <vector>

namespace lobe::engine {
namespace {

using Catch::Contains;

Plan plan_of(const Files& files, const std::string& model)
{
    return plan_patch(tree_of(files), small_list(), request_of(model));
}

Files with(const Files& files, const std::string& model)
{
    const Plan plan = plan_of(files, model);
    REQUIRE(shown(plan.obstacles) == "");
    return applied(files, plan);
}

Plan revert_of(const Files& files, const std::string& model)
{
    Request request;
    request.model = model;
    return plan_revert(tree_of(files), small_list(), request);
}

Files both() { return with(with(small_tree(), "Gloss"), "Velvet"); }

}  // namespace

TEST_CASE("the second model gets the next id", "[engine][models]")
{
    const Plan plan = plan_of(with(small_tree(), "Gloss"), "Velvet");
    CHECK(plan.read[0] == std::pair<std::string, std::string>{"next_id", "3"});
    CHECK_THAT(both().at("Shaders/Common.ush"), Contains("#define MODEL_GLOSS 2\n"
                                                         "// BEGIN lobe Velvet 1/7 id ") &&
                                                    Contains("//^ Gloss\n"
                                                             "//+ Shaders/Velvet.ush\n"
                                                             "//- #define MODEL_NUM   3\n"
                                                             "#define MODEL_VELVET 3\n"
                                                             "#define MODEL_NUM   4\n"
                                                             "// END lobe Velvet id\n"
                                                             "// END lobe Gloss id\n"));
}

TEST_CASE("what the first one took out of the way is no anchor", "[engine][models]")
{
    // `{M_Lit}` still stands in the first one's `//-` line, between the anchor's scope and its
    // hits.
    CHECK_THAT(both().at("Source/Pass.cpp"),
               Contains("\n    if (Uses({M_Lit, M_Gloss, M_Velvet}) || Uses({M_Lit, M_Gloss, "
                        "M_Velvet}))\n"));
    CHECK_THAT(both().at("Source/Types.h"), Contains("\tM_Gloss,\n") && Contains("\tM_Velvet,\n"));
}

TEST_CASE("both can be checked while both are there", "[engine][models]")
{
    const Files files = both();
    for (const std::string& model : std::vector<std::string>{"Gloss", "Velvet"}) {
        const Plan plan = plan_of(files, model);
        CHECK(plan.changes.empty());
        CHECK(shown(plan.obstacles) == "");
        CHECK(plan.regions == 7);
    }
}

TEST_CASE("the upper one changes and goes by itself", "[engine][models]")
{
    Request request = request_of("Velvet");
    request.values.lists["pins"].pop_back();
    const Files files = both();
    const Plan plan = plan_patch(tree_of(files), small_list(), request);
    CHECK(shown(plan.obstacles) == "");
    CHECK(plan.changes.size() == 1);
    const Files changed = applied(files, plan);
    CHECK(applied(changed, revert_of(changed, "Velvet")) == with(small_tree(), "Gloss"));
    CHECK(with(with(small_tree(), "Gloss"), "Velvet") == files);
}

TEST_CASE("the lower one waits for the upper one", "[engine][models]")
{
    const std::string words = "Shaders/Common.ush:7: id: Velvet was patched in on top of Gloss\n";
    Request request = request_of("Gloss");
    request.values.lists["pins"].pop_back();
    const Files files = both();
    const Plan changed = plan_patch(tree_of(files), small_list(), request);
    CHECK(shown(changed.obstacles) == words);
    CHECK(changed.obstacles.at(0).help ==
          "revert Velvet first, patch Gloss, then patch Velvet again");
    CHECK(changed.changes.empty());
    const Plan reverted = revert_of(files, "Gloss");
    CHECK(shown(reverted.obstacles) == words);
    CHECK(reverted.changes.empty());
}

TEST_CASE("a model whose order cannot be read still is on top", "[engine][models]")
{
    Files files = both();
    auto& text = files.at("Shaders/Common.ush");
    const auto under = text.find("//^ Gloss\n");
    text.erase(under, 10);
    CHECK_THAT(shown(revert_of(files, "Gloss").obstacles),
               Contains("Velvet was patched in on top of Gloss"));
    CHECK_THAT(shown(plan_of(files, "Velvet").obstacles), Contains("was edited by hand"));
}

TEST_CASE("a third model counts both", "[engine][models]")
{
    const Files three = with(both(), "Satin");
    for (const std::string& model : std::vector<std::string>{"Gloss", "Velvet", "Satin"})
        CHECK(plan_of(three, model).changes.empty());
    CHECK_THAT(three.at("Shaders/Common.ush"), Contains("//^ Gloss\n//^ Velvet\n"));
    const Plan lowest = revert_of(three, "Gloss");
    CHECK_THAT(shown(lowest.obstacles), Contains("Satin and Velvet was patched in on top"));
    CHECK(applied(three, revert_of(three, "Satin")) == both());
}

}  // namespace lobe::engine
