// Every rule by name: it fires where its pattern stands, keeps the value over the real numbers,
// and makes the float evaluation better by what its reason claims.
#include "directions.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/stabilize.h"
#include "random_term.h"

#include <functional>
#include <set>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using evaluate::Real;
using optimize::stabilize;

namespace {

/// What a test term is made of: the cosines, a parameter a in [0.001, 1], a scalar x.
struct Site {
    Term t{"term"};
    ExprId cos_h = t.field(GeometryField::cos_h);
    ExprId cos_d = t.field(GeometryField::cos_d);
    ExprId v_dot_l = t.field(GeometryField::v_dot_l);
    ExprId a = t.argument("a", 0.001, 1);
    ExprId x = t.argument("x", 0, 1);
    ExprId one = t.number("1");
    ExprId square(ExprId id) { return t.power(id, "2"); }
};
using Body = std::function<ExprId(Site&)>;

/// A body, and the rule that must take its cancellation away.
struct Example {
    std::string name;
    std::string rule;
    Body body;
};

/// `1 - x` or the like in a callee that is handed cos_d.
Module through_call(const Body& body)
{
    Module module = empty_module();
    Term callee{"callee"};
    Site site;
    site.t = callee;
    site.x = site.t.argument("x", 0, 1);
    site.a = site.t.argument("a", 0.001, 1);
    site.one = site.t.number("1");
    const FunctionId id = site.t.in(module, body(site));
    Term root{"root"};
    const ExprId cos_d = root.field(GeometryField::cos_d);
    const ExprId a = root.argument("a", 0.001, 1);
    const FunctionId root_id = root.in(module, root.call(module, id, {cos_d, a}));
    set_roots(module, {root_id});
    return module;
}

Module directly(const Body& body)
{
    Site site;
    const ExprId result = body(site);
    return only(site.t, result);
}

/// cos^2 (a - 1) + 1
ExprId blend(Site& s, ExprId x, int degree)
{
    const ExprId power = degree == 1 ? x : s.square(x);
    return s.t.add(s.t.multiply(power, s.t.subtract(s.a, s.one)), s.one);
}

const std::vector<Example> examples{
    {"1 - cos_h", "one_minus_cos_h", [](Site& s) { return s.t.subtract(s.one, s.cos_h); }},
    {"a - a cos_h", "one_minus_cos_h",
     [](Site& s) { return s.t.subtract(s.a, s.t.multiply(s.a, s.cos_h)); }},
    {"1 - cos_h^2", "sine_squared_h",
     [](Site& s) { return s.t.subtract(s.one, s.square(s.cos_h)); }},
    {"cos_h^2 - 1", "sine_squared_h",
     [](Site& s) { return s.t.subtract(s.square(s.cos_h), s.one); }},
    {"(1 - cos_h)(1 + cos_h)", "sine_squared_h",
     [](Site& s) { return s.t.multiply(s.t.subtract(s.one, s.cos_h), s.t.add(s.one, s.cos_h)); }},
    {"cos_h^2 (a - 1) + 1", "blend_h", [](Site& s) { return blend(s, s.cos_h, 2); }},
    {"1 - cos_h^2 + a cos_h^2", "blend_h",
     [](Site& s) {
         const ExprId square = s.square(s.cos_h);
         return s.t.add(s.t.subtract(s.one, square), s.t.multiply(s.a, square));
     }},
    {"1 - cos_h^2 + (a cos_h)^2", "blend_h",
     [](Site& s) {
         return s.t.add(s.t.subtract(s.one, s.square(s.cos_h)),
                        s.square(s.t.multiply(s.cos_h, s.a)));
     }},
    {"(cos_h a - cos_h) cos_h + 1", "blend_h",
     [](Site& s) {
         const ExprId inner = s.t.subtract(s.t.multiply(s.cos_h, s.a), s.cos_h);
         return s.t.add(s.t.multiply(inner, s.cos_h), s.one);
     }},
    {"lerp(1, a, cos_h^2)", "blend_h",
     [](Site& s) {
         return s.t.op(Op::lerp, {s.one, s.a, s.square(s.cos_h)});
     }},
    {"cos_h (a - 1) + 1", "blend_h", [](Site& s) { return blend(s, s.cos_h, 1); }},
    {"1 - cos_d", "one_minus_cos_d", [](Site& s) { return s.t.subtract(s.one, s.cos_d); }},
    {"1 - cos_d^2", "sine_squared_d",
     [](Site& s) { return s.t.subtract(s.one, s.square(s.cos_d)); }},
    {"cos_d^2 (a - 1) + 1", "blend_d", [](Site& s) { return blend(s, s.cos_d, 2); }},
    {"cos_d (a - 1) + 1", "blend_d", [](Site& s) { return blend(s, s.cos_d, 1); }},
    {"1 - v_dot_l", "one_minus_v_dot_l", [](Site& s) { return s.t.subtract(s.one, s.v_dot_l); }},
    {"2 + 2 v_dot_l", "one_plus_v_dot_l",
     [](Site& s) {
         const ExprId two = s.t.number("2");
         return s.t.add(two, s.t.multiply(two, s.v_dot_l));
     }},
    {"1 - x^2", "difference_of_squares",
     [](Site& s) { return s.t.subtract(s.one, s.square(s.x)); }},
    {"x^2 (a - 1) + 1", "blend_of_squares", [](Site& s) { return blend(s, s.x, 2); }},
    {"1 - (1 - x)^2", "power_of_complement",
     [](Site& s) { return s.t.subtract(s.one, s.square(s.t.subtract(s.one, s.x))); }},
    {"1 - (1 - x)^3", "power_of_complement",
     [](Site& s) { return s.t.subtract(s.one, s.t.power(s.t.subtract(s.one, s.x), "3")); }},
};

const std::vector<Example> call_examples{
    {"1 - x", "one_minus_argument", [](Site& s) { return s.t.subtract(s.one, s.x); }},
    {"(1 - x)^5", "one_minus_argument",
     [](Site& s) { return s.t.power(s.t.subtract(s.one, s.x), "5"); }},
    {"1 - x^2", "sine_squared_argument",
     [](Site& s) { return s.t.subtract(s.one, s.square(s.x)); }},
    {"x^2 (a - 1) + 1", "blend_argument", [](Site& s) { return blend(s, s.x, 2); }},
};

/// Unit vectors from grazing to coinciding, and the scalar arguments.
Points<Real> points_everywhere()
{
    std::mt19937 random{7};
    Points<Real> points;
    for (const double spread : {0.5, 0.1, 1e-3, 1e-6})
        for (auto& [name, column] : directions(random, 50, 0.4, spread))
            points[name].insert(points[name].end(), column.begin(), column.end());
    std::uniform_real_distribution<double> pick{0.001, 1};
    for (std::size_t i = 0; i < 200; ++i) {
        points["a"].emplace_back(pick(random), real_bits);
        points["x"].emplace_back(pick(random), real_bits);
    }
    return points;
}

FunctionId last(const Module& module) { return FunctionId{module.functions.size() - 1}; }

void check_example(const Example& example, const Module& before)
{
    CAPTURE(example.name);
    std::vector<optimize::Application> log;
    const Module after = stabilize(before, log);
    CHECK_FALSE(verify(after));
    REQUIRE(log.size() == 1);
    CHECK(log[0].rule->name == example.rule);

    const auto points = points_everywhere();
    const auto expected = values(before, entry_point(before, last(before)), points);
    const auto actual = values(after, entry_point(after, last(after)), points);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        // A difference of 1 - cos ~ 1e-12 has lost 40 bits of 200 already.
        CHECK(difference(expected[i], actual[i]) < 0x1p-140);
    }
    CHECK(optimize::same_graphs(stabilize(after), after));
}

}  // namespace

