// What is proved, what is refused, and what the proofs are made of.
#include "check/boxes.h"
#include "check/checking.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using lobe::tests::check_text;

namespace {

std::string errors_of(const std::string& body, const std::string& arguments = "x: unit, y: unit")
{
    return check_text("/// f\nterm f(" + arguments + ") = " + body).errors();
}

std::string result_error(const std::string& range, const std::string& body,
                         const std::string& arguments = "x: unit, y: unit")
{
    return check_text("/// f\nterm f(" + arguments + ") -> " + range + " = " + body).errors();
}

}  // namespace

TEST_CASE("divisions are proved by ranges, or refused", "[check][ranges]")
{
    CHECK(errors_of("1 / (1 + x)") == "");
    CHECK(errors_of("1 / x") == "E0501");
    CHECK(errors_of("1 / (x - 2)") == "");
    CHECK(errors_of("1 / (x - y)") == "E0501");
    // 0 at no corner and no sample: only a change of sign shows it.
    CHECK(errors_of("1 / (3 * x - 1.2345)") == "E0501");
    // Plain intervals give [-1, 1]; halving proves it.
    CHECK(errors_of("1 / (x * x - x + 0.26)") == "");
    CHECK(errors_of("1 / (x * x - x + 0.25)") == "E0501");
    // The GGX denominator without its alpha.
    CHECK(errors_of("1 / (1 - x^2 + x^2 * a^2)", "x: unit, a: float in [1/4096, 1]") == "");
    CHECK(errors_of("1 / (1 - x^2 + x^2 * a^2)", "x: unit, a: unit") == "E0501");
}

TEST_CASE("a condition narrows what is known inside its arms", "[check][ranges]")
{
    CHECK(errors_of("if x > 0 then 1 / x else 0") == "");
    CHECK(errors_of("if 0 < x then 1 / x else 0") == "");
    CHECK(errors_of("if x == 0 then 0 else 1 / x") == "");
    CHECK(errors_of("if x != 0 then 1 / x else 0") == "");
    CHECK(errors_of("if not (x <= 0) then 1 / x else 0") == "");
    CHECK(errors_of("if x <= 0 or y > 0.5 then 0 else 1 / x") == "");
    CHECK(errors_of("if x > 0 and y > 0 then 1 / (x * y) else 0") == "");
    CHECK(errors_of("if x > 0 then (if y > 0 then 1 / x / y else 1 / x) else 0") == "");
    CHECK(errors_of("if x > y then sqrt(x - y) else 0") == "");
    CHECK(errors_of("if x >= y then sqrt(x - y) else sqrt(y - x)") == "");
    CHECK(errors_of("if x > y then 1 / (x - y) else 0") == "");
    // The other arm, another value, or a weaker condition.
    CHECK(errors_of("if x > 0 then 0 else 1 / x") == "E0501");
    CHECK(errors_of("if x > 0 then 1 / y else 0") == "E0501");
    CHECK(errors_of("if x >= 0 then 1 / x else 0") == "E0501");
    CHECK(errors_of("if x > 0 or y > 0 then 1 / x else 0") == "E0501");
    CHECK(errors_of("(if x > 0 then 1 else 0) / x") == "E0501");
}

TEST_CASE("domains end where they end", "[check][ranges]")
{
    CHECK(errors_of("sqrt(x)") == "");
    CHECK(errors_of("sqrt(1 - x^2)") == "");
    CHECK(errors_of("sqrt(x - 1)") == "E0502");
    CHECK(errors_of("log(x)") == "E0502");
    CHECK(errors_of("log2(x + 0.001)") == "");
    CHECK(errors_of("inversesqrt(x)") == "E0502");
    CHECK(errors_of("acos(2 * x - 1)") == "");
    CHECK(errors_of("acos(2 * x)") == "E0502");
    CHECK(errors_of("asin(x + y)") == "E0502");
    CHECK(errors_of("tan(1.57 * x)") == "");
    CHECK(errors_of("tan(1.58 * x)") == "E0502");
}

TEST_CASE("powers of what has none", "[check][ranges]")
{
    CHECK(errors_of("x^y") == "");
    CHECK(errors_of("(x - y)^2") == "");
    CHECK(errors_of("(x - y)^2.5") == "E0503");
    CHECK(errors_of("(x - y)^y") == "E0503");
    CHECK(errors_of("x^-1") == "E0509");
    CHECK(errors_of("x^(y - 1)") == "E0509");
    CHECK(errors_of("(x + 1)^(y - 1)") == "");
    CHECK(errors_of("x^(2 / (y + 0.5)^2 - 0.8)") == "");
    CHECK(errors_of("x^(2 / a^2 - 2)", "x: unit, a: float in [1/4096, 1]") == "");
}

