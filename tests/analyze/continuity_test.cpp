// What jumps: limits of functions that are known by hand, and those that the models really have.
#include "analyze/corners/continuity.h"
#include "analyze/emitted.h"
#include "analyze/entry_inputs.h"
#include "analyze/models.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

using namespace lobe;
using namespace lobe::tests;
using analyze::Continuity;
using ir::Op;

namespace {

constexpr double pi = std::numbers::pi;

/// The limits of a function of one argument x in [-1, 1], across x = 0.
template <class Build>
analyze::Limits limits_of(const Build& build)
{
    FunctionBuilder f{"f"};
    const auto x = f.argument("x", -1, 1);
    ir::Module module;
    module.name = "sample";
    module.functions = {f.finish(build(f, x))};
    return analyze::limits(evaluate::compile(module, module.functions.front()), {{0}, {1}});
}

/// alpha_s for v = n and l on the horizon: both half angles are 45 degrees.
double mask_at_the_horizon()
{
    const double side = 1 - std::pow(1 - std::sqrt(0.5), 3);
    return side * side;
}

const std::vector<Continuity>& rows_of(const std::string& model)
{
    static std::map<std::string, std::vector<Continuity>> known;
    const auto place = known.find(model);
    if (place != known.end()) return place->second;
    return known.emplace(model, analyze::continuity(emitted_model(model).module, {}, {}))
        .first->second;
}

const Continuity& row(const std::string& model, const std::string& function,
                      const std::string& across)
{
    const std::vector<Continuity>& rows = rows_of(model);
    const auto found = std::ranges::find_if(rows, [&](const Continuity& one) {
        return one.function == function && one.across == across;
    });
    INFO(function << " across " << across);
    REQUIRE(found != rows.end());
    return *found;
}

}  // namespace

TEST_CASE("a step has the height of its step", "[continuity]")
{
    const analyze::Limits limits = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        // 0.25 + x above 0, and x^2 from 0 on down.
        return f(Op::select, {f(Op::less, {f.literal("0"), x}), f(Op::add, {f.literal("0.25"), x}),
                              f(Op::multiply, {x, x})});
    });
    // Three values J + C 2^-12 r and their extrapolation: exact but for the roundings of a double.
    CHECK(std::abs(limits.jump - 0.25) <= 0x1p-50);
    CHECK(limits.distance == 0);
}

TEST_CASE("a root is continuous however steep it is", "[continuity]")
{
    const std::string exponent = GENERATE("0.5", "0.25", "0.1");
    CAPTURE(exponent);
    const analyze::Limits limits = limits_of([&](FunctionBuilder& f, ir::ExprId x) {
        return f(Op::guarded_power, {f(Op::maximum, {x, f.literal("0")}), f.literal(exponent)});
    });
    CHECK(limits.jump == 0);
    CHECK(limits.scale >= 0.5);  // of a quarter, where the way begins
}

TEST_CASE("a value of its own on the boundary is a jump", "[continuity]")
{
    const analyze::Limits limits = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        return f(Op::select, {f(Op::equal, {x, f.literal("0")}), f.literal("3"), f.literal("1")});
    });
    CHECK(limits.jump == 2);
    CHECK(limits.distance == 0);
}

TEST_CASE("a guard that switches on the way is found where it does", "[continuity]")
{
    const analyze::Limits limits = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        // 1 + x, but 1.5 where 0 < x < 2^-40.
        const auto inside =
            f(Op::logical_and, {f(Op::less, {f.literal("0"), x}),
                                f(Op::less, {x, f.function.graph.literal(0x1p-40)})});
        return f(Op::select, {inside, f.literal("1.5"), f(Op::add, {f.literal("1"), x})});
    });
    CHECK(std::abs(limits.jump - 0.5) <= 0x1p-39);
    // On the boundary it jumps by 0.5 as well; the guard's far side by 2^-40 less.
    CHECK((limits.distance == 0 || std::abs(limits.distance - 0x1p-40) <= 0x1p-90));

    const analyze::Limits away = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        // x^2 / x^2 below 2^-40, else 1.25.
        const auto near = f(Op::less, {f(Op::absolute, {x}), f.function.graph.literal(0x1p-40)});
        return f(Op::select, {near, f.literal("1"), f.literal("1.25")});
    });
    CHECK(away.jump == 0.25);
    CHECK(std::abs(std::abs(away.distance) - 0x1p-40) <= 0x1p-90);
}

TEST_CASE("a ramp of a guard is the jump that it stands for", "[continuity]")
{
    const analyze::Limits limits = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        const auto size = f(Op::maximum, {f(Op::absolute, {x}), f.function.graph.literal(0x1p-64)});
        return f(Op::divide, {x, size});
    });
    CHECK(limits.jump == 2);  // from -1 to 1
    CHECK(limits.distance == 0);
    CHECK(limits.within > 0);
    CHECK(limits.within <= 0x1p-50);
}

TEST_CASE("what grows without bound is no continuous function", "[continuity]")
{
    const analyze::Limits limits = limits_of([](FunctionBuilder& f, ir::ExprId x) {
        return f(Op::select, {f(Op::less, {f.literal("0"), x}), f(Op::divide, {f.literal("1"), x}),
                              f.literal("0")});
    });
    CHECK(limits.jump > 0x1p64);
}

