// Literals in every kind of number, and what a Real is written as.
#include "evaluate/bounds.h"
#include "evaluate/half.h"
#include "evaluate/literals.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using namespace lobe::evaluate;

namespace {

ir::Literal literal(std::string_view text)
{
    ir::Graph graph;
    return graph.literal_of(graph.literal(text));
}

}  // namespace

TEST_CASE("a literal is the nearest number of each kind")
{
    CHECK(to_float(literal("0.1")) == 0.1F);
    CHECK(to_double(literal("0.1")) == 0.1);
    CHECK(to_float(literal("pi")) == 3.14159265F);
    // Halfway between two floats but for the last digit: rounding to double first would lose it.
    CHECK(to_float(literal("1.00000005960464477539062500000000000001")) == 0x1.000002p0F);
    CHECK(to_float(literal("1e-60")) == 0);
    CHECK(std::isinf(to_float(literal("1e60"))));
    CHECK(to_half(literal("0.1")) == 0x1.998p-4);
    CHECK(to_half(literal("1.00048828125")) == 1);  // the midpoint of 1 and the next half
    CHECK(to_half(literal("1.000488281250000000000000000000000001")) == 0x1.004p0);
    CHECK(std::isinf(to_half(literal("65520"))));
    CHECK(to_half(literal("65519.99")) == 65504);
}

TEST_CASE("a literal lies between its bounds, tightly")
{
    CHECK(to_interval(literal("0.5")) == Interval{0.5, 0.5});
    const Interval tenth = to_interval(literal("0.1"));
    CHECK(tenth.high == 0.1);  // the double is above one tenth
    CHECK(next_up(tenth.low) == tenth.high);
    const Interval pi = to_interval(literal("pi"));
    CHECK(pi.low == 3.141592653589793);
    CHECK(next_up(pi.low) == pi.high);
    // Short ones are bounded without big numbers, long ones with them: the same bounds.
    for (const char* text :
         {"0.1", "-0.1", "0.3", "-2.2", "1e-7", "1e-22", "1e-23", "123456.789012345",
          "0.1234567890123456", "1e23", "-9.999999999999e-10"}) {
        CAPTURE(text);
        const Interval bounds = to_interval(literal(text));
        constexpr int bits = 400;  // more than the 22 digits of the least double here need
        const Real exact = to_real(literal(text), bits);
        CHECK(mpfr_cmp_d(exact.get(), bounds.low) > 0);
        CHECK(mpfr_cmp_d(exact.get(), bounds.high) < 0);
        CHECK(next_up(bounds.low) == bounds.high);
    }
}

TEST_CASE("a real number is written so that it reads back exactly")
{
    for (const int bits : {53, 113, 200})
        for (const char* text : {"1", "-0.1", "1e-40", "123456789.125", "2.5e300", "0"}) {
            const Real number{std::string_view{text}, bits};
            const Real again{std::string_view{number.text()}, bits};
            INFO(number.text());
            CHECK(mpfr_equal_p(number.get(), again.get()) != 0);
        }
    CHECK(Real{0.25, 53}.text() == "2.5e-1");
    CHECK(Real{1.5, 53}.text() == "1.5");
    CHECK(Real{100.0, 53}.text() == "1e2");
    CHECK(Real{-INFINITY, 53}.text() == "-inf");
    const Real word{std::string_view{"one"}, 53};
    CHECK(mpfr_nan_p(word.get()) != 0);
}

TEST_CASE("real numbers are values")
{
    Real a{0.5, 200};
    Real b = a;
    b = Real{0.25, 60};
    CHECK(a.to_double() == 0.5);
    CHECK(b.bits() == 60);
    a = b;
    CHECK(a.bits() == 60);
    CHECK(a.to_double() == 0.25);
    const Real moved = std::move(b);
    CHECK(moved.to_double() == 0.25);
}

TEST_CASE("every half rounds to itself, and every midpoint to the even one")
{
    for (std::uint32_t code = 0; code < 0x7c00; ++code) {
        // Exponent and significand of the code, as the format defines them.
        const int exponent = static_cast<int>(code >> 10);
        const double significand = (exponent == 0 ? 0 : 1024) + (code & 0x3ff);
        const double half = std::ldexp(significand, (exponent == 0 ? 1 : exponent) - 25);
        const double next = std::ldexp(significand + 1, (exponent == 0 ? 1 : exponent) - 25);
        REQUIRE(round_to_half(half, HalfMode::keep_denormals) == half);
        REQUIRE(round_to_half(-half, HalfMode::keep_denormals) == -half);
        const double middle = (half + next) / 2;
        const double even = (code & 1) == 0 ? half : next;
        const double expected = even < 65536 ? even : HUGE_VAL;
        REQUIRE(round_to_half(middle, HalfMode::keep_denormals) == expected);
        const double flushed = half < 0x1p-14 ? 0 : half;
        REQUIRE(round_to_half(half, HalfMode::flush_denormals) == flushed);
    }
}
