// Forms in place of their terms: what is called, and what a caller gains by it.
#include "models.h"
#include "optimize/forms.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "values.h"

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;

namespace {

constexpr const char* text = R"(module test
param gain : float in [0, 2] = 1 "Gain"
/// A term with another way that reads more than it does.
term base(x: unit, g: geometry) -> float in [0, 4] = x * g.cos_i
  /// a
  form brighter = x * g.cos_o + gain
  /// b
  form through_other = other(x, g) * 0.5
/// What a form needs, which calls the term.
term other(x: unit, g: geometry) -> float = base(x, g) + 1
/// calls base
term twice(x: unit, g: geometry) -> float = 2 * base(x, g)
model m(g: geometry) { light = twice(0.5, g) + other(0.25, g) }
)";

const Function& named(const Module& module, std::string_view name)
{
    return module[*module.find(name)];
}

bool calls(const Module& module, std::string_view caller, std::string_view callee)
{
    const Function& function = named(module, caller);
    const auto uses = use_counts(function.graph, function.result);
    for (const ExprId id : function.graph.ids())
        if (uses[id] > 0 && function.graph[id].op == Op::call &&
            module.functions[function.graph[id].aux].name == callee)
            return true;
    return false;
}

}  // namespace

TEST_CASE("alternatives are the terms with forms that are called")
{
    const Module module = read_text(text);
    const auto found = optimize::alternatives(module, module.roots());
    REQUIRE(found.size() == 1);
    CHECK(module[found[0].term].name == "base");
    REQUIRE(found[0].forms.size() == 2);
    CHECK(module[found[0].forms[0]].name == "base_brighter");
    CHECK(module[found[0].forms[1]].name == "base_through_other");
}

TEST_CASE("a chosen form is called, and its inputs are handed down")
{
    const Module module = read_text(text);
    const Module chosen = optimize::choose(module, {{"base", "brighter"}});
    REQUIRE_FALSE(verify(chosen));
    CHECK(calls(chosen, "twice", "base_brighter"));
    CHECK(calls(chosen, "other", "base_brighter"));
    const auto cos_o = static_cast<std::uint32_t>(GeometryField::cos_o);
    const FunctionId root = chosen.roots()[0];
    CHECK(chosen[root].find_input(Origin::geometry, cos_o));
    CHECK(chosen[root].find_input(Origin::parameter, 0));
    CHECK_FALSE(chosen[root].find_input(Origin::geometry,
                                        static_cast<std::uint32_t>(GeometryField::cos_i)));
    // The term is still there, and what it was.
    CHECK(optimize::same_function(named(chosen, "base"), named(module, "base")));

    // 2 (x_1 cos_o + gain) + (x_2 cos_o + gain) + 1
    Points<float> points{{"cos_o", {0.5F}}, {"gain", {0.125F}}};
    CHECK(values(chosen, chosen[root], points) == std::vector<float>{2.0F});
    CHECK_FALSE(verify(optimize::optimize(chosen)));
}

TEST_CASE("what a form is made from keeps calling the term")
{
    const Module module = read_text(text);
    const Module chosen = optimize::choose(module, {{"base", "through_other"}});
    REQUIRE_FALSE(verify(chosen));
    CHECK(calls(chosen, "twice", "base_through_other"));
    CHECK(calls(chosen, "other", "base"));
}

TEST_CASE("unknown names choose nothing")
{
    const Module module = read_text(text);
    CHECK(optimize::same_graphs(optimize::choose(module, {{"base", "none"}, {"none", "none"}}),
                                module));
}

TEST_CASE("forms of imported terms come along")
{
    const Module module = read_text("module test\n"
                                    "import microfacet { F_Schlick }\n"
                                    "model m(g: geometry, s: surface) {\n"
                                    "  light = F_Schlick(s.f0, g.cos_d)\n"
                                    "}\n");
    const auto found = optimize::alternatives(module, module.roots());
    REQUIRE(found.size() == 1);
    const Module chosen = optimize::choose(module, {{"F_Schlick", "spherical_gaussian"}});
    CHECK(calls(chosen, "m_light", "F_Schlick_spherical_gaussian"));
}