TEST_CASE("every rule fires on its patterns and keeps the value over the real numbers")
{
    for (const Example& example : examples) check_example(example, directly(example.body));
    for (const Example& example : call_examples) check_example(example, through_call(example.body));
}

TEST_CASE("every rule has an example")
{
    std::set<std::string_view> shown;
    for (const auto* list : {&examples, &call_examples})
        for (const Example& example : *list) shown.insert(example.rule);
    for (const optimize::Rule& rule : optimize::rules()) {
        CAPTURE(rule.name);
        CHECK(shown.contains(rule.name));
    }
    CHECK(shown.size() == optimize::rules().size());
}

TEST_CASE("a sum without a cancellation stays as it was written")
{
    const auto untouched = [](const Body& body) {
        const Module module = directly(body);
        std::vector<optimize::Application> log;
        // What nothing reads is dropped by any pass, so compare with what simplify leaves.
        return optimize::same_graphs(stabilize(module, log), optimize::simplify(module)) &&
               log.empty();
    };
    // Smith's root: a^2 + (1 - a^2) cos^2 only adds, and so does what 1 - a^2 enters.
    CHECK(untouched([](Site& s) {
        const ExprId a2 = s.square(s.a);
        return s.t.add(a2, s.t.multiply(s.t.subtract(s.one, a2), s.square(s.cos_h)));
    }));
    CHECK(untouched([](Site& s) { return s.t.add(s.one, s.cos_h); }));
    CHECK(untouched([](Site& s) { return s.t.subtract(s.t.number("3"), s.square(s.x)); }));
    // 1 - x from a scalar alone is exact where it cancels.
    CHECK(untouched([](Site& s) { return s.t.subtract(s.one, s.x); }));
    // 1 - a x keeps a constant apart from the cosine.
    CHECK(untouched([](Site& s) { return s.t.subtract(s.one, s.t.multiply(s.a, s.cos_h)); }));
}

