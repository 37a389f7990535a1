// What functions cost, where it can be counted by hand: every expected number below is the count of
// operations that the formula needs.
#include "analyze/cost/cost.h"
#include "analyze/cost/shaders.h"
#include "analyze/cost/spirv_count.h"
#include "analyze/models.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

using namespace lobe;
using namespace lobe::analyze;
using ir::Op;
using tests::FunctionBuilder;

namespace {

/// Functions that grow by one operation at a time.
ir::Module ladder()
{
    ir::Module module;
    module.name = "ladder";
    const auto add = [&](const std::string& name, auto build) {
        FunctionBuilder f{name};
        const auto x = f.argument("x", 0, 1);
        const auto y = f.argument("y", 0, 1);
        module.functions.push_back(f.finish(build(f, x, y)));
    };
    add("sum", [](auto& f, auto x, auto y) { return f(Op::add, {x, y}); });
    add("times", [](auto& f, auto x, auto y) { return f(Op::multiply, {f(Op::add, {x, y}), x}); });
    add("fused", [](auto& f, auto x, auto y) {
        return f(Op::add, {f(Op::multiply, {f(Op::add, {x, y}), x}), y});
    });
    add("power", [](auto& f, auto x, auto y) { return f(Op::exp2, {f(Op::add, {x, y})}); });
    add("unread", [](auto& f, auto x, auto) { return f(Op::multiply, {x, x}); });
    return module;
}

/// Schlick's Fresnel term of a scalar, and its spherical Gaussian [Karis13].
ir::Module fresnel()
{
    ir::Module module;
    module.name = "fresnel";
    for (const bool gaussian : {false, true}) {
        FunctionBuilder f{gaussian ? "gaussian" : "schlick"};
        const auto f0 = f.argument("f0", 0, 1);
        const auto cosine = f.argument("cos_d", 0, 1);
        const auto one = f.literal("1");
        ir::ExprId weight;
        if (gaussian) {
            const auto inner = f(Op::subtract, {f(Op::multiply, {f.literal("-5.55473"), cosine}),
                                                f.literal("6.98316")});
            weight = f(Op::exp2, {f(Op::multiply, {inner, cosine})});
        } else {
            const auto x = f(Op::subtract, {one, cosine});
            const auto x2 = f(Op::multiply, {x, x});
            weight = f(Op::multiply, {f(Op::multiply, {x2, x2}), x});
        }
        const auto rest = f(Op::multiply, {f(Op::subtract, {one, f0}), weight});
        module.functions.push_back(f.finish(f(Op::add, {f0, rest})));
    }
    return module;
}

Costs measure(const std::vector<CostSubject>& subjects, const Store& store = {}, unsigned jobs = 0)
{
    CostOptions options;
    options.jobs = jobs;
    const Sources sources;
    Costs costs = measure_costs(subjects, sources, options, store);
    INFO(costs.no_statistics);
    REQUIRE(costs.no_statistics.empty());
    REQUIRE(costs.driver.starts_with("radv"));
    for (const Cost& cost : costs.costs) REQUIRE(cost.families.size() == all_families.size());
    return costs;
}

std::vector<CostSubject> each_function(const ir::Module& module, Format format = Format::float32)
{
    std::vector<CostSubject> subjects;
    for (std::size_t i = 0; i < module.functions.size(); ++i)
        subjects.push_back({&module, {ir::FunctionId{i}}, format, false});
    return subjects;
}

Words words_of(const std::string& body)
{
    const verify::Verdict verdict =
        verify::compile("#version 450\nlayout(local_size_x = 64) in;\n"
                        "layout(set = 0, binding = 0) buffer B { vec4 a; vec4 b; };\n"
                        "void main() { " +
                            body + " }\n",
                        verify::Dialect::glsl, verify::Stage::compute);
    REQUIRE(verdict.accepted);
    return verdict.spirv;
}

}  // namespace

