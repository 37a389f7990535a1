// From text to graph: which operations, which inputs, in which order, with which value.
#include "check/checking.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using ir::Op;
using lobe::tests::check_text;
using lobe::tests::inputs_of;
using lobe::tests::value_at;

namespace {

bool has(const ir::Function& function, Op op)
{
    const auto uses = ir::use_counts(function.graph, function.result);
    for (const ir::ExprId id : function.graph.ids())
        if (uses[id] > 0 && function.graph[id].op == op) return true;
    return false;
}

}  // namespace

TEST_CASE("structures are replaced in place by the fields in use", "[check][lowering]")
{
    const auto checked = check_text(R"(
param late : unit = 0
param early : unit = 0
/// All of them, in another order than they are used.
term f(a: unit, s: surface, b: unit, g: geometry, c: color) -> color =
  c * late * g.cos_d * s.f0 * g.cos_i * early + s.metallic * b
/// Nothing of the geometry, and not all arguments.
term h(g: geometry, a: unit, b: unit) -> unit = b
)");
    REQUIRE(checked.errors() == "");
    CHECK(inputs_of(checked.function("f")) == "a metallic f0 b cos_i cos_d c late early");
    CHECK(inputs_of(checked.function("h")) == "a b");
}

TEST_CASE("a caller has the fields and parameters of its callees", "[check][lowering]")
{
    const auto checked = check_text(R"(
param gain : float in [0, 4] = 1
/// outer, declared before what it calls
term outer(g: geometry, s: surface, x: unit) -> float = inner(x, s, g) * x
/// inner
term inner(x: unit, s: surface, g: geometry) -> float = x * gain * g.cos_h * s.roughness
)");
    REQUIRE(checked.errors() == "");
    CHECK(inputs_of(checked.function("outer")) == "cos_h roughness x gain");
    CHECK(inputs_of(checked.function("inner")) == "x roughness cos_h gain");
    CHECK(value_at(*checked.module, checked.function("outer"), {0.5, 0.25, 0.5, 3}) ==
          0.5 * 3 * 0.5 * 0.25 * 0.5);
}

TEST_CASE("a local that the result does not need leaves no input", "[check][lowering]")
{
    const auto checked = check_text(R"(
param gain : unit = 1
/// f
term f(g: geometry, x: unit) -> float {
  let unused = gain * g.cos_i
  x
}
)");
    CHECK(checked.warnings() == "W0301");
    CHECK(inputs_of(checked.function("f")) == "x");
}

TEST_CASE("alpha is the square of roughness", "[check][lowering]")
{
    const auto checked = check_text("/// f\nterm f(s: surface) -> float = s.alpha");
    REQUIRE(checked.errors() == "");
    CHECK(inputs_of(checked.function("f")) == "roughness");
    CHECK(value_at(*checked.module, checked.function("f"), {0.25}) == 0.0625);
    CHECK(checked.function("f").range == ir::Range{0x1p-12, 1});
}

TEST_CASE("hazards are lowered to their guarded operations", "[check][lowering]")
{
    const auto function = [](const std::string& body) {
        const auto checked = check_text("/// f\nterm f(x: unit, y: unit, v: float3) = " + body);
        CAPTURE(body, checked.errors());
        return checked.function("f");
    };
    CHECK(has(function("x^y"), Op::guarded_power));
    CHECK(has(function("pow(x, y)"), Op::guarded_power));
    CHECK(has(function("x^5"), Op::power));
    CHECK(has(function("(x + 1)^-2"), Op::power));
    CHECK(!has(function("x^5"), Op::guarded_power));
    CHECK(has(function("smoothstep(0, y, x)"), Op::guarded_smoothstep));
    CHECK(has(function("normalize(v)"), Op::guarded_normalize));
    CHECK(has(function("x / y else 0"), Op::select));
    CHECK(!has(function("x / (1 + y)"), Op::select));
}

TEST_CASE("a negative literal is a literal", "[check][lowering]")
{
    const auto checked = check_text("/// f\nterm f(x: unit) = x + -5.55473");
    REQUIRE(checked.module);
    CHECK(!has(checked.function("f"), Op::negate));
    CHECK(value_at(*checked.module, checked.function("f"), {0}) == -5.55473);
}