TEST_CASE("a cancellation that a sum absorbs stays, and one that shows does not")
{
    const auto asks_for_field = [](const Body& body) {
        std::vector<optimize::Application> log;
        const Module module = stabilize(directly(body), log);
        const auto field = static_cast<std::uint32_t>(GeometryField::one_minus_cos_h);
        CHECK(module.functions[0].find_input(Origin::geometry, field).has_value() == !log.empty());
        return !log.empty();
    };
    const auto one_minus = [](Site& s) { return s.t.subtract(s.one, s.cos_h); };
    CHECK(asks_for_field(one_minus));
    // 2^-25 of a sum of at least 1 is half a unit; of 1/64 it is 32.
    const auto plus = [&](const char* number) {
        return [&, number](Site& s) { return s.t.add(s.t.number(number), one_minus(s)); };
    };
    CHECK_FALSE(asks_for_field(plus("1")));
    CHECK(asks_for_field(plus("0.015625")));
    // In both uses, or it shows in one.
    CHECK_FALSE(asks_for_field([&](Site& s) {
        const ExprId x = one_minus(s);
        return s.t.add(s.one, s.t.multiply(x, s.t.add(s.one, x)));
    }));
    CHECK(asks_for_field([&](Site& s) {
        const ExprId x = one_minus(s);
        return s.t.multiply(x, s.t.add(s.one, x));
    }));
    // A product may make it large again.
    CHECK(asks_for_field(
        [&](Site& s) { return s.t.add(s.one, s.t.multiply(s.t.number("64"), one_minus(s))); }));
}

