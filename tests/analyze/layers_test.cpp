// Blending parameters against blending results: equal where shading is linear in them, and where
// one layer covers everything; different where it is not.
#include "analyze/checked.h"
#include "analyze/residual/layers.h"
#include "compile.h"

#include <catch2/catch.hpp>

using namespace lobe;

namespace {

ir::Module module_of(const std::string& body)
{
    return middle(tests::checked_text("module layers\n" + body).module);
}

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

scene::Value value(const scene::Components& low, const scene::Components& high)
{
    scene::Value out;
    out.low = low;
    out.high = high;
    out.is_given = true;
    return out;
}

scene::Value value(const scene::Components& both) { return value(both, both); }

scene::Material material(const scene::Components& color, double metallic, double roughness)
{
    scene::Material out;
    out.base_color = value(color);
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

double worst(const ir::Module& module, const scene::Scene& scene)
{
    const auto found = analyze::layered_materials(scene, module, "lit").measured;
    REQUIRE(found.size() == 1);
    CHECK(found[0].material == 0);
    CHECK(found[0].layers == 1);
    return found[0].error.worst;
}

}  // namespace

TEST_CASE("what is linear blends either way")
{
    const ir::Module module = module_of(lambert);
    const auto red = material({0.8, 0.1, 0.1, 1}, 0, 0.5);
    const auto blue = material({0.1, 0.1, 0.9, 1}, 0, 0.3);
    // A handful of roundings in double.
    CHECK(worst(module, two(red, blue, 0, 1)) < 16 * 0x1p-53);
}

TEST_CASE("metal and color together are a product, which is not linear")
{
    const ir::Module module = module_of(lambert);
    const auto paint = material({0.8, 0.8, 0.8, 1}, 0, 0.5);
    const auto metal = material({0.2, 0.2, 0.2, 1}, 1, 0.5);
    // At weight w: (0.8 - 0.6 w)(1 - w) against 0.8 (1 - w), relative or to a gray card of 0.18:
    // 0.6 w (1 - w) / max(0.8 (1 - w), 0.18), most where 0.8 (1 - w) is 0.18: 0.6 * 0.775 / 0.8.
    CHECK(worst(module, two(paint, metal, 0, 1)) == Approx(0.58125).epsilon(0.001));
}

TEST_CASE("a layer that covers everything, or nothing, changes nothing")
{
    const ir::Module module = module_of(highlight);
    const auto glossy = material({1, 1, 1, 1}, 0, 0.2);
    const auto dull = material({1, 1, 1, 1}, 0, 0.9);
    CHECK(worst(module, two(glossy, dull, 0, 0)) == 0);
    CHECK(worst(module, two(glossy, dull, 1, 1)) == 0);
}

TEST_CASE("half of a sharp highlight is not a highlight half as sharp")
{
    const ir::Module module = module_of(highlight);
    const auto glossy = material({1, 1, 1, 1}, 0, 0.2);
    const auto dull = material({1, 1, 1, 1}, 0, 0.8);
    const auto found =
        analyze::layered_materials(two(glossy, dull, 0.5, 0.5), module, "lit").measured;
    REQUIRE(found.size() == 1);
    // At the peak D is 1 / (pi alpha^2): alphas 0.04, 0.64 and, of the blend, 0.25.
    const double results = (1 / 0.0016 + 1 / 0.4096) / 2;
    const double parameters = 1 / 0.0625;
    CHECK(found[0].error.worst >= (results - parameters) / results * 0.999);
    CHECK(found[0].error.typical <= found[0].error.often);
    CHECK(found[0].error.often <= found[0].error.worst);
    CHECK_FALSE(found[0].one_shading_is_enough());
    analyze::LayerOptions three;
    three.jobs = 3;
    const auto again =
        analyze::layered_materials(two(glossy, dull, 0.5, 0.5), module, "lit", three).measured;
    CHECK(again[0].error.worst == found[0].error.worst);
    CHECK(again[0].error.witness.inputs == found[0].error.witness.inputs);
}

TEST_CASE("layers of layers, and weights that vary")
{
    const ir::Module module = module_of(lambert);
    scene::Scene scene;
    scene.materials = {material({0.1, 0.1, 0.1, 1}, 0, 0.5), material({0.5, 0.5, 0.5, 1}, 0, 0.5),
                       material({0.9, 0.9, 0.9, 1}, 0, 0.5)};
    scene.materials[0].layers.push_back({1, value({0.25}, {0.75})});
    scene.materials[1].layers.push_back({2, value({0.5})});
    const auto found = analyze::layered_materials(scene, module, "lit").measured;
    REQUIRE(found.size() == 2);
    CHECK(found[0].error.worst < 32 * 0x1p-53);
    CHECK(found[0].error.witness.inputs.back().second >= 0.25);
    CHECK(found[0].error.witness.inputs.back().second <= 0.75);
}

TEST_CASE("materials without layers are none of its business")
{
    const ir::Module module = module_of(lambert);
    scene::Scene scene;
    scene.materials = {material({0.1, 0.1, 0.1, 1}, 0, 0.5)};
    CHECK(analyze::layered_materials(scene, module, "lit").measured.empty());
}

TEST_CASE("layers that differ by less than a display shows need one shading")
{
    const ir::Module module = module_of(highlight);
    const auto dull = material({1, 1, 1, 1}, 0, 0.8);
    const auto same = material({1, 1, 1, 1}, 0, 0.8001);
    const auto found = analyze::layered_materials(two(dull, same, 0, 1), module, "lit").measured;
    REQUIRE(found.size() == 1);
    CHECK(found[0].error.worst > 0);
    CHECK(found[0].one_shading_is_enough());
}

TEST_CASE("the share of a code decides whether one shading is enough")
{
    analyze::LayeredMaterial material;
    // 255 - 1/2 of 255 as light: ((254.5 / 255 + 0.055) / 1.055)^2.4 = 0.99554.
    material.error.worst = 0.0044;
    CHECK(material.one_shading_is_enough());
    material.error.worst = 0.0045;
    CHECK_FALSE(material.one_shading_is_enough());
}

TEST_CASE("unlit materials are not shaded, and no more are measured than asked for")
{
    const ir::Module module = module_of(lambert);
    const auto grey = material({0.5, 0.5, 0.5, 1}, 0, 0.5);
    scene::Scene scene;
    scene.materials = {grey, grey, grey, grey};
    for (const std::size_t base : {0, 1, 2})
        scene.materials[base].layers.push_back({3, value({0.5})});
    scene.materials[0].is_unlit = true;
    analyze::LayerOptions one;
    one.most = 1;
    const auto found = analyze::layered_materials(scene, module, "lit", one);
    REQUIRE(found.measured.size() == 1);
    CHECK(found.measured[0].material == 1);
    CHECK(found.not_measured == 1);
}
