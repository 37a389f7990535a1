// What each spelling leaves out, and that all of them are one function.
#include "directions.h"
#include "models.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/spelling.h"

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using evaluate::Real;
using optimize::Spelling;

namespace {

/// The operations that a function and its entry point apply.
std::vector<Op> operations(const Module& module, std::string_view name)
{
    std::vector<Op> found;
    const auto add = [&](const Function& function) {
        const auto uses = use_counts(function.graph, function.result);
        for (const ExprId id : function.graph.ids())
            if (uses[id] > 0) found.push_back(function.graph[id].op);
    };
    add(module[*module.find(name)]);
    add(entry_point(module, *module.find(name)));
    return found;
}

bool applies(const Module& module, std::string_view name, Op op)
{
    const auto found = operations(module, name);
    return std::find(found.begin(), found.end(), op) != found.end();
}

bool reads(const Module& module, std::string_view name, std::string_view input)
{
    for (const Input& known : module[*module.find(name)].inputs)
        if (known.name == input) return true;
    return false;
}

const Module& microfacet()
{
    static const Module module = read_model("../models/microfacet.lobe");
    return module;
}

}  // namespace

TEST_CASE("spellings have names")
{
    std::vector<std::string_view> names;
    for (const Spelling spelling : optimize::spellings()) names.push_back(optimize::name(spelling));
    CHECK(names == std::vector<std::string_view>{"naive", "as written", "factored", "stable"});
}

TEST_CASE("the naive spelling has no guard and no rewrite")
{
    const Module naive = optimize::spell(microfacet(), Spelling::naive);
    REQUIRE_FALSE(verify(naive));
    for (const FunctionId id : naive.roots()) {
        CAPTURE(naive[id].name);
        for (const Op guarded : {Op::guarded_power, Op::guarded_smoothstep, Op::guarded_normalize})
            CHECK_FALSE(applies(naive, naive[id].name, guarded));
    }
    // `n.l n.v / max(n.l, n.v) else 0`
    CHECK_FALSE(applies(naive, "G_Neumann", Op::select));
    CHECK(applies(naive, "G_Neumann", Op::divide));
    CHECK(applies(naive, "D_GGX", Op::normalize));
    CHECK(reads(naive, "D_GGX", "cos_h"));
    CHECK_FALSE(reads(naive, "D_GGX", "sin2_h"));

    const Module powers = read_text("module test\n"
                                    "/// x\nterm fifth(x: unit) -> float = (1 - x)^5\n"
                                    "/// x\nterm second(x: unit) -> float = (1 - x)^2\n");
    const Module typed = optimize::spell(powers, Spelling::naive);
    CHECK(applies(typed, "fifth", Op::power));
    CHECK_FALSE(applies(typed, "second", Op::power));
    CHECK(applies(typed, "second", Op::multiply));
}

TEST_CASE("spellings differ by what they rewrite")
{
    const Module as_written = optimize::spell(microfacet(), Spelling::as_written);
    const Module factored = optimize::spell(microfacet(), Spelling::factored);
    const Module stable = optimize::spell(microfacet(), Spelling::stable);
    CHECK(optimize::same_graphs(stable, optimize::optimize(microfacet())));
    CHECK(reads(stable, "D_GGX", "sin2_h"));
    for (const Module* module : {&as_written, &factored}) {
        CHECK_FALSE(verify(*module));
        CHECK_FALSE(optimize::illegal(*module));
        CHECK(applies(*module, "D_GGX", Op::guarded_normalize));
        for (std::size_t i = 0; i < module->functions.size(); ++i)
            CHECK(module->functions[i].inputs.size() == microfacet().functions[i].inputs.size());
    }
    const auto& written = as_written[*as_written.find("D_GGX")];
    CHECK_FALSE(optimize::same_function(written, factored[*factored.find("D_GGX")]));
    const auto& cosine = as_written[*as_written.find("G_Implicit")];
    CHECK(optimize::same_function(cosine, factored[*factored.find("G_Implicit")]));
}

TEST_CASE("every spelling is the same function over the real numbers")
{
    std::mt19937 random{5};
    Points<Real> points = directions(random, 40, 0.5, 0.3);
    const std::size_t count = points["l.x"].size();
    for (const char* name : {"alpha", "roughness"})
        points[name] = std::vector<Real>(count, Real{0.375, real_bits});
    for (const char* term : {"D_GGX", "D_Beckmann", "G_Kelemen", "G_SmithBeckmann"}) {
        CAPTURE(term);
        const FunctionId id = *microfacet().find(term);
        const auto expected = values(microfacet(), entry_point(microfacet(), id), points);
        for (const Spelling spelling : optimize::spellings()) {
            CAPTURE(optimize::name(spelling));
            const Module module = optimize::spell(microfacet(), spelling);
            const auto actual = values(module, entry_point(module, id), points);
            REQUIRE(expected.size() == actual.size());
            // 1 - cos loses at most 30 bits of the 200 at these angles.
            for (std::size_t i = 0; i < expected.size(); ++i)
                CHECK(difference(expected[i], actual[i]) < 0x1p-140);
        }
    }
}
