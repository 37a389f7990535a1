// Blending parameters against blending results: equal where shading is linear in them, and where
// one layer covers everything; different where it is not.
#include "analyze/residual/layers.h"
#include "compile.h"

#include <catch2/catch.hpp>

using namespace lobe;

namespace {

struct Program {
    explicit Program(const std::string& body)
    {
        const auto root = sources.add("layers.lobe", "module layers\n" + body);
        Diagnostics diagnostics;
        const auto checked = front(
            sources, root,
            [](Sources&, std::string_view, std::string_view) -> std::optional<std::uint32_t> {
                return std::nullopt;
            },
            diagnostics);
        REQUIRE(checked);
        module = middle(*checked);
    }
    Sources sources;
    ir::Module module;
};

const char* const lambert = R"(
/// Lambert.
model lit(g: geometry, s: surface) { diffuse = s.diffuse_color / pi * g.cos_i }
)";

/// GGX's distribution, alone.
const char* const highlight = R"(
/// A highlight.
model lit(g: geometry, s: surface) {
  specular = s.alpha^2 / (pi * (g.cos_h^2 * (s.alpha^2 - 1) + 1)^2) * g.cos_i
}
)";

scene::Value value(std::vector<double> low, std::vector<double> high)
{
    scene::Value out;
    out.low = std::move(low);
    out.high = std::move(high);
    out.is_given = true;
    return out;
}

scene::Value value(std::vector<double> both) { return value(both, both); }

scene::Material material(std::vector<double> color, double metallic, double roughness)
{
    scene::Material out;
    out.base_color = value(std::move(color));
    out.metallic = value({metallic});
    out.roughness = value({roughness});
    out.emissive = value({0, 0, 0});
    return out;
}

/// The second over the first.
scene::Scene two(const scene::Material& below, const scene::Material& above, double low,
                 double high)
{
    scene::Scene scene;
    scene.materials = {below, above};
    scene.materials[0].layers.push_back({1, value({low}, {high})});
    return scene;
}

double worst(const Program& program, const scene::Scene& scene)
{
    const auto found = analyze::layered_materials(scene, program.module, "lit");
    REQUIRE(found.size() == 1);
    CHECK(found[0].material == 0);
    CHECK(found[0].layers == 1);
    return found[0].error.worst;
}

}  // namespace

TEST_CASE("what is linear blends either way")
{
    const Program program{lambert};
    const auto red = material({0.8, 0.1, 0.1, 1}, 0, 0.5);
    const auto blue = material({0.1, 0.1, 0.9, 1}, 0, 0.3);
    // A handful of roundings in double.
    CHECK(worst(program, two(red, blue, 0, 1)) < 16 * 0x1p-53);
}

TEST_CASE("metal and color together are a product, which is not linear")
{
    const Program program{lambert};
    const auto paint = material({0.8, 0.8, 0.8, 1}, 0, 0.5);
    const auto metal = material({0.2, 0.2, 0.2, 1}, 1, 0.5);
    // At weight w: (0.8 - 0.6 w)(1 - w) against 0.8 (1 - w), relative or to a gray card of 0.18:
    // 0.6 w (1 - w) / max(0.8 (1 - w), 0.18), most where 0.8 (1 - w) is 0.18: 0.6 * 0.775 / 0.8.
    CHECK(worst(program, two(paint, metal, 0, 1)) == Approx(0.58125).epsilon(0.001));
}

TEST_CASE("a layer that covers everything, or nothing, changes nothing")
{
    const Program program{highlight};
    const auto glossy = material({1, 1, 1, 1}, 0, 0.2);
    const auto dull = material({1, 1, 1, 1}, 0, 0.9);
    CHECK(worst(program, two(glossy, dull, 0, 0)) == 0);
    CHECK(worst(program, two(glossy, dull, 1, 1)) == 0);
}

TEST_CASE("half of a sharp highlight is not a highlight half as sharp")
{
    const Program program{highlight};
    const auto glossy = material({1, 1, 1, 1}, 0, 0.2);
    const auto dull = material({1, 1, 1, 1}, 0, 0.8);
    const auto found =
        analyze::layered_materials(two(glossy, dull, 0.5, 0.5), program.module, "lit");
    REQUIRE(found.size() == 1);
    // At the peak D is 1 / (pi alpha^2): alphas 0.04, 0.64 and, of the blend, 0.25.
    const double results = (1 / 0.0016 + 1 / 0.4096) / 2;
    const double parameters = 1 / 0.0625;
    CHECK(found[0].error.worst >= (results - parameters) / results * 0.999);
    CHECK(found[0].error.typical <= found[0].error.often);
    CHECK(found[0].error.often <= found[0].error.worst);
    const auto again = analyze::layered_materials(two(glossy, dull, 0.5, 0.5), program.module,
                                                  "lit", {1 << 14, 3});
    CHECK(again[0].error.worst == found[0].error.worst);
    CHECK(again[0].error.witness.inputs == found[0].error.witness.inputs);
}

TEST_CASE("layers of layers, and weights that vary")
{
    const Program program{lambert};
    scene::Scene scene;
    scene.materials = {material({0.1, 0.1, 0.1, 1}, 0, 0.5), material({0.5, 0.5, 0.5, 1}, 0, 0.5),
                       material({0.9, 0.9, 0.9, 1}, 0, 0.5)};
    scene.materials[0].layers.push_back({1, value({0.25}, {0.75})});
    scene.materials[1].layers.push_back({2, value({0.5})});
    const auto found = analyze::layered_materials(scene, program.module, "lit");
    REQUIRE(found.size() == 2);
    CHECK(found[0].error.worst < 32 * 0x1p-53);
    CHECK(found[0].error.witness.inputs.back().second >= 0.25);
    CHECK(found[0].error.witness.inputs.back().second <= 0.75);
}

TEST_CASE("materials without layers are none of its business")
{
    const Program program{lambert};
    scene::Scene scene;
    scene.materials = {material({0.1, 0.1, 0.1, 1}, 0, 0.5)};
    CHECK(analyze::layered_materials(scene, program.module, "lit").empty());
}
