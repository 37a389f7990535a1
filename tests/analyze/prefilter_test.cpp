// Environments as cube maps: lookups, levels, prefiltering and spherical harmonics, against
// environments whose integrals are known.
#include "analyze/environment/consistency.h"
#include "analyze/environment/harmonics.h"
#include "analyze/environment/prefilter.h"
#include "analyze/environment/sampling.h"
#include "numeric/library.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace lobe::tests {
namespace {

using namespace analyze;
using std::numbers::pi;

using Field = std::function<Radiance(const Vector&)>;

CubeLevel cube(int size, const Field& field)
{
    CubeLevel out{size};
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                out.set(face, row, column, field(texel_direction(out, face, row, column)));
    return out;
}

Radiance mean(const CubeLevel& level)
{
    Radiance out{};
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < level.size; ++row)
            for (int column = 0; column < level.size; ++column)
                for (std::size_t channel = 0; channel < 3; ++channel)
                    out[channel] += texel_solid_angle(level.size, row, column) / (4 * pi) *
                                    level.at(face, row, column)[channel];
    return out;
}

/// A sky: a bright disk over a slope from below to above.
Radiance sky(const Vector& d)
{
    const double sun = std::exp(40 * (0.6 * d.x + 0.8 * d.y - 1));
    return {1 + 0.5 * d.y + 20 * sun, 1 + 0.25 * d.z + 10 * sun, 1 - 0.5 * d.x};
}

/// Directions that lie on faces, edges and corners.
std::vector<Vector> directions()
{
    std::vector<Vector> out;
    for (const double x : {-1.0, -0.3, 0.0, 0.7, 1.0})
        for (const double y : {-1.0, -0.2, 0.0, 0.5, 1.0})
            for (const double z : {-1.0, 0.1, 1.0}) out.push_back(normalized({x, y, z}));
    return out;
}

}  // namespace

TEST_CASE("texels cover the sphere once")
{
    for (const int size : {1, 2, 7, 64}) {
        double whole = 0;
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                whole += 6 * texel_solid_angle(size, row, column);
        CHECK(whole == Approx(4 * pi).epsilon(1e-12));
    }
}

TEST_CASE("faces lie as APIs have them")
{
    const CubeLevel level{2};
    // The upper left texel of each face, from "Cube Map Face Selection" of Vulkan: sc, tc = -1/2.
    const std::array<Vector, 6> corners{Vector{2, 1, 1},   Vector{-2, 1, -1}, Vector{-1, 2, -1},
                                        Vector{-1, -2, 1}, Vector{-1, 1, 2},  Vector{1, 1, -2}};
    for (int face = 0; face < 6; ++face) {
        const Vector expected = normalized(corners[static_cast<std::size_t>(face)]);
        const Vector found = texel_direction(level, face, 0, 0);
        CAPTURE(face);
        CHECK(dot(expected, found) == Approx(1).epsilon(1e-14));
    }
}

TEST_CASE("a lookup in the middle of a texel is the texel")
{
    const CubeMap map{{cube(9, sky)}};
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < 9; ++row)
            for (int column = 0; column < 9; ++column) {
                const CubeLevel& level = map.levels[0];
                const Radiance found = look_up(map, texel_direction(level, face, row, column), 0);
                const Radiance texel = level.at(face, row, column);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    // The place of the middle is off by some 2^-50 of the neighbors' difference.
                    CHECK(found[channel] == Approx(texel[channel]).margin(1e-12));
            }
}

TEST_CASE("lookups join across edges")
{
    // Between the last texels of two faces the value lies between theirs, and does not jump.
    const CubeMap map{{cube(16, [](const Vector& d) { return Radiance{d.x, d.y, d.z}; })}};
    for (const double height : {-0.9, -0.4, 0.0, 0.3, 0.95}) {
        const double step = 1e-9;
        const Radiance before = look_up(map, {1, height, 1 - step}, 0);
        const Radiance after = look_up(map, {1 - step, height, 1}, 0);
        for (std::size_t channel = 0; channel < 3; ++channel)
            // The texels beyond an edge are the nearest ones, which may be half a texel off.
            CHECK(std::fabs(before[channel] - after[channel]) <= 0.5 / 16);
    }
}