TEST_CASE("declared results are proved", "[check][ranges]")
{
    CHECK(result_error("unit", "x * y") == "");
    CHECK(result_error("unit", "x + y") == "E0507");
    CHECK(result_error("unit", "x + y - x * y") == "");
    // Slopes: the dependence on f0 cancels.
    CHECK(result_error("unit", "x + (1 - x) * (1 - y)^5") == "");
    CHECK(result_error("float in [0, 0.25]", "x * (1 - x)") == "");
    CHECK(result_error("float in [0, 0.2499]", "x * (1 - x)") == "E0507");
    CHECK(result_error("float in [0, 2]", "lerp(1, smoothstep(0, x, y), 2 * x - 1)") == "");
    CHECK(result_error("unit", "0.3 + 0.7 * x") == "");
    CHECK(result_error("float in [-1, 1]", "sin(x) * cos(y)") == "");
    CHECK(result_error("unit", "sin(x)^2 + cos(x)^2 - 0.1") == "");
    CHECK(result_error("color", "c * 3", "c: color") == "");
    CHECK(result_error("color in [0, 2]", "c * 3", "c: color") == "E0507");
}

TEST_CASE("what is true but not proved says so", "[check][ranges]")
{
    // Next to x = y = 0 no box is small enough.
    const auto checked = check_text("/// f\nterm f(x: unit, y: unit) -> unit = x / (x + y) else 0");
    CHECK(checked.errors() == "E0507");
    CHECK(checked.diagnostics.all()[0].message ==
          "the result of `f` is not proved to stay in its declared range");
}

TEST_CASE("arguments stay in the called term's ranges", "[check][ranges]")
{
    const auto errors = [](const std::string& call) {
        return check_text("/// g\nterm g(a: unit, b: float in [0.5, 4], c: color) -> unit = a\n"
                          "/// f\nterm f(x: unit, y: unit, d: color) = " +
                          call)
            .errors();
    };
    CHECK(errors("g(x, 1 + y, d)") == "");
    CHECK(errors("g(x * y, 4, x)") == "");
    CHECK(errors("g(2 * x, 1, d)") == "E0506");
    CHECK(errors("g(x, y, d)") == "E0506");
    CHECK(errors("g(x, 1, d + d)") == "E0506");
    CHECK(errors("g(x + 1, x, d * 2)") == "E0506 E0506 E0506");
    // What a callee promises is known to its caller.
    CHECK(errors("g(g(x, 1, d), 1 + g(y, 1, d), d)") == "");
    CHECK(errors("if y > 0.5 then g(x, y, d) else 0") == "");
}

TEST_CASE("a result keeps what its callee was proved to keep", "[check][ranges]")
{
    // Inlined, the range of the callee's body alone would not do.
    CHECK(check_text(R"(
/// A parabola.
term hill(x: unit) -> float in [0, 0.25] = x * (1 - x)
/// Needs all of that promise.
term f(x: unit, y: unit) -> float = sqrt(0.5 - hill(x) - hill(y))
)")
              .errors() == "");
}

TEST_CASE("without a declared range one is inferred", "[check][ranges]")
{
    const auto range = [](const std::string& body, const std::string& arguments) {
        return check_text("/// f\nterm f(" + arguments + ") = " + body).function("f").range;
    };
    CHECK(range("2 * (1 - x)", "x: unit") == ir::Range{0, 2});
    CHECK(range("f0 + (1 - f0) * (1 - x)^5", "f0: color, x: unit") == ir::Range{0, 1});
    CHECK(range("x", "x: float") == ir::Range{-HUGE_VAL, HUGE_VAL});
    CHECK(range("x^2", "x: float") == ir::Range{0, HUGE_VAL});
    CHECK(range("x > 0.5", "x: unit") == ir::Range{0, 1});
    // An inferred range holds; it need not be the least.
    const ir::Range hill = range("x * (1 - x)", "x: unit");
    CHECK(hill.low == 0);
    CHECK(hill.high >= 0.25);
}

TEST_CASE("limits that are never used are pointed out", "[check][ranges]")
{
    const auto warnings = [](const std::string& body) {
        return check_text("/// f\nterm f(x: unit, y: unit) = " + body).warnings();
    };
    CHECK(warnings("1 / x else 0") == "");
    CHECK(warnings("1 / (1 + x) else 0") == "W0501");
    // Between 0 and 2^-64 the limit is what counts.
    CHECK(warnings("if x > 0 then (1 / x else 0) else y") == "");
    CHECK(warnings("if x > 1e-19 then (1 / x else 0) else y") == "W0501");
    CHECK(warnings("1 / (x * x - x + 0.5) else 0") == "W0501");
}

TEST_CASE("a box proof finds what intervals alone do not", "[check][boxes]")
{
    const auto checked = check_text("/// f\nterm f(x: unit, y: unit) = x * (1 - x) + y * (1 - y)");
    const ir::Function& function = checked.function("f");
    const auto proves = [&](check::Requirement wanted) {
        const check::Flat flat =
            check::flatten({}, function, {&function.result, 1}, {}, check::Calls::taken_in);
        check::Effort effort;
        return check::BoxProof{flat, {wanted}, 0x1p-40, effort}.prove();
    };
    CHECK(proves({.low = 0, .high = 0.5}));
    CHECK(proves({.low = 0, .high = 0.501}));
    CHECK(!proves({.low = 0, .high = 0.499}));
    CHECK(!proves({.nonzero = true}));
    CHECK(!proves({.low = 0, .low_open = true}));
    CHECK(proves({.low = -0.001, .low_open = true}));
}
