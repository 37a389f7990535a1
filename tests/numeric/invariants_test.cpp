// What is true of the models everywhere, tried at random points: bounds, limits, symmetries.
//
// Bounds are over the real numbers. `slack` is what the roundings of a double evaluation add: every
// factor here is a handful of operations of one rounding each, and a power of one ulp, so 32 ulps
// of the result bound them.
#include "numeric/library.h"
#include "numeric/points.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

namespace lobe::tests {
namespace {

constexpr double slack = 32 * 0x1p-52;
constexpr double pi = 3.14159265358979323846;
constexpr std::size_t count = 20000;

const std::vector<double>& column(const Points& points, const std::string& name)
{
    for (const auto& [known, values] : points)
        if (known == name) return values;
    throw std::logic_error(name);
}

std::vector<double> one(const std::string& model, const std::string& term, const Points& points)
{
    return run<double>(optimized(model), term, points).front();
}

Points falloffs(Points points, std::uint32_t seed)
{
    for (const char* name : {"diffuse_fresnel_falloff", "diffuse_fresnel_tangent_falloff",
                             "retroreflection_falloff", "retroreflection_tangent_falloff"})
        points = with(std::move(points), name, 0, 1, seed++);
    return points;
}

Points swapped(Points points)
{
    for (auto& [name, values] : points)
        if (name.size() == 3 && name[1] == '.' && (name[0] == 'l' || name[0] == 'v'))
            name[0] = name[0] == 'l' ? 'v' : 'l';
    return points;
}

}  // namespace

TEST_CASE("blend weights stay in [0, 1]")
{
    const Points points = falloffs(geometry_points(count, 10), 20);
    for (const char* term : {"alpha_f", "alpha_r", "alpha_s"})
        for (const double weight : one("callisto", term, points)) {
            REQUIRE(weight >= 0);
            REQUIRE(weight <= 1 + slack);
        }
}

TEST_CASE("c1 lies between the products of the gains below and above 1")
{
    Points points = falloffs(geometry_points(count, 30), 40);
    points = with(std::move(points), "diffuse_fresnel", 0, 4, 50);
    points = with(std::move(points), "retroreflection", 0, 256, 51);
    const auto c1 = one("callisto", "c1", points);
    const auto& f = column(points, "diffuse_fresnel");
    const auto& r = column(points, "retroreflection");
    for (std::size_t i = 0; i < count; ++i) {
        REQUIRE(c1[i] >= std::min(1.0, f[i]) * std::min(1.0, r[i]) - slack);
        REQUIRE(c1[i] <= std::max(1.0, f[i]) * std::max(1.0, r[i]) * (1 + slack));
    }
}

TEST_CASE("c1 is 1 for gains of 1 whatever the falloffs")
{
    for (const double value : one("callisto", "c1", falloffs(geometry_points(count, 60), 61)))
        REQUIRE(value == 1.0);
}

TEST_CASE("c1 does not tell light from view")
{
    Points points = falloffs(geometry_points(count, 70), 71);
    points = with(std::move(points), "diffuse_fresnel", 3);
    points = with(std::move(points), "retroreflection", 5);
    const auto forward = one("callisto", "c1", points);
    const auto backward = one("callisto", "c1", swapped(points));
    // l.h and v.h differ by the roundings of h, and where a cosine is tiny its power with a
    // small exponent magnifies them without bound: only the well-conditioned points are compared.
    const auto cos_d =
        run<double>(compiled("module t\nterm c(g: geometry) = g.cos_d"), "c", points);
    const auto cos_h =
        run<double>(compiled("module t\nterm c(g: geometry) = g.cos_h"), "c", points);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (cos_d[0][i] < 0.01 || cos_h[0][i] < 0.01) continue;
        if (cos_d[0][i] > 0.99 || cos_h[0][i] > 0.99) continue;
        ++compared;
        // 10 |dc| / c <= 10 * 2^-50 / 0.01 per power; four of them.
        REQUIRE(std::abs(forward[i] - backward[i]) <= forward[i] * 4000 * 0x1p-50);
    }
    CHECK(compared > count / 4);
}

TEST_CASE("c2 darkens for a positive terminator and brightens for a negative one")
{
    Points points = geometry_points(count, 80);
    points = with(std::move(points), "smooth_terminator", -1, 1, 81);
    points = with(std::move(points), "smooth_terminator_length", 0, 1, 82);
    const auto c2 = one("callisto", "c2", points);
    const auto weight = one("callisto", "alpha_s", points);
    const auto& o = column(points, "smooth_terminator");
    for (std::size_t i = 0; i < count; ++i) {
        const double end = 1 - weight[i] * o[i];
        REQUIRE(c2[i] >= std::min(1.0, end) - slack);
        REQUIRE(c2[i] <= std::max(1.0, end) + slack);
        REQUIRE(c2[i] >= -slack);
        REQUIRE(c2[i] <= 2 + slack);
    }
}

