// Same-result tests: what simplifies away leaves exactly what it was wrapped around. And the
// promise of the header: bit for bit in double.
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/truth.h"
#include "random_term.h"
#include "values.h"

#include <functional>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::simplify;

namespace {

/// Two scalars and a color to write about.
struct Site {
    Term t{"term"};
    ExprId x = t.argument("x", -2, 2);
    ExprId unit = t.argument("unit", 0, 1);
    ExprId v = t.argument("v", 0, 1, Type::vec3);
    ExprId n(std::string_view text) { return t.number(text); }
    ExprId spread(std::string_view text)
    {
        const ExprId scalar = n(text);
        return t.function.graph.construct(Type::vec3, {&scalar, 1});
    }
};
using Body = std::function<ExprId(Site&)>;

Module module_of(const Body& body)
{
    Site site;
    const ExprId result = body(site);
    return only(site.t, result);
}

bool same(const Body& a, const Body& b)
{
    const Module left = simplify(module_of(a));
    const Module right = simplify(module_of(b));
    if (optimize::same_graphs(left, right)) return true;
    UNSCOPED_INFO(dump(left.functions[0].graph) << "and\n" << dump(right.functions[0].graph));
    return false;
}

const Body just_x = [](Site& s) { return s.x; };
const Body just_v = [](Site& s) { return s.v; };
const Body zero = [](Site& s) { return s.n("0"); };
const Body one = [](Site& s) { return s.n("1"); };
const Body minus_x = [](Site& s) { return s.t.op(Op::negate, {s.x}); };

}  // namespace

TEST_CASE("neutral operands go")
{
    CHECK(same([](Site& s) { return s.t.add(s.x, s.n("0")); }, just_x));
    CHECK(same([](Site& s) { return s.t.add(s.n("0"), s.x); }, just_x));
    CHECK(same([](Site& s) { return s.t.subtract(s.x, s.n("0")); }, just_x));
    CHECK(same([](Site& s) { return s.t.multiply(s.x, s.n("1")); }, just_x));
    CHECK(same([](Site& s) { return s.t.multiply(s.n("1"), s.x); }, just_x));
    CHECK(same([](Site& s) { return s.t.divide(s.x, s.n("1")); }, just_x));
    CHECK(same([](Site& s) { return s.t.power(s.x, "1"); }, just_x));
    CHECK(same([](Site& s) { return s.t.power(s.x, "0"); }, one));
    CHECK(same([](Site& s) { return s.t.op(Op::guarded_power, {s.n("1"), s.x}); }, one));
    CHECK(same([](Site& s) { return s.t.op(Op::minimum, {s.x, s.x}); }, just_x));
}

TEST_CASE("signs move out of the way")
{
    CHECK(same([](Site& s) { return s.t.subtract(s.n("0"), s.x); }, minus_x));
    CHECK(same([](Site& s) { return s.t.multiply(s.x, s.n("-1")); }, minus_x));
    CHECK(same([](Site& s) { return s.t.op(Op::negate, {s.t.op(Op::negate, {s.x})}); }, just_x));
    CHECK(same([](Site& s) { return s.t.add(s.unit, s.t.op(Op::negate, {s.x})); },
               [](Site& s) { return s.t.subtract(s.unit, s.x); }));
    CHECK(same([](Site& s) { return s.t.op(Op::negate, {s.t.subtract(s.x, s.unit)}); },
               [](Site& s) { return s.t.subtract(s.unit, s.x); }));
    CHECK(same([](Site& s) { return s.t.add(s.x, s.n("-2")); },
               [](Site& s) { return s.t.subtract(s.x, s.n("2")); }));
    CHECK(same([](Site& s) { return s.t.op(Op::negate, {s.n("0.19")}); },
               [](Site& s) { return s.n("-0.19"); }));
}

TEST_CASE("lerp is exact at its ends, and constant between equal ones")
{
    CHECK(same([](Site& s) { return s.t.op(Op::lerp, {s.x, s.x, s.unit}); }, just_x));
    CHECK(same([](Site& s) { return s.t.op(Op::lerp, {s.x, s.unit, s.n("0")}); }, just_x));
    CHECK(same([](Site& s) { return s.t.op(Op::lerp, {s.unit, s.x, s.n("1")}); }, just_x));
    // An effect that is off: the weight does not matter.
    CHECK(same(
        [](Site& s) {
            return s.t.op(Op::lerp, {s.n("1"), s.spread("1"), s.unit});
        },
        [](Site& s) { return s.spread("1"); }));
    CHECK(same(
        [](Site& s) {
            const ExprId weight = s.t.multiply(s.v, s.n("0"));
            return s.t.op(Op::lerp, {s.n("1"), s.v, weight});
        },
        [](Site& s) { return s.spread("1"); }));
}

