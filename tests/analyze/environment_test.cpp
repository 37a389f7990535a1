// Image-based lighting against data/karis.csv and against itself.
#include "analyze/environment/split_sum.h"
#include "numeric/library.h"
#include "numeric/table.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <map>

namespace lobe::tests {
namespace {

using analyze::ScaleAndBias;
using analyze::Visibility;

Visibility visibility(const std::string& term)
{
    const ir::Module& module = definition("microfacet");
    std::string why;
    const auto result = Visibility::of(module, *module.find(term), why);
    INFO(why);
    REQUIRE(result);
    return *result;
}

struct Asked {
    double roughness = 0;
    double cos_o = 0;
    double value = 0;
    bool bias = false;
};

std::vector<Asked> rows_of(const std::string& formula)
{
    std::vector<Asked> out;
    for (const Row& row : read_table("data/karis.csv")) {
        if (row.at("formula") != formula) continue;
        Asked each;
        const std::string& inputs = row.at("inputs");
        REQUIRE(std::sscanf(inputs.c_str(), "roughness=%lf;NoV=%lf", &each.roughness,
                            &each.cos_o) == 2);
        each.value = std::stod(row.at("value"));
        each.bias = row.at("output") == "B (bias)";
        out.push_back(each);
    }
    return out;
}

}  // namespace

TEST_CASE("the exact integrals are the reference's")
{
    for (const auto& [formula, term] :
         {std::pair{"G=Schlick k=alpha/2", "V_SchlickGGX"},
          std::pair{"G=Smith GGX separable", "V_SmithGGX"},
          std::pair{"G=Smith GGX height-correlated", "V_SmithGGXCorrelated"}}) {
        const auto rows = rows_of(fmt::format("IntegrateBRDF exact - {}", formula));
        CHECK(rows.size() == 40);
        const Visibility v = visibility(term);
        double worst = 0;
        for (const Asked& row : rows) {
            const ScaleAndBias both = split_sum(v, row.roughness, row.cos_o);
            const double value = row.bias ? both.bias : both.scale;
            worst = std::max(worst, std::fabs(value - row.value));
            CAPTURE(term, row.roughness, row.cos_o, row.bias, value, row.value);
            CHECK(std::fabs(value - row.value) <= 1e-12);
        }
        WARN(term << " " << worst * 1e15);
    }
}

TEST_CASE("1024 samples are the reference's")
{
    const auto rows = rows_of("IntegrateBRDF 1024-sample Hammersley - k=alpha/2");
    CHECK(rows.size() == 40);
    const Visibility v = visibility("V_SchlickGGX");
    double worst = 0;
    for (const Asked& row : rows) {
        const ScaleAndBias both = sampled_split_sum(v, row.roughness, row.cos_o, 1024);
        const double value = row.bias ? both.bias : both.scale;
        worst = std::max(worst, std::fabs(value - row.value));
        CAPTURE(row.roughness, row.cos_o, row.bias, value, row.value);
        CHECK(std::fabs(value - row.value) <= 1e-13);
    }
    WARN(worst * 1e15);
}

}  // namespace lobe::tests
