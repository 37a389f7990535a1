// The error of radiance is found where it can be computed by hand, and does not depend on threads.
#include "analyze/packing/radiance.h"
#include "analyze/packing/radiance_search.h"
#include "analyze/toy.h"
#include "base/render.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace lobe;
using Catch::Detail::Approx;
using tests::Toy;

namespace {

constexpr double pi = std::numbers::pi;

analyze::RadianceError whole(const Toy& toy, unsigned jobs = 0)
{
    return analyze::packing_errors(toy.module, toy.packing, {std::size_t{1} << 14, jobs}).whole;
}

double input(const analyze::RadianceError& error, std::string_view name)
{
    for (const auto& [column, value] : error.witness.inputs)
        if (column == name) return value;
    FAIL("no input " << name);
    return 0;
}

/// What one unit in the last place of every operation can do to a relative error of this size.
constexpr double float_slack = 1e-5;

}  // namespace

TEST_CASE("steps are where encode steps, from both sides", "[radiance]")
{
    Toy toy;
    toy.store(0, 8, 256);
    const analyze::Steps steps = analyze::steps_of(toy.module, toy.packing.fields[0]);
    REQUIRE(steps.borders.size() == 255);
    REQUIRE(steps.values.size() == 256);
    for (std::size_t i = 0; i < steps.borders.size(); ++i) {
        // The border of floor(255 x / 256 + 0.5), up to the rounding of three operations.
        const double border = (static_cast<double>(i) + 0.5) * 256 / 255;
        CHECK(steps.borders[i] == Approx(border).epsilon(4 * 0x1p-24));
        CHECK(steps.step_of(steps.borders[i]) == i + 1);
        CHECK(steps.step_of(std::nextafter(steps.borders[i], 0.0F)) == i);
        CHECK(steps.values[i] == Approx(static_cast<double>(i) * 256 / 255).epsilon(2 * 0x1p-24));
    }
    CHECK(steps.stored(-1) == 0);
    CHECK(steps.stored(1000) == steps.values.back());
}

TEST_CASE("the worst error of a gain in linear codes is the one computed by hand", "[radiance]")
{
    // radiance = gain base / pi n.l, base up to 1, grey 0.18 / pi n.l: the error is
    // |stored - gain| base / max(gain base, 0.18). With a step of s = 256 / 255 the least border,
    // s / 2 > 0.18, is stored as 0 or s: an error of s / 2 over s / 2, for base = 1.
    const int bits = GENERATE(6, 8, 10, 12);
    CAPTURE(bits);
    Toy toy;
    toy.use_gain();
    toy.store(0, bits, 256);
    const double half = 128.0 / ((1 << bits) - 1);
    const analyze::RadianceError error = whole(toy);
    // A border below the grey card's albedo counts against that; a higher one may be worse then:
    // border k + 1/2 has the error (1/2) s / max((k + 1/2) s, 0.18).
    const double worst = half / std::max(half, 0.18);
    CHECK(error.worst == Approx(worst).epsilon(float_slack));

    // The witness reaches it: by its own inputs, with nothing but arithmetic.
    const double gain = input(error, "gain");
    REQUIRE(error.witness.stored.size() == 1);
    const double stored = error.witness.stored[0].second;
    const double base = std::max({input(error, "diffuse_color.r"), input(error, "diffuse_color.g"),
                                  input(error, "diffuse_color.b")});
    CHECK(std::abs(stored - gain) * base / std::max(gain * base, 0.18) ==
          Approx(error.worst).epsilon(float_slack));
    CHECK(error.witness.packed / error.witness.exact == Approx(stored / gain).epsilon(float_slack));
    CHECK(input(error, "l.z") >= analyze::least_cosine);
}

TEST_CASE("the typical error of a gain is that of a uniform one", "[radiance]")
{
    // Gain and albedo uniform, 16 codes over [0, 256]: |stored - gain| is uniform in [0, 256 / 30]
    // and the gain itself is far above the grey card nearly everywhere, so the median of the ratio
    // is that of U / G with U in [0, 256 / 30], G in [0, 256]: P(U / G < t) = 15 t for t < 1/30.
    Toy toy;
    toy.use_gain();
    toy.store(0, 4, 256);
    const analyze::RadianceError error = whole(toy);
    // Of 2^13 points the median strays by 0.5 / sqrt(2^13) of probability per sigma: 5 of them,
    // over a density of 15.
    const double sigma = 0.5 / std::sqrt(8192.0) / 15;
    CHECK(error.typical == Approx(0.5 / 15).margin(5 * sigma + 1e-3));
    CHECK(error.often > error.typical);
    CHECK(error.worst > error.often);
}

TEST_CASE("the worst error of an exponent is the one computed by hand", "[radiance]")
{
    // radiance = x^(10 (1 - f)) n.l with x = cos_h, against at least 0.18 / pi n.l. With f off by d
    // the error is |x^(10 d) - 1| where the radiance is above the grey card; the worst is where
    // the stored f is higher, at x^(10 (1 - f)) = 0.18 / pi if x gets there: then the error is
    // c^(-d / (1 - f)) - 1 with c = 0.18 / pi, largest for the largest f. The carried range ends at
    // high, whose last border is half a step below.
    const int bits = GENERATE(4, 6, 8);
    CAPTURE(bits);
    Toy toy;
    toy.use_falloff();
    toy.store(1, bits, 0.9375);
    const double half = 0.9375 / ((1 << bits) - 1) / 2;
    const double rest = 1 - 0.9375 + half;
    const double worst = std::pow(0.18 / pi, -half / rest) - 1;
    const analyze::RadianceError error = whole(toy);
    CHECK(error.worst == Approx(worst).epsilon(1e-3));
    CHECK(error.worst <= worst * (1 + 1e-4));
}