TEST_CASE("literals fold where the fold is exact, and only there")
{
    CHECK(same([](Site& s) { return s.t.multiply(s.n("5"), s.n("0.5")); },
               [](Site& s) { return s.n("2.5"); }));
    CHECK(same([](Site& s) { return s.t.multiply(s.n("2"), s.t.subtract(s.n("1"), s.n("0.75"))); },
               [](Site& s) { return s.n("0.5"); }));
    const Module third =
        simplify(module_of([](Site& s) { return s.t.divide(s.n("1"), s.n("3")); }));
    CHECK(third.functions[0].graph[third.functions[0].result].op == Op::divide);
    const Module tenth =
        simplify(module_of([](Site& s) { return s.t.multiply(s.n("3"), s.n("0.1")); }));
    CHECK(tenth.functions[0].graph[tenth.functions[0].result].op == Op::multiply);
}

TEST_CASE("vectors of literals fold by component")
{
    CHECK(same([](Site& s) { return s.t.multiply(s.v, s.spread("1")); }, just_v));
    CHECK(same(
        [](Site& s) {
            const ExprId tint[] = {s.n("0.5"), s.n("0.25"), s.n("1")};
            return s.t.multiply(s.n("2"), s.t.function.graph.construct(Type::vec3, tint));
        },
        [](Site& s) {
            const ExprId tint[] = {s.n("1"), s.n("0.5"), s.n("2")};
            return s.t.function.graph.construct(Type::vec3, tint);
        }));
    CHECK(same([](Site& s) { return s.t.add(s.x, s.spread("0")); },
               [](Site& s) {
                   return s.t.function.graph.construct(Type::vec3, {&s.x, 1});
               }));
}

TEST_CASE("a vector taken apart and put together is the vector")
{
    CHECK(same(
        [](Site& s) {
            Graph& graph = s.t.function.graph;
            const ExprId parts[] = {graph.component(s.v, 0), graph.component(s.v, 1),
                                    graph.component(s.v, 2)};
            return graph.construct(Type::vec3, parts);
        },
        just_v));
    CHECK(same(
        [](Site& s) {
            const ExprId parts[] = {s.unit, s.x, s.unit};
            return s.t.function.graph.component(s.t.function.graph.construct(Type::vec3, parts), 1);
        },
        just_x));
}

TEST_CASE("what ranges decide is decided")
{
    const Body just_unit = [](Site& s) { return s.unit; };
    CHECK(same([](Site& s) { return s.t.op(Op::saturate, {s.unit}); }, just_unit));
    CHECK(same([](Site& s) { return s.t.op(Op::maximum, {s.unit, s.n("0")}); }, just_unit));
    CHECK(same([](Site& s) { return s.t.op(Op::minimum, {s.n("3"), s.x}); }, just_x));
    CHECK(same([](Site& s) { return s.t.op(Op::absolute, {s.unit}); }, just_unit));
    CHECK(same(
        [](Site& s) {
            return s.t.op(Op::clamp, {s.x, s.n("0"), s.n("1")});
        },
        [](Site& s) { return s.t.op(Op::saturate, {s.x}); }));
    // A select whose divisor is never 0 was a guard, and goes.
    CHECK(same(
        [](Site& s) {
            const ExprId divisor = s.t.add(s.unit, s.n("1"));
            return s.t.op(Op::select,
                          {s.t.op(Op::equal, {divisor, s.n("0")}), s.x, s.t.divide(s.x, divisor)});
        },
        [](Site& s) { return s.t.divide(s.x, s.t.add(s.unit, s.n("1"))); }));
    CHECK_FALSE(same([](Site& s) { return s.t.op(Op::saturate, {s.x}); }, just_x));
    CHECK_FALSE(same([](Site& s) { return s.t.op(Op::maximum, {s.x, s.n("0")}); }, just_x));
}

