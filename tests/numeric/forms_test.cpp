// A form differs from its term by what its documentation says: no more, and not much less.
#include "numeric/library.h"
#include "numeric/points.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

namespace lobe::tests {
namespace {

/// Every combination of values for the named columns.
Points grid(const std::vector<std::pair<std::string, std::vector<double>>>& axes)
{
    Points points{{}};
    points.clear();
    std::size_t count = 1;
    for (const auto& [name, values] : axes) count *= values.size();
    std::size_t repeat = 1;
    for (const auto& [name, values] : axes) {
        std::vector<double> column(count);
        for (std::size_t i = 0; i < count; ++i) column[i] = values[i / repeat % values.size()];
        repeat *= values.size();
        points.emplace_back(name, std::move(column));
    }
    return points;
}

std::vector<double> steps(double low, double high, int count)
{
    std::vector<double> values;
    for (int i = 0; i <= count; ++i) values.push_back(low + (high - low) * i / count);
    return values;
}

std::vector<double> squares(std::vector<double> values)
{
    for (double& value : values) value *= value;
    return values;
}

const std::vector<double>& column(const Points& points, const std::string& name)
{
    const auto found = std::ranges::find(points, name, &Points::value_type::first);
    REQUIRE(found != points.end());
    return found->second;
}

/// The greatest difference of a form from its definition, over the reals up to the rounding of
/// doubles, each point weighted.
double greatest(const std::string& module, const std::string& term, const std::string& form,
                const Points& points, const std::function<double(std::size_t)>& weight = {})
{
    const auto exact = run<double>(definition(module), term, points);
    const auto other = run<double>(definition(module), term + "_" + form, points);
    REQUIRE(exact.size() == other.size());
    double result = 0;
    for (std::size_t channel = 0; channel < exact.size(); ++channel)
        for (std::size_t i = 0; i < exact[channel].size(); ++i) {
            const double off = std::abs(exact[channel][i] - other[channel][i]);
            REQUIRE(std::isfinite(off));
            result = std::max(result, off * (weight ? weight(i) : 1.0));
        }
    return result;
}

/// Documented figures are rounded up to two digits: a tenth is the most that is lost.
void check_stated(double off, double stated)
{
    CHECK(off <= stated);
    CHECK(off >= 0.9 * stated);
}

const std::vector<double> roughnesses = steps(1.0 / 64, 1, 63);

/// alpha and both cosines, closer near grazing: 0 itself is in.
Points visibility_points()
{
    return grid({{"alpha", squares(roughnesses)},
                 {"cos_i", squares(steps(0, 1, 80))},
                 {"cos_o", squares(steps(0, 1, 80))}});
}

// What rounding alone may leave between equal formulas: a few operations of values up to 1.
constexpr double rounding = 16 * 0x1p-53;

}  // namespace

TEST_CASE("forms of V change G by what they say")
{
    const Points points = visibility_points();
    const auto& cos_i = column(points, "cos_i");
    const auto& cos_o = column(points, "cos_o");
    const auto g = [&](const std::string& term, const std::string& form) {
        return greatest("microfacet", term, form, points,
                        [&](std::size_t i) { return 4 * cos_i[i] * cos_o[i]; });
    };
    check_stated(g("V_SmithGGX", "correlated"), 0.091);
    check_stated(g("V_SmithGGX", "joint_approximation"), 0.23);
    check_stated(g("V_SmithGGX", "schlick"), 0.28);
    check_stated(g("V_SmithGGXCorrelated", "separable"), 0.091);
    check_stated(g("V_SmithGGXCorrelated", "joint_approximation"), 0.24);
    check_stated(g("V_SmithGGXCorrelated", "schlick"), 0.28);
    check_stated(g("V_SmithJointApprox", "schlick"), 0.091);
}

TEST_CASE("Schlick's V is the separable one at alpha = 1")
{
    const Points points =
        grid({{"alpha", {1}}, {"cos_i", steps(0, 1, 50)}, {"cos_o", steps(0, 1, 50)}});
    CHECK(greatest("microfacet", "V_SmithGGX", "schlick", points) <= rounding);
}

TEST_CASE("the order of the Smith terms is as stated")
{
    // Both cosines 0 aside, where one of them names a limit.
    const Points points = grid({{"alpha", squares(roughnesses)},
                                {"cos_i", squares(steps(0.01, 1, 60))},
                                {"cos_o", squares(steps(0.01, 1, 60))}});
    const auto separable = run<double>(definition("microfacet"), "V_SmithGGX", points)[0];
    const auto correlated =
        run<double>(definition("microfacet"), "V_SmithGGXCorrelated", points)[0];
    for (std::size_t i = 0; i < separable.size(); ++i)
        REQUIRE(separable[i] <= correlated[i] * (1 + rounding));
}

TEST_CASE("the clamped D is D where that is below its bound")
{
    const Points points = grid({{"alpha", squares(roughnesses)}, {"cos_h", steps(0, 1, 200)}});
    const auto exact = run<double>(definition("microfacet"), "D_GGX", points)[0];
    const auto clamped = run<double>(definition("microfacet"), "D_GGX_clamped", points)[0];
    constexpr double pi = 3.141592653589793;
    std::size_t cut = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double expected = std::min(exact[i], 2048 / pi);
        // 1 - cos_h^2 cancels: up to an ulp of 1 against alpha^2, twice, for D's square.
        const double alpha = points[0].second[i];
        REQUIRE(std::abs(clamped[i] - expected) <=
                expected * (rounding + 8 * 0x1p-53 / (alpha * alpha)));
        if (exact[i] > 2048 / pi) {
            ++cut;
            REQUIRE(alpha < 0.0221);
        }
    }
    CHECK(cut > 0);
}