TEST_CASE("more bits never make it worse", "[radiance]")
{
    double before = 1e9;
    for (int bits = 1; bits <= 12; ++bits) {
        CAPTURE(bits);
        Toy toy;
        toy.use_falloff();
        toy.store(1, bits, 0.9375);
        const double error = whole(toy).worst;
        CHECK(error < before);
        CHECK(error > 0);
        before = error;
    }
}

TEST_CASE("a parameter that does not matter has no error", "[radiance]")
{
    Toy toy;
    toy.use_gain();
    toy.store(0, 8, 256);
    toy.store(1, 2, 1);
    const auto errors = analyze::packing_errors(toy.module, toy.packing, {std::size_t{1} << 12, 0});
    REQUIRE(errors.parameters.size() == 2);
    CHECK(errors.parameters[1].parameter == 1);
    CHECK(errors.parameters[1].error.worst == 0);
    CHECK(errors.parameters[1].error.typical == 0);
    CHECK(errors.parameters[0].error.worst == errors.whole.worst);
    CHECK(errors.points == std::size_t{1} << 12);
}

TEST_CASE("errors are the same on any number of threads", "[radiance]")
{
    Toy toy;
    toy.use_gain();
    toy.use_falloff();
    toy.store(0, 5, 256);
    toy.store(1, 4, 0.9375);
    const analyze::RadianceError one = whole(toy, 1);
    for (const unsigned jobs : {2U, 4U}) {
        const analyze::RadianceError many = whole(toy, jobs);
        CHECK(many.worst == one.worst);
        CHECK(many.typical == one.typical);
        CHECK(many.often == one.often);
        CHECK(many.witness.inputs == one.witness.inputs);
        CHECK(many.witness.stored == one.witness.stored);
    }
}

TEST_CASE("what is measured is narrowed by `over`", "[radiance]")
{
    // From gain = 2 on the worst border is the first above it, 2.5 s off by half a step: 1/5.
    Toy toy;
    toy.use_gain();
    toy.store(0, 8, 256);
    toy.packing.measured.push_back({"gain", {2, 256}, {}});
    const double step = 256.0 / 255;
    CHECK(whole(toy).worst == Approx(0.5 * step / (2.5 * step)).epsilon(float_slack));
}

TEST_CASE("a parameter that is not stored stays at its default", "[radiance]")
{
    Toy toy;
    toy.use_gain();
    toy.use_falloff();
    toy.store(0, 8, 256);
    const analyze::RadianceError error = whole(toy);
    CHECK(input(error, "falloff") == 0.75);
    toy.packing.measured.push_back({"falloff", {0.25, 0.5}, {}});
    CHECK(input(whole(toy), "falloff") <= 0.5);
}

TEST_CASE("directions are unit and above the horizon, wherever points are", "[radiance]")
{
    Toy toy;
    toy.use_falloff();
    toy.store(1, 4, 1);
    const analyze::RadianceBox box = analyze::radiance_box(toy.module, toy.packing);
    const analyze::StoredAs stored(box.width(), nullptr);
    REQUIRE(box.light);
    REQUIRE(box.view);
    analyze::RadianceMeter meter{box, 4096};
    for (std::size_t row = 0; row < meter.rows(); ++row)
        analyze::place_point(box, stored, row, meter, row);
    std::size_t grazing = 0;
    for (const std::size_t first : {*box.light, *box.view})
        for (std::size_t row = 0; row < meter.rows(); ++row) {
            const double x = meter.column(first)[row];
            const double y = meter.column(first + 1)[row];
            const double z = meter.column(first + 2)[row];
            REQUIRE(std::abs(x * x + y * y + z * z - 1) < 4 * 0x1p-24);
            REQUIRE(z >= analyze::least_cosine);
            grazing += z < 1e-3 ? 1 : 0;
        }
    // Two families graze on both sides, two on one, of ten, for every second point.
    CHECK(grazing > 4096 * 2 / 2 * 3 / 10);
}

TEST_CASE("a requirement that is not met is refused with what breaks it", "[radiance]")
{
    Toy toy;
    toy.use_gain();
    toy.store(0, 8, 256);
    Sources sources;
    const auto source = sources.add("toy.lobe", "  require radiance error < 2%\n");
    toy.packing.radiance_span = {source, 2, 29};
    const auto errors = analyze::packing_errors(toy.module, toy.packing, {std::size_t{1} << 12, 0});
    CHECK(analyze::unmet(toy.module, toy.packing, errors).empty());
    toy.packing.radiance_limit = 1.01;
    CHECK(analyze::unmet(toy.module, toy.packing, errors).empty());
    toy.packing.radiance_limit = 0.02;
    const Diagnostics refused = analyze::unmet(toy.module, toy.packing, errors);
    REQUIRE(refused.all().size() == 1);
    CHECK(id(refused.all()[0].code) == "E0612");
    const std::string text = render_text(sources, refused);
    CAPTURE(text);
    CHECK(text.find("changes its radiance by up to 100 %") != std::string::npos);
    CHECK(text.find("asks for less than 2 %") != std::string::npos);
    CHECK(text.find("diffuse_color = (") != std::string::npos);
    CHECK(text.find("gain = 0.501961 becomes 1.00392") != std::string::npos);
}