TEST_CASE("zero times x is zero when x is known to be finite")
{
    CHECK(same([](Site& s) { return s.t.multiply(s.x, s.n("0")); }, zero));
    CHECK(same([](Site& s) { return s.t.subtract(s.x, s.x); }, zero));
    const auto unbounded = [](Op op, bool twice) {
        Term t{"term"};
        const ExprId x = t.argument("x", -infinity, infinity);
        return only(t, t.op(op, {x, twice ? x : t.number("0")}));
    };
    for (const Module& module : {unbounded(Op::multiply, false), unbounded(Op::subtract, true)})
        CHECK(optimize::same_graphs(simplify(module), module));
}

TEST_CASE("a smoothstep whose edges meet is a step")
{
    CHECK(same(
        [](Site& s) {
            return s.t.op(Op::guarded_smoothstep, {s.n("0"), s.t.multiply(s.unit, s.n("0")), s.x});
        },
        [](Site& s) {
            return s.t.op(Op::select, {s.t.op(Op::less, {s.n("0"), s.x}), s.n("1"), s.n("0")});
        }));
}

TEST_CASE("conditions that are known choose")
{
    CHECK(same(
        [](Site& s) {
            return s.t.op(Op::select, {s.t.op(Op::less, {s.n("0"), s.n("1")}), s.x, s.unit});
        },
        just_x));
    CHECK(same(
        [](Site& s) {
            const ExprId below = s.t.op(Op::less, {s.x, s.n("3")});  // always: x is in [-2, 2]
            const ExprId open = s.t.op(Op::less, {s.x, s.unit});
            const ExprId both = s.t.op(Op::logical_and, {below, open});
            return s.t.op(Op::select, {both, s.x, s.unit});
        },
        [](Site& s) {
            return s.t.op(Op::select, {s.t.op(Op::less, {s.x, s.unit}), s.x, s.unit});
        }));
    const Module module = simplify(module_of([](Site& s) {
        return s.t.op(Op::less_equal, {s.unit, s.n("1")});
    }));
    CHECK(optimize::truth(module.functions[0].graph, module.functions[0].result) == true);
}

TEST_CASE("two decimals that share a double are still two numbers")
{
    // Both round to 0.1.
    const Module module = simplify(module_of([](Site& s) {
        return s.t.op(Op::equal, {s.n("0.1"), s.n("0.10000000000000000001")});
    }));
    const Function& function = module.functions[0];
    CHECK_FALSE(optimize::truth(function.graph, function.result));
}

TEST_CASE("a call that is not worth its name is what it returns")
{
    Module module = empty_module();
    Term scale{"falloff_scale"};
    const ExprId x = scale.argument("x");
    const FunctionId scale_id =
        scale.in(module, scale.multiply(scale.number("2"), scale.subtract(scale.number("1"), x)));
    Term same{"same"};
    same.argument("ignored");
    const FunctionId same_id = same.in(module, same.argument("y"));

    Term root{"root"};
    const ExprId a = root.argument("a");
    const ExprId folded = root.call(module, scale_id, {root.number("0.75")});
    const ExprId kept = root.call(module, scale_id, {root.number("0.1")});
    const ExprId passed = root.call(module, same_id, {folded, a});
    const FunctionId id = root.in(module, root.multiply(root.multiply(folded, kept), passed));
    set_roots(module, {id});

    const Module after = simplify(module);
    CHECK_FALSE(verify(after));
    // 0.5 * falloff_scale(0.1) * a
    Module expected = after;
    Term written{"root"};
    const ExprId b = written.argument("a");
    const ExprId call =
        written.function.graph.call(scale_id, Type::scalar, std::vector{written.number("0.1")});
    const ExprId product = written.multiply(written.multiply(written.number("0.5"), call), b);
    expected.functions.pop_back();
    written.in(expected, product);
    CHECK(optimize::same_graphs(simplify(expected), after));
}

TEST_CASE("simplification keeps every value bit for bit in double, but for the sign of zero",
          "[property]")
{
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        std::mt19937 random{seed};
        const Module module = random_term(random, 40);
        const Module simple = simplify(module);
        CAPTURE(seed);
        REQUIRE_FALSE(verify(simple));
        REQUIRE(simple.functions[0].graph.size() <= module.functions[0].graph.size());
        REQUIRE(optimize::same_graphs(simplify(simple), simple));

        const auto points = sample(module, module.functions[0], random, 64);
        const auto before = values(module, module.functions[0], points);
        const auto after = values(simple, simple.functions[0], points);
        for (std::size_t i = 0; i < before.size(); ++i) {
            CAPTURE(i, before[i], after[i]);
            REQUIRE(std::isfinite(before[i]));
            REQUIRE(same_bits(before[i], after[i]));
        }
    }
}
