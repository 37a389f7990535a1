// The nearest polynomials and ratios against what theory says of them: known errors, and the
// alternation of signs that no better fit could have.
#include "analyze/minimax/fit.h"
#include "analyze/minimax/form.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace lobe::analyze;

namespace {

/// A function over [0, 1] or its square, on a lattice like a surface's.
Samples sampled(std::size_t width, std::size_t height,
                const std::function<double(double, double)>& f)
{
    const auto line = [](std::size_t i, std::size_t count) {
        if (count == 1) return 0.0;
        const double t = static_cast<double>(i) / static_cast<double>(count - 1);
        return t * t * (3 - 2 * t);
    };
    Samples samples;
    samples.width = width;
    samples.height = height;
    for (std::size_t j = 0; j < height; ++j)
        for (std::size_t i = 0; i < width; ++i) {
            const Place at{line(i, width), line(j, height)};
            samples.places.push_back(at);
            samples.values.push_back(f(at.x, at.y));
        }
    return samples;
}

Samples sampled(const std::function<double(double)>& f)
{
    return sampled(1025, 1, [&](double x, double) { return f(x); });
}

const Shape& shape(std::size_t inputs, const std::string& name)
{
    static const std::vector<NamedShape> all[] = {shapes(1, 6), shapes(2, 6)};
    const auto& of = all[inputs - 1];
    return std::ranges::find(of, "minimax_" + name, &NamedShape::name)->shape;
}

/// Extremes of alternating sign of the difference, none smaller than `least`.
int alternations(const Samples& samples, const Shape& of, const Ratio& ratio, double least)
{
    int count = 0;
    int sign = 0;
    for (std::size_t i = 0; i < samples.places.size(); ++i) {
        const double difference = samples.values[i] - value_at(of, ratio, samples.places[i]);
        if (std::fabs(difference) < least) continue;
        const int here = difference < 0 ? -1 : 1;
        if (here != sign) ++count;
        sign = here;
    }
    return count;
}

// An exchange ends where no place is worse than those that were seen by more than this, and a
// program's own tolerance is far below it.
constexpr double exchange = 1.1e-3;

}  // namespace

TEST_CASE("x^5 by a quartic errs by 2^-9, as Chebyshev says", "[fit]")
{
    // x^n less its best polynomial of degree n - 1 over [0, 1] is 2^(1 - 2n) T_n(2x - 1).
    const auto fit = best_fit(shape(1, "4"), sampled([](double x) { return x * x * x * x * x; }));
    REQUIRE(fit);
    CHECK(fit->level == Approx(0x1p-9).epsilon(exchange));
}

TEST_CASE("differences alternate as often as the best fit's do", "[fit]")
{
    // [Cheney66]: a fit is best, in one variable, if its difference takes its greatest size n + m +
    // 2 times with alternating sign. By de la Vallee Poussin no fit is better than the least of
    // them.
    const auto [name, times] = GENERATE(std::pair{"2", 4}, std::pair{"3", 5}, std::pair{"5", 7},
                                        std::pair{"1_1", 4}, std::pair{"2_2", 6});
    CAPTURE(name);
    const Samples samples = sampled([](double x) { return std::exp2(x); });
    const Shape& of = shape(1, name);
    const auto fit = best_fit(of, samples);
    REQUIRE(fit);
    CHECK(alternations(samples, of, fit->ratio, fit->level * (1 - 2 * exchange)) >= times);
}

TEST_CASE("what a shape can say exactly is found", "[fit]")
{
    SECTION("a ratio")
    {
        const auto fit =
            best_fit(shape(1, "1_1"), sampled([](double x) { return (1 + x) / (1 + 8 * x); }));
        REQUIRE(fit);
        CHECK(fit->level <= 0x1p-46 * 1.1);
    }
    SECTION("a polynomial in two variables")
    {
        const Shape& of = shape(2, "2");
        const auto fit = best_fit(of, sampled(129, 129, [](double x, double y) {
                                      return 1 + 2 * x - 3 * x * y + y * y;
                                  }));
        REQUIRE(fit);
        CHECK(fit->level <= 0x1p-46 * 3);
    }
}

TEST_CASE("in two variables the best error is met too", "[fit]")
{
    // f(0,0) - f(1,0) - f(0,1) + f(1,1) is 1 for xy and 0 for x^2, y^2 and everything below, so the
    // corners share an error of 1 at the least: a quarter each. (x - 1/2)(y - 1/2) attains it.
    Shape without_product = shape(2, "2");
    std::erase(without_product.numerator, Powers{1, 1});
    const auto fit =
        best_fit(without_product, sampled(129, 129, [](double x, double y) { return x * y; }));
    REQUIRE(fit);
    CHECK(fit->level == Approx(0.25).epsilon(exchange));
}

TEST_CASE("a jump costs half of it", "[fit]")
{
    const auto fit = best_fit(shape(1, "6"), sampled([](double x) { return x < 0.3 ? 0.0 : 1.0; }));
    REQUIRE(fit);
    CHECK(fit->level < 0.5);
    CHECK(fit->level > 0.49);
}

TEST_CASE("rounded coefficients are floats and cost what rounding must", "[fit]")
{
    const std::string name = GENERATE("3", "4", "6", "2_2");
    CAPTURE(name);
    const Samples samples = sampled([](double x) { return std::exp2(x); });
    const Shape& of = shape(1, name);
    const auto fit = best_fit(of, samples);
    REQUIRE(fit);
    const Fit rounded = round_to_float(of, samples, *fit);

    // Half a unit in the last place of every coefficient, through p / q with q >= least_denominator
    // and |p / q| <= 2 + error.
    double budget = 0;
    for (const double c : rounded.ratio.numerator) budget += std::fabs(c) * 0x1p-24;
    for (const double c : rounded.ratio.denominator) budget += 3 * std::fabs(c) * 0x1p-24;
    budget /= least_denominator;
    CHECK(rounded.level >= fit->level * (1 - exchange));
    CHECK(rounded.level <= fit->level * (1 + exchange) + budget);

    double measured = 0;
    for (std::size_t i = 0; i < samples.places.size(); ++i)
        measured = std::fmax(measured, std::fabs(samples.values[i] -
                                                 value_at(of, rounded.ratio, samples.places[i])));
    CHECK(rounded.level == Approx(measured).epsilon(1e-9));
    for (const auto* part : {&rounded.ratio.numerator, &rounded.ratio.denominator})
        for (const double c : *part) CHECK(c == static_cast<double>(static_cast<float>(c)));
}

TEST_CASE("rounding one by one is better than all at once where digits are short", "[fit]")
{
    // Degree 5 errs by 1.07e-7 over [0, 1], not much above half a unit of coefficients near 1.
    const Samples samples = sampled([](double x) { return std::exp2(x); });
    const Shape& of = shape(1, "5");
    const auto fit = best_fit(of, samples);
    REQUIRE(fit);
    Ratio at_once = fit->ratio;
    for (double& c : at_once.numerator) c = static_cast<double>(static_cast<float>(c));
    double naive = 0;
    for (std::size_t i = 0; i < samples.places.size(); ++i)
        naive = std::fmax(naive,
                          std::fabs(samples.values[i] - value_at(of, at_once, samples.places[i])));
    CHECK(round_to_float(of, samples, *fit).level < naive);
}