TEST_CASE("levels keep the mean")
{
    for (const int size : {16, 21}) {
        const CubeMap map = with_levels(cube(size, sky));
        CHECK(map.levels.back().size == 1);
        const Radiance sharp = mean(map.levels.front());
        for (const CubeLevel& level : map.levels)
            for (std::size_t channel = 0; channel < 3; ++channel)
                // Texels are floats.
                CHECK(mean(level)[channel] == Approx(sharp[channel]).epsilon(0x1p-22));
    }
}

TEST_CASE("a picture of all directions becomes the same environment")
{
    constexpr int width = 512;
    constexpr int height = 256;
    std::vector<float> texels;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const double fall = (row + 0.5) / height * pi;
            const double turn = ((column + 0.5) / width - 0.5) * 2 * pi;
            const Vector d{std::sin(fall) * std::sin(turn), std::cos(fall),
                           -std::sin(fall) * std::cos(turn)};
            for (const double channel : {d.x, d.y, d.z})
                texels.push_back(static_cast<float>(channel));
        }
    const CubeLevel found = cube_of({width, height, texels}, 32, 2);
    const CubeLevel again = cube_of({width, height, texels}, 32, 1);
    CHECK(found.texels == again.texels);
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < 32; ++row)
            for (int column = 0; column < 32; ++column) {
                const Vector d = texel_direction(found, face, row, column);
                const Radiance value = found.at(face, row, column);
                // A texel's mean direction is shorter than 1, and off the middle of the texel, by
                // the square of its size, 1/16; the picture's own texels are 0.012.
                CHECK(std::fabs(value[0] - d.x) <= 0.004);
                CHECK(std::fabs(value[1] - d.y) <= 0.004);
                CHECK(std::fabs(value[2] - d.z) <= 0.004);
            }
}

TEST_CASE("an even environment stays itself, at any roughness")
{
    const CubeMap source = with_levels(cube(16, [](const Vector&) {
        return Radiance{0.25, 3, 1000};
    }));
    const CubeMap blurred = prefiltered(source, {.size = 8, .levels = 4, .samples = 64});
    REQUIRE(blurred.levels.size() == 4);
    CHECK(blurred.levels[0].size == 8);
    CHECK(blurred.levels[3].size == 1);
    for (const CubeLevel& level : blurred.levels)
        for (std::size_t i = 0; i < level.texels.size(); i += 3) {
            CHECK(level.texels[i] == Approx(0.25).epsilon(0x1p-22));
            CHECK(level.texels[i + 1] == Approx(3).epsilon(0x1p-22));
            CHECK(level.texels[i + 2] == Approx(1000).epsilon(0x1p-22));
        }
}

TEST_CASE("a slope is flattened by the mean cosine of the lobe")
{
    // Of L = d.y the weighted mean around r is r.y times the sum of (n.l)^2 over that of n.l: what
    // is across r averages out.
    const CubeMap source = with_levels(cube(64, [](const Vector& d) {
        return Radiance{d.y, d.y, d.y};
    }));
    constexpr std::uint32_t samples = 1024;
    const PrefilterOptions options{
        .size = 16, .levels = 3, .samples = samples, .blurs_samples = false};
    const CubeMap blurred = prefiltered(source, options);
    for (int i = 1; i < 3; ++i) {
        const double alpha = std::pow(i / 2.0, 2);
        double first = 0;
        double second = 0;
        for (std::uint32_t k = 0; k < samples; ++k) {
            const Vector h = importance_sample_ggx(hammersley(k, samples), alpha);
            const double cosine = std::max(2 * h.z * h.z - 1, 0.0);
            first += cosine;
            second += cosine * cosine;
        }
        const CubeLevel& level = blurred.levels[static_cast<std::size_t>(i)];
        CHECK(level_of(i / 2.0, blurred) == i);
        for (int face = 0; face < 6; ++face)
            for (int row = 0; row < level.size; ++row)
                for (int column = 0; column < level.size; ++column) {
                    const double y = texel_direction(level, face, row, column).y;
                    CAPTURE(i, y);
                    // Hammersley points have their first moment around the axis within 1/1024 of 0,
                    // and d.y is linear between texels but for (1/32)^2 / 8 of curvature, or a
                    // texel beside at corners: a quarter of 1/32.
                    CHECK(std::fabs(level.at(face, row, column)[0] - y * second / first) <=
                          1.0 / 1024 + 1.0 / 128);
                }
    }
}