TEST_CASE("Proxima's gate jumps by 19 % of Lambert's peak", "[continuity][shipped]")
{
    // rho alpha 0.19 q / pi at alpha = q = rho = 1; its three values differ by multiples of the
    // distance, so that the extrapolation is exact but for roundings of a double.
    const double jump = 0.19 / pi;
    for (const char* function : {"proxima_cos", "callisto_diffuse"}) {
        const Continuity& across = row("callisto", function, "n.l = 0");
        CHECK(!across.continuous);
        CHECK(std::abs(across.jump - jump) <= jump * 0x1p-48);
        CHECK(std::abs(across.jump - 0.0604789) <= 0.5e-7);
    }
    // And where view and light are at right angles it has a cusp, but does not jump.
    CHECK(row("callisto", "proxima_cos", "v.l = 0").continuous);
    // Lambert is 0 at the terminator.
    CHECK(row("callisto", "lambert_cos", "n.l = 0").continuous);
    CHECK(row("callisto", "callisto_specular", "n.l = 0").continuous);
}

TEST_CASE("the smooth terminator cuts Proxima's jump to 5 %", "[continuity][shipped]")
{
    const ir::Module& module = emitted_model("callisto").module;
    const analyze::EntryInputs inputs{module, *module.find("callisto_diffuse"),
                                      analyze::grid_of(evaluate::Precision::float32)};
    analyze::Crossing crossing;
    crossing.at = inputs.neutral();
    inputs.place(crossing.at, {{}, {1, 0, 0}, {0, 0, 1}});
    crossing.direction.assign(inputs.columns(), 0);
    crossing.direction[*inputs.find(ir::GeometryField::l) + 2] = 1;
    const evaluate::Tape tape = evaluate::compile(module, inputs.entry());
    const analyze::Limits without = analyze::limits(tape, crossing);
    analyze::EntryInputs::set(crossing.at, *inputs.find("smooth_terminator"), 1);
    const analyze::Limits with = analyze::limits(tape, crossing);
    const double left = 1 - mask_at_the_horizon();
    CHECK(std::abs(left - 0.049621) <= 0.5e-6);
    CHECK(std::abs(without.jump - 0.19 / pi) <= 0x1p-48);
    CHECK(std::abs(with.jump - without.jump * left) <= 0x1p-48);
}

TEST_CASE("0^0 jumps where it is 1 and 0^e is 0, and nowhere else", "[continuity]")
{
    FunctionBuilder f{"f"};
    const auto x = f.argument("x", 0, 1);
    const auto e = f.argument("e", 0, 1);
    const auto zero = f.literal("0"), one = f.literal("1");
    const auto positive = f(Op::select, {f(Op::less_equal, {x, zero}), zero, f(Op::power, {x, e})});
    ir::Module module;
    module.name = "sample";
    module.functions = {f.finish(f(Op::select, {f(Op::equal, {e, zero}), one, positive}))};
    const evaluate::Tape tape = evaluate::compile(module, module.functions.front());
    CHECK(analyze::limits(tape, {{0, 0}, {0, 1}, false}).jump == 1);
    CHECK(analyze::limits(tape, {{0.25, 0}, {0, 1}, false}).jump == 0);
    CHECK(analyze::limits(tape, {{0, 0.5}, {1, 0}, false}).jump == 0);
}

TEST_CASE("falloffs of 1 are steep for Callisto, but do not jump", "[continuity][shipped]")
{
    // In the language 0 counts as 2^-126 under a power whose exponent may be 0, so that the weight
    // falls from 1 to nothing within exponents of a few hundredths, and is torn nowhere.
    for (const char* across : {"n = 0", "m = 0", "cos_phi = 0"})
        CHECK(row("callisto", "blend_weight", across).continuous);
    for (const char* across : {"specular_fresnel_falloff = 0", "specular_fresnel_falloff = 1"})
        CHECK(row("callisto", "F_Callisto", across).continuous);
}

TEST_CASE("a terminator of no length is a step", "[continuity][shipped]")
{
    // 1 - alpha_s(90 degrees) o on the boundary, 1 in the light; a smoothstep whose edges are
    // equal.
    const Continuity& step = row("callisto", "c2", "n.l = 0, any parameters");
    CHECK(!step.continuous);
    CHECK(std::abs(step.jump - mask_at_the_horizon()) <= 0x1p-48);
    // And with its default length it is none.
    const auto& rows = rows_of("callisto");
    CHECK(std::ranges::none_of(rows, [](const Continuity& one) {
        return one.function == "c2" && one.across == "n.l = 0" && !one.continuous;
    }));
}

TEST_CASE("Callisto's effects come in and go out without a jump", "[continuity][shipped]")
{
    std::set<std::string> effects;
    for (const Continuity& one : rows_of("callisto")) {
        if (!one.across.starts_with("effect ")) continue;
        CAPTURE(one.function, one.across, one.at);
        CHECK(one.continuous);
        effects.insert(one.across.substr(0, one.across.find("\" on/off")));
    }
    CHECK(effects.size() == emitted_model("callisto").module.effects.size());
}

TEST_CASE("rows do not depend on the number of threads", "[continuity]")
{
    const ir::Module module = sample_module();
    const auto one = analyze::continuity(module, {1, {}}, {});
    const auto four = analyze::continuity(module, {4, {}}, {});
    REQUIRE(one.size() == four.size());
    REQUIRE(!one.empty());
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].function == four[i].function);
        CHECK(one[i].across == four[i].across);
        CHECK(one[i].jump == four[i].jump);
        CHECK(one[i].at == four[i].at);
    }
}