TEST_CASE("a field that is computed anyway is read where nothing cancels, too")
{
    const auto reads_field = [](const Module& module, FunctionId id) {
        const auto field = static_cast<std::uint32_t>(GeometryField::one_minus_cos_h);
        return module[id].find_input(Origin::geometry, field).has_value();
    };
    // 2 - cos_h in a function that two roots call.
    const auto made = [&](bool both_have_a_sine, const auto& models) {
        Module module = empty_module();
        Site site;
        const ExprId absorbed = site.t.add(site.one, site.t.subtract(site.one, site.cos_h));
        const FunctionId callee = site.t.in(module, absorbed);
        std::vector<FunctionId> roots;
        for (const bool has_sine : {true, both_have_a_sine}) {
            Term root{roots.empty() ? "first" : "second"};
            std::vector<ExprId> passed;
            for (const GeometryField field :
                 {GeometryField::cos_h, GeometryField::cos_d, GeometryField::v_dot_l})
                passed.push_back(root.field(field));
            passed.push_back(root.argument("a", 0.001, 1));
            passed.push_back(root.argument("x", 0, 1));
            ExprId value = root.call(module, callee, passed);
            if (has_sine)
                value = root.multiply(value,
                                      root.subtract(root.number("1"), root.power(passed[0], "2")));
            roots.push_back(root.in(module, value));
        }
        for (const auto& outputs : models(roots)) set_roots(module, outputs);
        return reads_field(stabilize(module), callee);
    };
    const auto apart = [](const std::vector<FunctionId>& roots) {
        return std::vector<std::vector<FunctionId>>{{roots[0]}, {roots[1]}};
    };
    const auto together = [](const std::vector<FunctionId>& roots) {
        return std::vector<std::vector<FunctionId>>{roots};
    };
    CHECK(made(true, apart));
    // One of its callers would have to compute it for this alone; not if both are one model's.
    CHECK_FALSE(made(false, apart));
    CHECK(made(false, together));
}

TEST_CASE("squares far from 1 are subtracted as they are")
{
    Term t{"term"};
    const ExprId x = t.argument("x", 0, 0.5);
    const Module module = only(t, t.subtract(t.number("1"), t.power(x, "2")));
    CHECK(optimize::same_graphs(stabilize(module), module));
}

TEST_CASE("the GGX denominator is provably at least alpha squared")
{
    const Module before = directly([](Site& s) {
        const ExprId a2 = s.square(s.a);
        return s.t.add(s.t.multiply(s.square(s.cos_h), s.t.subtract(a2, s.one)), s.one);
    });
    const auto low = [](const Module& module) {
        const Function& function = module.functions[0];
        return evaluate::ranges(module, function,
                                evaluate::declared_ranges(function))[function.result]
            .low;
    };
    CHECK(low(before) < 0.97e-6);  // and that only by the rounding of the bounds
    // The square, the two differences and the sum each round the bound by a float's unit at most.
    CHECK(low(optimize::optimize(before)) == Approx(1e-6).epsilon(4 * 0x1p-23));
}

TEST_CASE("GGX at its peak: the float error from vectors drops from above 1e-2 to below 1e-6")
{
    Term t{"D_GGX"};
    const ExprId alpha = t.argument("alpha", 0.0009765625, 1);
    const ExprId cos_h = t.field(GeometryField::cos_h);
    const ExprId a2 = t.power(alpha, "2");
    const ExprId denominator =
        t.add(t.multiply(t.power(cos_h, "2"), t.subtract(a2, t.number("1"))), t.number("1"));
    const Module before =
        only(t, t.divide(a2, t.multiply(t.number("pi"), t.power(denominator, "2"))));
    const Module after = optimize::optimize(before);

    // h within a few alpha of n, where all of the lobe is. n is exact, so Lagrange's identity
    // holds for rounded l and v too: the definition itself, at 200 bits, is the truth.
    std::mt19937 random{11};
    Points<float> points = rounded(directions(random, 500, 0.002, 0.3));
    points["alpha"] = std::vector<float>(500, 0.0009765625F);
    const auto truth = values(before, entry_point(before, FunctionId{0}), widened(points));
    const double naive =
        worst_error(values(before, entry_point(before, FunctionId{0}), points), truth);
    const double stable =
        worst_error(values(after, entry_point(after, FunctionId{0}), points), truth);
    CHECK(naive > 1e-2);
    // h rounds to 2^-24 per component, and sin^2 then to 2^-22 or so of itself; D goes with its
    // square. A dozen more roundings of 2^-24 fit below 1e-6.
    CHECK(stable < 1e-6);
}