TEST_CASE("approximations of the dielectric Fresnel are off by what they say")
{
    const auto at = [](double f0, const std::string& form) {
        const Points points = grid({{"f0", {f0}}, {"cos_d", steps(0, 1, 2000)}});
        const double one = greatest("microfacet", "F_dielectric", form, points);
        // The color is the same per channel.
        CHECK(greatest("microfacet", "F_CookTorrance", form, points) == Approx(one).epsilon(1e-12));
        return one;
    };
    check_stated(at(0.04, "schlick"), 0.036);
    check_stated(at(0.04, "spherical_gaussian"), 0.039);
    check_stated(at(0.5, "schlick"), 0.3);
    CHECK(at(0, "schlick") == 1);
}

TEST_CASE("the spherical Gaussian is off by what it says")
{
    const Points points = grid({{"f0", {0, 0.04, 0.5, 1}}, {"cos_d", steps(0, 1, 5000)}});
    check_stated(greatest("microfacet", "F_Schlick", "spherical_gaussian", points), 3.8e-3);
    check_stated(greatest("ue4", "F_Schlick_occluded", "spherical_gaussian", points), 3.8e-3);

    const auto callisto = [](double low, double high, const std::string& form) {
        return greatest("callisto", "F_Callisto", form,
                        grid({{"f0", {0, 0.04, 1}},
                              {"cos_d", steps(0, 1, 500)},
                              {"specular_fresnel_falloff", steps(low, high, 50)}}));
    };
    check_stated(callisto(0, 0.5, "spherical_gaussian"), 3.8e-3);
    CHECK(callisto(0.9, 1, "spherical_gaussian") > 0.1);
    CHECK(callisto(0.5, 0.5, "schlick") <= rounding);
}

TEST_CASE("Callisto's forms are exact where they say so")
{
    const std::vector<double> cosines = steps(0, 1, 100);
    const auto blend = [&](double exponent_scale, const std::string& form) {
        return greatest("callisto", "blend_weight", form,
                        grid({{"cos_theta", cosines},
                              {"cos_phi", cosines},
                              {"n", {exponent_scale}},
                              {"m", {exponent_scale}}}));
    };
    CHECK(blend(0.5, "constant_exponents") <= rounding);
    CHECK(blend(1, "fifth_power") <= rounding);
    CHECK(blend(1, "constant_exponents") > 0.1);

    const Points lobes = with(material_points(4000, 11), "dual_specular_opacity", 0);
    CHECK(greatest("callisto", "dual_ggx", "single", lobes) == 0);
    CHECK(greatest("callisto", "dual_ggx", "single",
                   with(material_points(4000, 11), "dual_specular_opacity", 1)) > 0);

    // Largest where all facets face an eye beside the light.
    const Points rough = grid({{"alpha", {1}},
                               {"cos_i", steps(0, 1, 100)},
                               {"cos_o", {0.5}},
                               {"v_dot_l", {0, 0.5, 1}},
                               {"diffuse_color", {1}}});
    constexpr double pi = 3.141592653589793;
    check_stated(greatest("callisto", "proxima_cos", "lambert", rough), 0.36 / pi + rounding);
}

TEST_CASE("diffuse forms are Lambert's")
{
    const Points burley = grid({{"diffuse_color", {1}},
                                {"roughness", {1.0 / 64, 0.5, 1}},
                                {"cos_i", steps(0, 1, 40)},
                                {"cos_o", steps(0, 1, 40)},
                                {"cos_d", {0, 0.5, 1}}});
    constexpr double pi = 3.141592653589793;
    const auto factors = run<double>(definition("microfacet"), "Diffuse_Burley", burley)[0];
    const auto [low, high] = std::ranges::minmax(factors);
    CHECK(low * pi >= 0.25);
    CHECK(low * pi == Approx(0.25).epsilon(0.1));
    CHECK(high * pi <= 6.25 + rounding);
    CHECK(high * pi == Approx(6.25).epsilon(1e-12));

    const Points smooth = with(material_points(4000, 12), "sigma", 0);
    CHECK(greatest("microfacet", "Diffuse_OrenNayar", "lambert", smooth) == 0);
}

TEST_CASE("the fits of the environment are off by what they say")
{
    const Points points = grid({{"roughness", roughnesses}, {"cos_o", steps(0, 1, 50)}});
    check_stated(greatest("environment", "EnvBRDF_scale", "analytic_fit", points), 0.19);
    check_stated(greatest("environment", "EnvBRDF_bias", "analytic_fit", points), 0.2);
}

}  // namespace lobe::tests