TEST_CASE("prefiltering is the same on any number of threads, and blurs without adding light")
{
    const CubeMap source = with_levels(cube(32, sky));
    PrefilterOptions options{.size = 16, .levels = 4, .samples = 256, .jobs = 1};
    const CubeMap one = prefiltered(source, options);
    options.jobs = 3;
    const CubeMap three = prefiltered(source, options);
    double before = HUGE_VAL;
    for (std::size_t i = 0; i < one.levels.size(); ++i) {
        CHECK(one.levels[i].texels == three.levels[i].texels);
        const double brightest = *std::ranges::max_element(one.levels[i].texels);
        CHECK(brightest < before);
        before = brightest;
    }
}

TEST_CASE("under a small sun, blurred lookups are nearer to what many more samples say")
{
    const CubeMap source = with_levels(cube(64, [](const Vector& d) {
        const double sun = 1000 * std::exp(800 * (0.6 * d.x + 0.8 * d.y - 1));
        return Radiance{1 + sun, 1 + sun, 1 + sun};
    }));
    const PrefilterOptions few{.size = 8, .levels = 3, .samples = 64};
    PrefilterOptions many = few;
    many.samples = 1 << 14;
    many.blurs_samples = false;
    PrefilterOptions noisy = few;
    noisy.blurs_samples = false;
    const CubeMap reference = prefiltered(source, many);
    const auto off = [&](const CubeMap& map, std::size_t level) {
        double sum = 0;
        for (std::size_t i = 0; i < map.levels[level].texels.size(); ++i)
            sum += std::fabs(map.levels[level].texels[i] - reference.levels[level].texels[i]);
        return sum;
    };
    const CubeMap blurred = prefiltered(source, few);
    const CubeMap sharp = prefiltered(source, noisy);
    for (const std::size_t level : {std::size_t{1}, std::size_t{2}}) {
        CAPTURE(level, off(blurred, level), off(sharp, level));
        CHECK(off(blurred, level) < off(sharp, level) / 2);
    }
}

TEST_CASE("harmonics are orthonormal")
{
    constexpr int size = 128;
    std::array<std::array<double, harmonics>, harmonics> products{};
    const CubeLevel level{size};
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column) {
                const auto at = harmonics_at(texel_direction(level, face, row, column));
                const double part = texel_solid_angle(size, row, column);
                for (std::size_t i = 0; i < harmonics; ++i)
                    for (std::size_t k = 0; k < harmonics; ++k)
                        products[i][k] += part * at[i] * at[k];
            }
    for (std::size_t i = 0; i < harmonics; ++i)
        for (std::size_t k = 0; k < harmonics; ++k)
            // The midpoint rule: squares of texels' size, 1/64, over 24, times second derivatives.
            CHECK(products[i][k] == Approx(i == k ? 1 : 0).margin(1e-3));
}

TEST_CASE("irradiance is the integral of radiance times the cosine")
{
    // Of bands 0 to 2 it is exact: even light gives pi, a slope 2 pi / 3, a quadric pi / 4.
    const auto field = [](const Vector& d) {
        return Radiance{2, 1 + d.x, 1 + d.x * d.y - 0.5 * (3 * d.z * d.z - 1)};
    };
    const HarmonicSeries radiance = radiance_series(cube(64, field));
    const HarmonicSeries irradiance = irradiance_series(radiance);
    for (const Vector& n : directions()) {
        const Radiance found = value_of(irradiance, n);
        // As above, with texels of 1/32.
        CHECK(found[0] == Approx(2 * pi).margin(0.01));
        CHECK(found[1] == Approx(pi + 2 * pi / 3 * n.x).margin(0.01));
        CHECK(found[2] ==
              Approx(pi + pi / 4 * (n.x * n.y - 0.5 * (3 * n.z * n.z - 1))).margin(0.01));
    }
}

