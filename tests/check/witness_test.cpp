// Counterexamples are true: evaluated, they break the claim, and on real vectors where they say so.
#include "check/checking.h"
#include "check/witness.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::check;
using lobe::tests::check_text;

namespace {

std::optional<Witness> hunt(const std::string& term, const Requirement& claim)
{
    const auto checked = check_text("/// f\n" + term);
    CAPTURE(term, checked.errors());
    const ir::Function& function = checked.function("f");
    Search search;
    search.flat = flatten({}, function, {&function.result, 1}, {}, Calls::taken_in);
    search.claims = {claim};
    return find_witness(search);
}

constexpr Requirement nonzero{.nonzero = true};

}  // namespace

TEST_CASE("simple inputs are found first", "[check][witness]")
{
    CHECK(hunt("term f(g: geometry) = g.cos_i", nonzero)->point ==
          "l = (1, 0, 0), v = (0, 0, 1), n = (0, 0, 1)");
    CHECK(hunt("term f(x: unit, y: unit) = x * y", nonzero)->point == "x = 0, y = 0");
    CHECK(hunt("term f(x: unit) = x^2", {.low = 0, .high = 0.5})->point == "x = 1");
    CHECK(hunt("term f(c: color) = c.g", {.low = 0, .high = 0.5})->point == "c = (1, 1, 1)");
}

TEST_CASE("a change of sign is closed in on", "[check][witness]")
{
    const auto pole = hunt("term f(x: unit) = 7 * x - 2", nonzero);
    REQUIRE(pole);
    CHECK(pole->point == "x = 0.285714");
    // Of the order of the rounding of 7 x - 2.
    CHECK(std::abs(pole->values[0]) < 1e-14);
    // A jump across 0 is no zero.
    CHECK(!hunt("term f(x: unit) = if x > 0.3 then 1 else -1", nonzero));
    // On directions as on numbers.
    const auto cosine = hunt("term f(g: geometry) = dot(g.n, g.l) - 0.3", nonzero);
    REQUIRE(cosine);
    CHECK(cosine->on_vectors);
}

TEST_CASE("cosines that no vectors have are told apart", "[check][witness]")
{
    // The mean of both cosines is at most cos_d, and so is their product.
    const auto impossible =
        hunt("term f(g: geometry) = g.cos_i * g.cos_o - g.cos_d", {.high = 0.5});
    REQUIRE(impossible);
    CHECK(!impossible->on_vectors);
    CHECK(impossible->point.find("cos_d = 0") != std::string::npos);
    const auto possible = hunt("term f(g: geometry) = g.cos_i + g.cos_o", {.high = 1.5});
    REQUIRE(possible);
    CHECK(possible->on_vectors);
}

TEST_CASE("nothing is found where there is nothing", "[check][witness]")
{
    CHECK(!hunt("term f(x: unit) = x + 0.01", nonzero));
    CHECK(!hunt("term f(x: unit, y: unit) = x * y", {.low = 0, .high = 1}));
    CHECK(!hunt("term f(g: geometry) = g.v_dot_l", {.low = -1, .high = 1}));
    // Rounding is no counterexample.
    CHECK(!hunt("term f(x: float in [0, 10]) = x * 0.1 * 0.1 * 100", {.low = 0, .high = 10}));
}