TEST_CASE("c2 is 1 where it is off or past its edge")
{
    const Points points = geometry_points(count, 90);
    const auto weight = one("callisto", "alpha_s", points);
    const auto cos_i =
        run<double>(compiled("module t\nterm c(g: geometry) = g.cos_i"), "c", points);

    for (const double value : one("callisto", "c2", with(points, "smooth_terminator_length", 0.7)))
        REQUIRE(value == 1.0);
    const auto no_length =
        one("callisto", "c2",
            with(with(points, "smooth_terminator", 1), "smooth_terminator_length", 0));
    const auto half =
        one("callisto", "c2",
            with(with(points, "smooth_terminator", 1), "smooth_terminator_length", 0.5));
    for (std::size_t i = 0; i < count; ++i) {
        if (cos_i[0][i] > 0) REQUIRE(no_length[i] == 1.0);
        if (cos_i[0][i] >= weight[i] * 0.5 && cos_i[0][i] > 0) REQUIRE(half[i] == 1.0);
    }
}

TEST_CASE("the specular Fresnel rises from f0 to 1 with falloff and angle")
{
    Points points = unit_points({"cos_d", "f0"}, count, 100);
    points = with(std::move(points), "specular_fresnel_falloff", 0, 1, 101);
    const auto f = one("callisto", "F_Callisto", points);
    const auto& f0 = column(points, "f0");
    Points wider = points;
    for (auto& [name, values] : wider)
        if (name == "specular_fresnel_falloff")
            for (double& value : values) value = std::min(1.0, value * 1.25);
    const auto more = one("callisto", "F_Callisto", wider);
    for (std::size_t i = 0; i < count; ++i) {
        REQUIRE(f[i] >= f0[i]);
        REQUIRE(f[i] <= 1 + slack);
        REQUIRE(more[i] >= f[i] - slack);
    }
    for (const double value :
         one("callisto", "F_Callisto",
             with(unit_points({"cos_d", "f0"}, count, 102), "specular_fresnel_falloff", 1)))
        REQUIRE(std::abs(value - 1) <= slack);
}

TEST_CASE("without a falloff the specular Fresnel is f0")
{
    const Points points =
        with(unit_points({"cos_d", "f0"}, count, 103), "specular_fresnel_falloff", 0);
    const auto f = one("callisto", "F_Callisto", points);
    for (std::size_t i = 0; i < count; ++i) REQUIRE(f[i] == column(points, "f0")[i]);
}

TEST_CASE("Proxima is never negative and never exceeds its bound")
{
    const Points points = material_points(count, 110);
    Points with_alpha = points;
    std::vector<double> alpha;
    for (const double roughness : column(points, "roughness"))
        alpha.push_back(roughness * roughness);
    with_alpha.emplace_back("alpha", alpha);
    const auto f = one("callisto", "proxima_cos", with_alpha);
    const auto lambert = one("callisto", "lambert_cos", with_alpha);
    const auto& albedo = column(points, "diffuse_color");
    for (std::size_t i = 0; i < count; ++i) {
        REQUIRE(f[i] >= 0);
        // cos (1 - 0.55 alpha q) + 0.19 alpha q, with q in [0, 1].
        REQUIRE(f[i] <= albedo[i] / pi * (1 + 0.19 * alpha[i]) * (1 + slack));
        REQUIRE((lambert[i] > 0) >= (f[i] > 0));
    }
}

TEST_CASE("Proxima crosses Lambert where the cosine is 19/55")
{
    Points points = with(unit_points({"v_dot_l"}, count, 120), "cos_i", 19.0 / 55);
    points = with(with(std::move(points), "cos_o", 0.7), "alpha", 1.0 / 4096, 1, 121);
    points = with(std::move(points), "diffuse_color", 1);
    for (auto& value : points.front().second) value = 2 * value - 1;
    // Roundings of numbers below 1: 0.55, 1 - 0.55 a, 19/55, two products, a sum; then times 1/pi.
    for (const double value : one("callisto", "proxima_cos", points))
        REQUIRE(std::abs(value - 19.0 / 55 / pi) <= 6 * 0x1p-54 / pi);
}