TEST_CASE("an operation more costs an instruction more, and no more than it", "[cost]")
{
    const ir::Module module = ladder();
    const Costs costs = measure(each_function(module));
    for (const Family family : all_families) {
        INFO(name(family));
        const auto of = [&](std::size_t i) { return costs.costs[i].families.at(family); };
        CHECK(of(0).valu == 1);
        CHECK(of(1).valu == 2);
        CHECK(of(2).valu == 2);  // the addition joins the multiplication
        CHECK(of(3).valu == 1);
        CHECK(of(3).transcendental == 1);
        CHECK(of(4).valu == 1);  // an input that is not read costs nothing
        CHECK(of(0).transcendental == 0);
        const bool gcn = family == Family::gcn4 || family == Family::gcn5;
        CHECK(of(1).issue == (gcn ? 8 : 2));
        CHECK(of(3).issue == (gcn ? 20 : 4));
        CHECK(of(1).inverse_throughput > of(0).inverse_throughput);
        CHECK(of(1).latency > of(0).latency);
        CHECK(of(0).vgprs > 0);
        CHECK(of(0).waves > 0);
        CHECK(issue_on(costs.costs[1], family) == of(1).issue);
    }
    CHECK(costs.costs[0].spirv_instructions == 1);
    CHECK(costs.costs[2].spirv_instructions == 2);  // spirv-opt fuses, too
}

TEST_CASE("a spherical Gaussian is cheaper than Schlick on RDNA and dearer on GCN", "[cost]")
{
    const ir::Module module = fresnel();
    const Costs costs = measure(each_function(module));
    // Schlick: 1 - c, three products, 1 - f0, and one that is fused. The Gaussian: a fused one, a
    // product, 1 - f0, one fused, and exp2; on GCN one constant more does not fit its instruction.
    for (const Family family : {Family::rdna1, Family::rdna2, Family::rdna3}) {
        CHECK(issue_on(costs.costs[0], family) == 6);
        CHECK(issue_on(costs.costs[1], family) == 5);
    }
    for (const Family family : {Family::gcn4, Family::gcn5}) {
        CHECK(issue_on(costs.costs[0], family) == 4 * 6);
        CHECK(issue_on(costs.costs[1], family) == 4 * 5 + 16);
    }
}

TEST_CASE("packed half does two evaluations with one instruction where there is a packed one",
          "[cost]")
{
    const ir::Module module = ladder();
    const Costs costs = measure(each_function(module, Format::packed16));
    for (const Family family : {Family::gcn5, Family::rdna1, Family::rdna2, Family::rdna3}) {
        INFO(name(family));
        CHECK(costs.costs[0].families.at(family).valu == 0.5);
        CHECK(costs.costs[1].families.at(family).valu == 1);
        // There is no packed exp2.
        CHECK(costs.costs[3].families.at(family).transcendental == 1);
    }
}

TEST_CASE("what functions share is paid for once, and from vectors fields are paid for", "[cost]")
{
    const ir::Module steps = ladder();
    const ir::Module sample = tests::sample_module();
    const ir::FunctionId ggx{0};
    const std::vector<CostSubject> subjects{
        {&steps, {ir::FunctionId{1}, ir::FunctionId{2}}, Format::float32, false},
        {&sample, {ggx}, Format::float32, false},
        {&sample, {ggx}, Format::float32, true},
        {&sample, {ggx}, Format::float16, false}};
    const Costs costs = measure(subjects);
    for (const Family family : all_families) {
        INFO(name(family));
        // One sum, its product, and the fused one: 3 of 2 + 2.
        CHECK(costs.costs[0].families.at(family).valu == 3);
        CHECK(issue_on(costs.costs[1], family) < issue_on(costs.costs[2], family));
        CHECK(issue_on(costs.costs[3], family) > 0);
    }
}

