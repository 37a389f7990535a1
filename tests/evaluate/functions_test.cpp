// The elementary functions against MPFR, in units in the last place. The bounds are the ones that
// docs/numerics.md states and evaluate/intervals.cpp relies on.
#include "evaluate/fixture.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace lobe;
using namespace lobe::tests;
using ir::Op;

namespace {

/// Distance of `got` from the true value, in units in the last place of the true value; 0 where
/// both overflow or vanish.
template <class Number>
double error_in_units(Number got, const evaluate::Real& truth)
{
    constexpr int digits = std::numeric_limits<Number>::digits;
    constexpr int least = std::numeric_limits<Number>::min_exponent;
    const auto wide = static_cast<double>(got);
    if (std::isnan(wide)) return mpfr_nan_p(truth.get()) != 0 ? 0 : HUGE_VAL;
    if (std::isinf(wide)) {
        // Right if the truth rounds to it.
        return mpfr_cmp_d(truth.get(), static_cast<double>(std::numeric_limits<Number>::max())) >
                           0 ||
                       mpfr_cmp_d(truth.get(),
                                  -static_cast<double>(std::numeric_limits<Number>::max())) < 0
                   ? 0
                   : HUGE_VAL;
    }
    if (mpfr_zero_p(truth.get()) != 0) return wide == 0 ? 0 : HUGE_VAL;
    evaluate::Real difference{truth.bits()};
    mpfr_sub_d(difference.get(), truth.get(), wide, MPFR_RNDN);
    const long exponent = std::max<long>(mpfr_get_exp(truth.get()), least);
    mpfr_mul_2si(difference.get(), difference.get(), digits - exponent, MPFR_RNDN);
    return std::abs(difference.to_double());
}

struct Worst {
    double units = 0;
    double at = 0;
};

/// The worst error of a function of one operand over random points of [low, high], half of them
/// spread evenly and half over the binades.
template <class Number>
Worst worst_error(Op op, double low, double high, int count)
{
    std::mt19937_64 random{20240607};
    std::uniform_real_distribution<double> even{low, high};
    const double least = low > 0 ? low : 1e-30;
    std::uniform_real_distribution<double> binade{std::log2(least),
                                                  std::log2(std::max(std::abs(high), least * 2))};
    Table<double> points;
    for (int i = 0; i < count; ++i) {
        double x = i % 2 == 0 ? even(random) : std::exp2(binade(random));
        if (i % 4 == 3 && low < 0) x = -x;
        points.push_back({static_cast<double>(static_cast<Number>(std::clamp(x, low, high)))});
    }
    const ir::Module module = module_of(op, 1);
    const evaluate::Tape tape = evaluate::compile(module, module.functions[0]);
    const auto truth = evaluate_real(tape, 160, points);
    Worst worst;
    const auto compare = [&](const auto& results) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double units = error_in_units(results[i][0], truth[i][0]);
            if (!(units <= worst.units)) worst = {units, points[i][0]};
        }
    };
    if constexpr (std::is_same_v<Number, float>) {
        Table<float> narrow;
        for (const auto& point : points) narrow.push_back({static_cast<float>(point[0])});
        compare(evaluate_float(tape, narrow));
    } else {
        compare(evaluate_double(tape, points));
    }
    return worst;
}

struct Claim {
    Op op;
    double low;
    double high;
    double float_units;
    double double_units;
};

// ORDER docs/numerics.md, "The functions of float and double"
const Claim claims[] = {
    {Op::exp2, -149, 127.99, 1.25, 1.5}, {Op::log2, 1e-44, 3e38, 1.6, 1},
    {Op::log2, 0.5, 2, 1.6, 1},          {Op::exp, -87, 88.7, 0.51, 1.5},
    {Op::log, 1e-44, 3e38, 0.51, 1},     {Op::log, 0.5, 2, 0.51, 1},
    {Op::sine, -1e6, 1e6, 0.51, 1},      {Op::cosine, -1e6, 1e6, 0.51, 1},
    {Op::sine, -4, 4, 0.51, 1},          {Op::cosine, -4, 4, 0.51, 1},
    {Op::tangent, -4, 4, 0.51, 2.5},     {Op::arc_sine, -1, 1, 0.51, 1},
    {Op::arc_cosine, -1, 1, 0.51, 1.25}, {Op::arc_tangent, -1e6, 1e6, 0.51, 2},
    {Op::arc_tangent, -4, 4, 0.51, 2},
};

}  // namespace

TEST_CASE("the elementary functions are as accurate as the documentation says")
{
    for (const Claim& claim : claims) {
        const Worst narrow = worst_error<float>(claim.op, claim.low, claim.high, 40000);
        const Worst wide = worst_error<double>(claim.op, claim.low, claim.high, 40000);
        INFO(name(claim.op) << " on [" << claim.low << ", " << claim.high << "]: float "
                            << narrow.units << " at " << narrow.at << ", double " << wide.units
                            << " at " << wide.at);
        CHECK(narrow.units <= claim.float_units);
        CHECK(wide.units <= claim.double_units);
    }
}

TEST_CASE("a power is accurate where its exponent is large")
{
    std::mt19937_64 random{7};
    std::uniform_real_distribution<double> base{0x1p-14, 1};
    std::uniform_real_distribution<double> size{-4, 12};
    Table<double> points{{0.9, 3948}, {1 - 0x1p-24, 4000}, {0x1p-14, 70}, {1 + 0x1p-20, 1e6}};
    for (int i = 0; i < 20000; ++i)
        points.push_back({static_cast<double>(static_cast<float>(base(random))),
                          static_cast<double>(static_cast<float>(std::exp2(size(random))))});
    const ir::Module module = module_of(Op::power, 2);
    const evaluate::Tape tape = evaluate::compile(module, module.functions[0]);
    const auto truth = evaluate_real(tape, 160, points);
    const auto wide = evaluate_double(tape, points);
    Table<float> narrow_points;
    for (const auto& point : points)
        narrow_points.push_back({static_cast<float>(point[0]), static_cast<float>(point[1])});
    const auto narrow = evaluate_float(tape, narrow_points);

    double worst_wide = 0;
    double worst_narrow = 0;  // over what is allowed
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (truth[i][0].to_double() < 0x1p-1000) continue;
        const double exponent = points[i][1] * std::log2(points[i][0]);
        // log2 in two doubles is off by 2^-55 of itself, which 2^e turns into 2^-55 ln 2 |e|.
        const double allowed_wide = 2 + std::abs(exponent) * std::log(2.0) / 4;
        worst_wide = std::max(worst_wide, error_in_units(wide[i][0], truth[i][0]) / allowed_wide);
        if (exponent < -120 || points[i][0] == 0.9) continue;  // 0.9 is not the float
        // log2 is off by 1.6 units and the product by half of one, each 2^-23 relative at most;
        // 2^e turns an error d of e into d ln 2, that is 2 ln 2 units of 2^-24 for each.
        const double allowed = 1.25 + std::abs(exponent) * 2.1 * 2 * std::log(2.0);
        worst_narrow = std::max(worst_narrow, error_in_units(narrow[i][0], truth[i][0]) / allowed);
    }
    CHECK(worst_wide <= 1);
    CHECK(worst_narrow <= 1);
    CAPTURE(worst_wide, worst_narrow);
    CHECK(std::abs(wide[0][0] / truth[0][0].to_double() - 1) < 1e-14);
}