TEST_CASE("Proxima is Lambert where light and view are opposite")
{
    Points points = with(unit_points({"cos_i"}, count, 130), "v_dot_l", -1);
    points = with(with(std::move(points), "cos_o", 0.7), "alpha", 1.0 / 4096, 1, 131);
    points = with(std::move(points), "diffuse_color", 1);
    const auto proxima = one("callisto", "proxima_cos", points);
    const auto lambert = one("callisto", "lambert_cos", points);
    // One is c (cos / pi), the other (c / pi) cos: two roundings each.
    for (std::size_t i = 0; i < count; ++i)
        REQUIRE(std::abs(proxima[i] - lambert[i]) <= 4 * 0x1p-53 * lambert[i]);
}

TEST_CASE("nothing reflects below the horizon")
{
    const Points points = material_points(count, 140);
    const auto& l = column(points, "l.z");
    const auto& v = column(points, "v.z");
    for (const char* output : {"callisto_diffuse", "callisto_specular", "callisto_lambert_diffuse",
                               "callisto_lambert_specular"}) {
        const auto values = one("callisto", output, points);
        for (std::size_t i = 0; i < count; ++i)
            if (l[i] <= 0 || v[i] <= 0) REQUIRE(values[i] == 0.0);
    }
}

TEST_CASE("a second lobe of opacity 0 is not there")
{
    const Points points =
        with(material_points(count, 150), "dual_specular_roughness_scale", 1, 14, 151);
    const auto two = one("callisto", "specular_cos", points);
    const auto none = one("callisto", "specular_cos",
                          with(material_points(count, 150), "dual_specular_roughness_scale", 1));
    for (std::size_t i = 0; i < count; ++i) REQUIRE(two[i] == none[i]);
}

TEST_CASE("the closed shadowing terms stay below 1")
{
    const Points points = geometry_points(count, 160);
    for (const char* term : {"G_Implicit", "G_Neumann", "G_CookTorrance", "G_Kelemen"})
        for (const double g : one("microfacet", term, points)) {
            REQUIRE(g >= 0);
            // Kelemen's bound is one of unit vectors, which rounding makes unit to an ulp; its
            // ratio of cosines magnifies that where l is almost -v.
            if (std::string{term} != "G_Kelemen") REQUIRE(g <= 1 + slack);
        }
}

TEST_CASE("distributions have the same peak")
{
    Points points =
        with(with(unit_points({"unused"}, 1000, 170), "cos_h", 1), "alpha", 1.0 / 4096, 1, 171);
    const auto& alpha = column(points, "alpha");
    for (const char* term : {"D_BlinnPhong", "D_Beckmann", "D_GGX"}) {
        const auto d = one("microfacet", term, points);
        for (std::size_t i = 0; i < d.size(); ++i)
            REQUIRE(std::abs(d[i] * pi * alpha[i] * alpha[i] - 1) <= slack);
    }
}

TEST_CASE("the rational Smith-Beckmann term exceeds 1 by at most 6.2e-5")
{
    const Points points = unit_points({"alpha", "cos_theta"}, count, 180);
    double most = 0;
    for (const double g : one("microfacet", "G1_SmithBeckmann", points)) most = std::max(most, g);
    CHECK(most > 1);
    CHECK(most <= 1 + 6.2e-5);
}

TEST_CASE("Schlick's k of half alpha is Smith's at alpha 1")
{
    const Points points = with(unit_points({"cos_theta"}, count, 190), "alpha", 1);
    const auto schlick = one("microfacet", "G1_SchlickGGX", points);
    const auto smith = one("microfacet", "G1_SmithGGX", points);
    for (std::size_t i = 0; i < count; ++i) REQUIRE(std::abs(schlick[i] - smith[i]) <= slack);
}

TEST_CASE("the dielectric Fresnel equations hit their ends")
{
    const Points normal = with(unit_points({"f0"}, count, 200), "cos_d", 1);
    const auto at_normal = one("microfacet", "F_CookTorrance", normal);
    for (std::size_t i = 0; i < count; ++i)
        REQUIRE(std::abs(at_normal[i] - column(normal, "f0")[i]) <= slack);

    const Points grazing = with(unit_points({"f0"}, count, 201), "cos_d", 0);
    const auto at_grazing = one("microfacet", "F_CookTorrance", grazing);
    for (std::size_t i = 0; i < count; ++i)
        REQUIRE(std::abs(at_grazing[i] - (column(grazing, "f0")[i] > 0 ? 1 : 0)) <= slack);

    // A perfect mirror mirrors at every angle.
    for (const double value :
         one("microfacet", "F_CookTorrance", with(unit_points({"cos_d"}, count, 202), "f0", 1)))
        REQUIRE(std::abs(value - 1) <= slack);
}

}  // namespace lobe::tests