TEST_CASE("irradiance of a sky is within a few percent of its integral")
{
    // [Ramamoorthi01]: the bands above 2 hold 1 % of the energy on average, and at worst 9 %.
    const CubeLevel environment = cube(64, sky);
    const HarmonicSeries irradiance = irradiance_series(radiance_series(environment));
    double whole = 0;
    for (const Vector& n : directions()) {
        double exact = 0;
        for (int face = 0; face < 6; ++face)
            for (int row = 0; row < 64; ++row)
                for (int column = 0; column < 64; ++column)
                    exact += texel_solid_angle(64, row, column) *
                             environment.at(face, row, column)[0] *
                             std::max(dot(n, texel_direction(environment, face, row, column)), 0.0);
        whole = std::max(whole, std::fabs(value_of(irradiance, n)[0] / exact - 1));
    }
    CHECK(whole <= 0.09);
}

TEST_CASE("an environment that was made right is consistent, and one that was not is told")
{
    const CubeMap source = with_levels(cube(32, sky));
    const CubeMap right = prefiltered(source, {.size = 32, .levels = 5, .samples = 256});
    const HarmonicSeries irradiance = irradiance_series(radiance_series(source.levels[0]));
    const EnvironmentErrors none = environment_errors(right, irradiance, 0);
    // The same texels. The places of lookups are rounded in double: less than a float can show.
    CHECK(none.irradiance == 0);
    REQUIRE(none.levels.size() == 4);
    for (const double error : none.levels) CHECK(error < 0x1p-24);

    // Halves in place of blurred levels, and radiance in place of irradiance.
    const EnvironmentErrors wrong =
        environment_errors(source, radiance_series(source.levels[0]), 0);
    REQUIRE(wrong.levels.size() == 5);
    for (std::size_t i = 0; i < 4; ++i) CHECK(wrong.levels[i] > 0x1p-24);
    // The first coefficients alone are too small by a factor of pi.
    CHECK(wrong.irradiance > (1 - 1 / pi));

    // A sign that is turned around: twice the coefficient, of harmonics whose mean square is
    // 1 / (4 pi), over the mean. Both sides are a dozen roundings, nothing cancels.
    HarmonicSeries turned = irradiance;
    double squares = 0;
    double whole = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        turned[1][channel] = -turned[1][channel];
        squares += 4 * irradiance[1][channel] * irradiance[1][channel] / (4 * pi) / 3;
        whole += irradiance[0][channel] / std::sqrt(4 * pi) / 3;
    }
    CHECK(environment_errors(right, turned, 0).irradiance ==
          Approx(std::sqrt(squares) / whole).epsilon(2 * 12 * 0x1p-53));
}

TEST_CASE("the shipped term is the series")
{
    const HarmonicSeries radiance = radiance_series(cube(32, sky));
    const HarmonicSeries irradiance = irradiance_series(radiance);
    const std::array names{"l00", "l1m1", "l10", "l11", "l2m2", "l2m1", "l20", "l21", "l22"};
    const std::vector<Vector> normals = directions();
    Points points{{"n.x", {}}, {"n.y", {}}, {"n.z", {}}};
    for (const Vector& n : normals) {
        points[0].second.push_back(n.x);
        points[1].second.push_back(n.y);
        points[2].second.push_back(n.z);
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            points.emplace_back(std::string{names[i]} + "." + "xyz"[channel],
                                std::vector<double>(normals.size(), radiance[i][channel]));
    const auto found = run<double>(optimized("environment"), "IrradianceSH", points);
    for (std::size_t k = 0; k < normals.size(); ++k)
        for (std::size_t channel = 0; channel < 3; ++channel)
            CHECK(found[channel][k] ==
                  Approx(value_of(irradiance, normals[k])[channel]).epsilon(1e-13));
}

}  // namespace lobe::tests