TEST_CASE("expressions have the value that they say", "[check][lowering]")
{
    const auto value = [](const std::string& body, std::vector<double> point) {
        const auto checked =
            check_text("/// f\nterm f(x: float in [0, 10], y: float in [0, 10]) = " + body);
        CAPTURE(body, checked.errors());
        return value_at(*checked.module, checked.function("f"), point);
    };
    CHECK(value("x - y - 1", {5, 2}) == 2);
    CHECK(value("2 * x^2 - -y", {3, 1}) == 19);
    CHECK(value("2^x^y", {3, 2}) == 512);
    CHECK(value("-x^2", {3, 0}) == -9);
    CHECK(value("x / y else 7", {4, 0}) == 7);
    CHECK(value("x / y else 7", {4, 2}) == 2);
    CHECK(value("x^y", {0, 0}) == 1);
    CHECK(value("if x > y and not (y == 2) then 1 else 0", {3, 1}) == 1);
    CHECK(value("if x > y and not (y == 2) then 1 else 0", {3, 2}) == 0);
    CHECK(value("if x >= 3 or y <= 0 then 1 else 0", {3, 1}) == 1);
    CHECK(value("if true then x else y", {3, 1}) == 3);
    CHECK(value("if false then x else y", {3, 1}) == 1);
    CHECK(value("if x != y then 1 else 0", {3, 3}) == 0);
    CHECK(value("dot(float3(x, y, 1), float3(1, 2, 3))", {3, 4}) == 14);
    CHECK(value("luminance(color(x, x, x))", {1, 0}) == 0.2126 + 0.7152 + 0.0722);
    CHECK(value("length(float2(x, y))", {3, 4}) == 5);
    CHECK(value("if float2(x, y) == float2(3, 4) then 1 else 0", {3, 4}) == 1);
    CHECK(value("if float2(x, y) != float2(3, 4) then 1 else 0", {3, 4}) == 0);
    CHECK(value("float3(float2(x, y), 9).z", {3, 4}) == 9);
    CHECK(value("color(x).b", {3, 4}) == 3);
    CHECK(value("step(x, y)", {3, 3}) == 1);
    CHECK(value("clamp(x, 1, 2) + saturate(y)", {3, 4}) == 3);
}

TEST_CASE("a vector's division names its limit per component", "[check][lowering]")
{
    const auto checked = check_text("/// f\nterm f(c: color) -> color = 1 / c else 5");
    REQUIRE(checked.errors() == "");
    const ir::Function& function = checked.function("f");
    CHECK(value_at(*checked.module, function, {0, 0.5, 0.25}, 0) == 5);
    CHECK(value_at(*checked.module, function, {0, 0.5, 0.25}, 1) == 2);
    CHECK(value_at(*checked.module, function, {0, 0.5, 0.25}, 2) == 4);
}

TEST_CASE("the dot product of directions stays a cosine", "[check][lowering]")
{
    // Without the clamp, acos could leave its domain.
    const auto checked = check_text("/// f\nterm f(g: geometry) = acos(dot(g.n, g.l))");
    CHECK(checked.errors() == "");
    CHECK(checked.function("f").range.high < 3.1416);
}

TEST_CASE("lets keep their names", "[check][lowering]")
{
    const auto checked = check_text(R"(
/// f
term f(x: unit) -> float {
  let mask = 1 - x^2
  mask * mask
}
)");
    const ir::Graph& graph = checked.function("f").graph;
    bool named = false;
    for (const ir::ExprId id : graph.ids()) named = named || graph.name_of(id) == "mask";
    CHECK(named);
}

TEST_CASE("forms follow their term", "[check][lowering]")
{
    const auto checked = check_text(R"(
/// Fresnel.
term F(f0: color, cos_d: unit) -> color = f0 + (1 - f0) * (1 - cos_d)^5
  /// As a spherical Gaussian.
  form gaussian = f0 + (1 - f0) * 2^((-5.55473 * cos_d - 6.98316) * cos_d)
  form gray = cos_d
/// Calls a form.
term g(x: unit) -> color = F_gaussian(x, x)
)");
    REQUIRE(checked.errors() == "");
    const ir::Function& form = checked.function("F_gaussian");
    CHECK(form.kind == ir::Function::Kind::form);
    CHECK(form.form_name == "gaussian");
    CHECK(form.doc == "As a spherical Gaussian.");
    CHECK((*checked.module)[form.form_of].name == "F");
    CHECK(checked.function("F_gray").type() == ir::Type::vec3);
}

TEST_CASE("a use of what is wrong is not wrong again", "[check][lowering]")
{
    CHECK(check_text(R"(
param broken : flaot = 0
/// f
term f(x: colour, y: unit) -> float = x * y + broken + missing
/// g
term g(x: unit) -> float {
  let a = missing
  let b = a + f(x, x) * a
  1 / b + b.x
}
)")
              .errors() == "E0405 E0405 E0301 E0301");
}

TEST_CASE("errors come in the order of the text", "[check][lowering]")
{
    const auto checked = check_text(R"(
/// c
term c(x: unit) -> float = b(x) + one
/// b
term b(x: unit) -> float = a(x) + two
/// a
term a(x: unit) -> float = x + three
)");
    std::string names;
    for (const Diagnostic& diagnostic : checked.diagnostics.all())
        names += std::string{checked.sources.text(diagnostic.primary.span)} + " ";
    CHECK(names == "one two three ");
}