TEST_CASE("costs do not depend on the number of threads, and are kept", "[cost]")
{
    const ir::Module module = ladder();
    std::map<std::string, std::string, std::less<>> kept;
    std::mutex mutex;
    std::size_t found = 0;
    Store store;
    store.load = [&](std::string_view key) -> std::optional<std::string> {
        const std::lock_guard lock{mutex};
        const auto entry = kept.find(key);
        if (entry == kept.end()) return std::nullopt;
        ++found;
        return entry->second;
    };
    store.save = [&](std::string_view key, std::string_view value) {
        const std::lock_guard lock{mutex};
        kept.emplace(key, value);
    };
    const Costs first = measure(each_function(module), store, 1);
    const std::size_t entries = kept.size();
    CHECK(found == 0);
    const Costs second = measure(each_function(module), store, 3);
    CHECK(found == entries);
    CHECK(kept.size() == entries);
    const Costs third = measure(each_function(module), {}, 0);
    for (std::size_t i = 0; i < first.costs.size(); ++i)
        for (const Family family : all_families)
            for (const Costs* other : {&second, &third}) {
                const FamilyCost& a = first.costs[i].families.at(family);
                const FamilyCost& b = other->costs[i].families.at(family);
                CHECK(a.valu == b.valu);
                CHECK(a.transcendental == b.transcendental);
                CHECK(a.inverse_throughput == b.inverse_throughput);
                CHECK(a.latency == b.latency);
                CHECK(a.vgprs == b.vgprs);
            }

    // What does not read as statistics is as if it were not there.
    for (auto& [key, value] : kept) value = "rubbish";
    CHECK(measure(each_function(module), store).costs[1].families.at(Family::rdna2).valu == 2);
}

TEST_CASE("only the families that are asked for are measured", "[cost]")
{
    const ir::Module module = ladder();
    const auto subjects = each_function(module);
    std::size_t asked = 0;
    std::mutex mutex;
    Store store;
    store.save = [&](std::string_view key, std::string_view) {
        const std::lock_guard lock{mutex};
        if (key.starts_with("statistics")) ++asked;
    };
    CostOptions options;
    options.families = {Family::rdna3};
    const Costs some = measure_costs(subjects, {}, options, store);
    REQUIRE(some.no_statistics.empty());
    const std::size_t of_one = std::exchange(asked, 0);
    const Costs all = measure(subjects, store);
    CHECK(of_one > 0);
    CHECK(asked == all_families.size() * of_one);
    CHECK(some.driver == all.driver);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        REQUIRE(some.costs[i].families.size() == 1);
        CHECK(issue_on(some.costs[i], Family::rdna3) == issue_on(all.costs[i], Family::rdna3));
        CHECK(issue_on(some.costs[i], Family::gcn4) == 0);
    }
}

TEST_CASE("without a driver there are SPIR-V counts and a reason", "[cost]")
{
    setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
    setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
    const ir::Module module = ladder();
    const std::vector<CostSubject> subjects = each_function(module);
    const Costs costs = measure_costs(subjects, {}, {}, {});
    unsetenv("VK_DRIVER_FILES");
    unsetenv("VK_ICD_FILENAMES");
    CHECK(costs.no_statistics.find("mesa-vulkan-drivers") != std::string::npos);
    REQUIRE(costs.costs.size() == subjects.size());
    CHECK(costs.costs[1].families.empty());
    CHECK(costs.costs[1].spirv_instructions == 2);
    CHECK(issue_on(costs.costs[1], Family::rdna2) == 0);
}

TEST_CASE("families and formats have names that find them")
{
    for (const Family family : all_families) CHECK(find_family(name(family)) == family);
    CHECK_FALSE(find_family("rdna9"));
    CHECK(title(Family::rdna2) == "RDNA2 (navi21)");
    CHECK(name(Format::packed16) == "packed half");
}

TEST_CASE("SPIR-V arithmetic is counted per component")
{
    CHECK(count_arithmetic(words_of("a = b;")) == 0);
    CHECK(count_arithmetic(words_of("a.x = a.y * b.z;")) == 1);
    CHECK(count_arithmetic(words_of("a = a * b;")) == 4);
    CHECK(count_arithmetic(words_of("a.x = dot(a.xyz, b.xyz);")) == 5);
    CHECK(count_arithmetic(words_of("a.x = length(b.xyz);")) == 6);
    CHECK(count_arithmetic(words_of("a.xyz = normalize(b.xyz);")) == 9);
    CHECK(count_arithmetic(words_of("a.xy = clamp(b.xy, 0.0, 1.0);")) == 2);
    CHECK(count_arithmetic(words_of("a.x = mix(a.x, a.y, b.x < b.y);")) == 2);
    CHECK(count_arithmetic(words_of("uint i = floatBitsToUint(a.x) ^ 1u; "
                                    "a.x = uintBitsToFloat(i + 2u);")) == 0);
}
