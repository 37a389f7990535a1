// At its defaults Callisto is its base model, to the last bit.
#include "numeric/library.h"
#include "numeric/points.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cstdint>

namespace lobe::tests {
namespace {

/// The base models, written without any of Callisto's parameters but one: the exponent of the
/// Fresnel term, which a power with a literal 5 would compute by multiplication and round
/// differently. That its value at the default is Schlick's is the next test.
const char* const base_models = R"(
module base
import microfacet { D_GGX, V_SmithGGX, Diffuse_Lambert }

param five : float in [0, 10] = 5 "Exponent"

term proxima(diffuse_color: color, alpha: float in [1/4096, 1], g: geometry) -> color {
  let roughening = alpha * (1 - sqrt(max(-g.v_dot_l, 0)))
  let brightness = g.cos_i * (1 - 0.55 * roughening) + 0.19 * roughening
  if g.cos_i > 0 and g.cos_o > 0 then diffuse_color / pi * brightness else 0
}
term lambert(diffuse_color: color, g: geometry) -> color =
  if g.cos_i > 0 and g.cos_o > 0 then Diffuse_Lambert(diffuse_color) * g.cos_i else 0
term ggx(f0: color, alpha: float in [1/4096, 1], g: geometry) -> color {
  let fresnel = f0 + (1 - f0) * (1 - g.cos_d)^five
  if g.cos_i > 0 and g.cos_o > 0 then D_GGX(alpha, g) * V_SmithGGX(alpha, g) * fresnel * g.cos_i else 0
}
model over_proxima(g: geometry, s: surface) {
  diffuse = proxima(s.diffuse_color, s.alpha, g)
  specular = ggx(s.f0, s.alpha, g)
}
model over_lambert(g: geometry, s: surface) {
  diffuse = lambert(s.diffuse_color, g)
  specular = ggx(s.f0, s.alpha, g)
}
)";

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }
std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }

template <class Number>
void require_equal_bits(const std::string& ours, const std::string& base, const Points& points)
{
    static const ir::Module bases = compiled(base_models);
    const auto callisto = run<Number>(optimized("callisto"), ours, points);
    const auto expected = run<Number>(bases, base, points);
    CAPTURE(ours, base);
    REQUIRE(callisto.size() == expected.size());
    std::size_t different = 0;
    for (std::size_t channel = 0; channel < callisto.size(); ++channel)
        for (std::size_t i = 0; i < callisto[channel].size(); ++i)
            different += bits_of(callisto[channel][i]) != bits_of(expected[channel][i]);
    CHECK(different == 0);
}

}  // namespace

TEST_CASE("at its defaults Callisto equals its base model exactly")
{
    const Points points = material_points(20000, 1);
    for (const auto& [ours, base] :
         {std::pair{"callisto", "over_proxima"}, std::pair{"callisto_lambert", "over_lambert"}})
        for (const char* output : {"_diffuse", "_specular"}) {
            require_equal_bits<float>(std::string{ours} + output, std::string{base} + output,
                                      points);
            require_equal_bits<double>(std::string{ours} + output, std::string{base} + output,
                                       points);
        }
}

TEST_CASE("at falloff one half the specular Fresnel is Schlick's")
{
    const std::size_t count = 10000;
    Points points = unit_points({"cos_d", "f0"}, count, 2);
    const auto callisto = run<double>(optimized("callisto"), "F_Callisto", points);
    const auto schlick = run<double>(optimized("microfacet"), "F_Schlick", points);
    // The same real numbers; the power and the product of five round differently. The product's
    // four roundings and the power's one ulp are relative to the tail, a sum's half ulp to the
    // whole: 7 halves of an ulp of 1 bound them together.
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t i = 0; i < count; ++i)
            REQUIRE(std::abs(callisto[channel][i] - schlick[channel][i]) <= 3.5 * 0x1p-52);
}

TEST_CASE("the parts that are off at the defaults are exactly neutral")
{
    const Points points = geometry_points(20000, 3);
    for (const auto& factor : {"c1", "c2"}) {
        for (const auto& channel : run<float>(optimized("callisto"), factor, points))
            for (const float value : channel) REQUIRE(value == 1.0F);
        for (const auto& channel : run<double>(optimized("callisto"), factor, points))
            for (const double value : channel) REQUIRE(value == 1.0);
    }
}

}  // namespace lobe::tests