TEST_CASE(
    "GGX of a known roughness cancels no more than of any, and its numbers are what is on paper")
{
    // alpha = 0.01: of 1 - 0.9999 a float keeps three digits.
    Term t{"D_GGX"};
    const ExprId cos_h = t.field(GeometryField::cos_h);
    const ExprId denominator =
        t.subtract(t.number("1"), t.multiply(t.number("0.9999"), t.power(cos_h, "2")));
    const Module before = only(t, t.divide(t.number("0.0001"), t.power(denominator, "2")));
    const Module after = optimize::optimize(before);

    std::mt19937 random{12};
    const Points<float> points = rounded(directions(random, 500, 0.02, 0.3));
    const auto truth = values(before, entry_point(before, FunctionId{0}), widened(points));
    CHECK(worst_error(values(before, entry_point(before, FunctionId{0}), points), truth) > 1e-3);
    // As above; the two numbers are a rounding each.
    CHECK(worst_error(values(after, entry_point(after, FunctionId{0}), points), truth) < 1e-6);
}

TEST_CASE("Schlick's base near coinciding directions, through a call")
{
    const Module before = through_call([](Site& s) { return s.t.subtract(s.one, s.x); });
    const Module after = optimize::optimize(before);
    std::mt19937 random{13};
    constexpr double spread = 0.02;
    auto exact = directions(random, 500, 0.4, spread);
    exact["a"] = std::vector<Real>(500, Real{0.5, real_bits});
    // Only points whose chord is at least a tenth of the spread: rounding l and v moves each by
    // up to sqrt(3) 2^-25, the chord |l - v| = 2 theta by twice that, its square by twice more.
    std::vector<double> chords;
    for (std::size_t i = 0; i < 500; ++i) {
        double square = 0;
        for (const char* part : {".x", ".y", ".z"})
            square += std::pow(exact[std::string{"l"} + part][i].to_double() -
                                   exact[std::string{"v"} + part][i].to_double(),
                               2);
        chords.push_back(std::sqrt(square));
    }
    const auto truth = values(before, entry_point(before, last(before)), exact);
    const auto points = rounded(exact);
    const auto naive = values(before, entry_point(before, last(before)), points);
    const auto stable = values(after, entry_point(after, last(after)), points);
    double worst_naive = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (chords[i] < spread / 10) continue;
        const double value = truth[i].to_double();
        worst_naive = std::fmax(worst_naive, std::fabs(double{naive[i]} - value) / value);
        const double input_error = 4 * std::sqrt(3.0) * 0x1p-25 / chords[i];
        const double roundings = 16 * 0x1p-24;
        CAPTURE(i, chords[i]);
        CHECK(std::fabs(double{stable[i]} - value) / value < input_error + roundings);
    }
    CHECK(worst_naive > 5e-3);
}

TEST_CASE("a factored square loses nothing that a scalar knows")
{
    const Module before =
        optimize::simplify(directly([](Site& s) { return s.t.subtract(s.one, s.square(s.x)); }));
    const Module after = stabilize(before);
    Points<float> points;
    for (int i = 1; i <= 1000; ++i) points["x"].push_back(1.0F - static_cast<float>(i) * 0x1p-20F);
    points["a"] = std::vector<float>(1000, 1.0F);  // a root keeps it, though nothing reads it
    const auto truth = values(before, before.functions[0], widened(points));
    // x^2 is off by 2^-25 at most, and 1 - x^2 is 2^-11.5 where it first is by that much.
    CHECK(worst_error(values(before, before.functions[0], points), truth) > 0x1p-14);
    // 1 - x is exact here (Sterbenz); 1 + x and the product round once each.
    CHECK(worst_error(values(after, after.functions[0], points), truth) <= 2.01 * 0x1p-24);
}

TEST_CASE("a mask that is tiny keeps its digits")
{
    const Module before = optimize::simplify(directly(
        [](Site& s) { return s.t.subtract(s.one, s.t.power(s.t.subtract(s.one, s.x), "3")); }));
    const Module after = stabilize(before);
    Points<float> points;
    for (int i = 1; i <= 1000; ++i) points["x"].push_back(static_cast<float>(i) * 1e-6F);
    points["a"] = std::vector<float>(1000, 1.0F);  // a root keeps it, though nothing reads it
    const auto truth = values(before, before.functions[0], widened(points));
    // 1 - x is off by 2^-25, its cube by three times that, of a mask of 3e-6.
    CHECK(worst_error(values(before, before.functions[0], points), truth) > 1e-3);
    // Six roundings of 2^-24 on sums and products of positive numbers.
    CHECK(worst_error(values(after, after.functions[0], points), truth) <= 6 * 0x1p-24);
}

TEST_CASE("a root keeps its declared arguments, and its callees still gain from it")
{
    // The library's own Schlick: nobody can hand it a complement.
    Term t{"F_Schlick"};
    const ExprId cos_d = t.argument("cos_d", 0, 1);
    const Module library = only(t, t.power(t.subtract(t.number("1"), cos_d), "5"));
    CHECK(optimize::same_graphs(stabilize(library), library));

    const Module module = stabilize(through_call([](Site& s) { return s.t.subtract(s.one, s.x); }));
    REQUIRE(module.functions[0].inputs.size() == 1);
    CHECK(module.functions[0].inputs[0].name == "one_minus_x");
    REQUIRE(module.functions[1].inputs.size() == 2);
    CHECK(module.functions[1].inputs[0].name == "one_minus_cos_d");
    CHECK(module.functions[1].inputs[1].name == "a");
}

TEST_CASE("every call site hands over a complement, also those without a stable one")
{
    Module module = empty_module();
    Term callee{"callee"};
    const ExprId x = callee.argument("x");
    const FunctionId id =
        callee.in(module, callee.power(callee.subtract(callee.number("1"), x), "3"));
    Term middle{"middle"};
    const ExprId y = middle.argument("y");
    const FunctionId middle_id = middle.in(module, middle.call(module, id, {y}));
    Term root{"root"};
    const ExprId cos_h = root.field(GeometryField::cos_h);
    const ExprId cos_i = root.field(GeometryField::cos_i);
    const ExprId z = root.argument("z", 0, 1);
    ExprId sum = root.call(module, middle_id, {cos_h});
    sum = root.add(sum, root.call(module, id, {cos_i}));
    sum = root.add(sum, root.call(module, id, {root.subtract(root.number("1"), z)}));
    sum = root.add(sum, root.call(module, middle_id, {root.number("0.25")}));
    const FunctionId root_id = root.in(module, sum);
    set_roots(module, {root_id});

    const Module after = stabilize(module);
    REQUIRE_FALSE(verify(after));
    CHECK(after.functions[0].inputs[0].name == "one_minus_x");
    CHECK(after.functions[1].inputs[0].name == "one_minus_y");

    auto points = points_everywhere();
    points["z"] = points["x"];
    const auto expected = values(module, entry_point(module, root_id), points);
    const auto actual = values(after, entry_point(after, root_id), points);
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(difference(expected[i], actual[i]) < real_slack);
}

TEST_CASE("stabilizing keeps the value of random terms over the real numbers", "[property]")
{
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        std::mt19937 random{seed};
        const Module module = random_term(random, 40);
        const Module stable = stabilize(module);
        CAPTURE(seed);
        REQUIRE_FALSE(verify(stable));
        const auto points = in_real(sample(module, module.functions[0], random, 16));
        const auto before = values(module, module.functions[0], points);
        const auto after = values(stable, stable.functions[0], points);
        for (std::size_t i = 0; i < before.size(); ++i)
            REQUIRE(difference(before[i], after[i]) < real_slack);
    }
}
