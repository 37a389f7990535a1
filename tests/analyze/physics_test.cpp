// Physics of what was emitted: figures that are known, and laws that are broken on purpose.
//
// Tolerances are what the quadrature says of itself, what the Vulkan contract lets a device round
// at the nodes, and half of the last digit that a known figure is printed with.
#include "analyze/emitted.h"
#include "analyze/physics/hemisphere.h"
#include "analyze/physics/physics.h"
#include "analyze/physics/quadrature.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>

using namespace lobe;
using namespace lobe::tests;
using analyze::EmittedFunction;
using analyze::EntryInputs;
using analyze::HemisphereIntegral;
using analyze::HemisphereJob;
using analyze::Law;
using analyze::PhysicsRow;

namespace {

constexpr double pi = std::numbers::pi;

device::Device& the_device()
{
    static std::string why;
    static std::optional<device::Device> device = device::Device::open("", why);
    INFO(why);
    REQUIRE(device);
    return *device;
}

using Settings = std::map<std::string, double>;

/// What one view sees of a white surface under a white sky.
class Furnace {
public:
    Furnace(const Emitted& emitted, const std::string& output)
        : function_(emitted.module, emitted.sources, find(emitted.module, output), &the_device())
    {
    }

    /// Checks a known figure with this many decimals against the definition and the shader.
    void check(double cos_view, const Settings& settings, double known, int decimals)
    {
        HemisphereJob job{function_.inputs().neutral(), HemisphereJob::Over::light, cos_view, 1, 1};
        for (const auto& [name, value] : settings) {
            const EntryInputs::Value* input = function_.inputs().find(name);
            INFO(name);
            REQUIRE(input != nullptr);
            EntryInputs::set(job.values, *input, value);
            if (name == "roughness") job.alpha_x = job.alpha_y = value * value;
        }
        std::vector<HemisphereIntegral> integrals;
        REQUIRE(analyze::integrate(function_, {&job, 1}, integrals) == "");
        const HemisphereIntegral& integral = integrals.front();
        CAPTURE(function_.name(), cos_view, integral.exact, integral.value, integral.uncertainty);
        const double digits = 0.5 * std::pow(10, -decimals);
        CHECK(std::abs(integral.exact - known) <= integral.uncertainty + digits);
        // A figure is no check if the quadrature is not sure of its digits.
        CHECK(integral.uncertainty <= std::max(digits, known * 1e-4));
        CHECK(std::abs(integral.value - integral.exact) <=
              integral.uncertainty + analyze::allowed_error(function_, job));
    }

private:
    static ir::FunctionId find(const ir::Module& module, const std::string& name)
    {
        const auto id = module.find(name);
        INFO(name);
        REQUIRE(id);
        return *id;
    }

    EmittedFunction function_;
};

const std::vector<PhysicsRow>& rows_of(const std::string& model)
{
    static std::map<std::string, std::vector<PhysicsRow>> known;
    const auto place = known.find(model);
    if (place != known.end()) return place->second;
    const Emitted& emitted = emitted_model(model);
    return known.emplace(model, analyze::physics(emitted.module, emitted.sources, {}, {}))
        .first->second;
}

std::vector<PhysicsRow> rows_of_text(const std::string& text)
{
    const Emitted emitted = emitted_text(text);
    return analyze::physics(emitted.module, emitted.sources, {}, {});
}

const PhysicsRow& row(const std::vector<PhysicsRow>& rows, Law law, const std::string& subject,
                      const std::string& where = "")
{
    const auto found = std::ranges::find_if(rows, [&](const PhysicsRow& one) {
        return one.law == law && one.subject == subject && (where.empty() || one.where == where);
    });
    INFO(subject << " at " << where);
    REQUIRE(found != rows.end());
    return *found;
}

}  // namespace

TEST_CASE("Gauss-Legendre is exact for polynomials of degree 2 n - 1", "[physics]")
{
    const int order = GENERATE(1, 2, 4, 8, 16);
    const std::array ends{-1.0, 0.5, 2.0};
    const auto nodes = analyze::gauss_legendre(ends, order);
    REQUIRE(nodes.size() == 2 * static_cast<std::size_t>(order));
    for (int degree = 0; degree < 2 * order; ++degree) {
        double sum = 0, size = 0;
        for (const analyze::QuadratureNode& node : nodes) {
            sum += node.weight * std::pow(node.at, degree);
            size += node.weight * std::pow(std::abs(node.at), degree);
        }
        const double exact = (std::pow(2, degree + 1) - std::pow(-1, degree + 1)) / (degree + 1);
        CAPTURE(order, degree);
        // Nodes and weights are good to some units in the last place, of which a power has as
        // many times its degree.
        CHECK(std::abs(sum - exact) <= size * 0x1p-50 * (degree + 2));
    }
}

TEST_CASE("cells halve towards a narrow place and fill the interval", "[physics]")
{
    const std::array places{analyze::NarrowPlace{0.3, 0x1p-10}, analyze::NarrowPlace{1, 0x1p-4}};
    const std::vector<double> ends = analyze::graded_cells(0, 1, places);
    CHECK(ends.front() == 0);
    CHECK(ends.back() == 1);
    CHECK(std::ranges::is_sorted(ends));
    const auto at = std::ranges::find(ends, 0.3);
    REQUIRE(at != ends.end());
    CHECK(*(at + 1) - *at <= 0x1p-10);
    CHECK(*at - *(at - 1) <= 0x1p-10);
    CHECK(ends.size() < 40);
}

TEST_CASE("light nodes fill the hemisphere, facet nodes project to the disk", "[physics]")
{
    for (const double view : {1.0, 0.5, 0.02})
        for (const double alpha : {1.0, 0x1p-12})
            for (const bool symmetric : {true, false}) {
                double area = 0, projected = 0;
                for (const auto& node : analyze::light_nodes(view, alpha, symmetric, {})) {
                    area += node.weight;
                    projected += node.weight * node.direction.z;
                }
                CAPTURE(view, alpha, symmetric);
                CHECK(area == Approx(2 * pi).epsilon(1e-9));
                CHECK(projected == Approx(pi).epsilon(1e-9));
            }
    // For alpha = 1 they are the cosine itself, which integrates to pi.
    double projected = 0;
    for (const auto& node : analyze::facet_nodes(1, 1, {})) projected += node.weight;
    CHECK(projected == Approx(pi).epsilon(1e-12));
}

TEST_CASE("the shipped distributions of normals integrate to 1", "[physics][device][shipped]")
{
    const std::vector<PhysicsRow>& rows = rows_of("microfacet");
    std::size_t checked = 0;
    for (const PhysicsRow& one : rows) {
        if (one.law != Law::normalized) continue;
        // By design these are something else, see below.
        if (one.subject.find("mobile") != std::string::npos) continue;
        if (one.subject.find("clamped") != std::string::npos) continue;
        ++checked;
        CAPTURE(one.subject, one.value, one.note);
        CHECK(std::abs(one.exact - 1) <= one.uncertainty);
        CHECK(one.uncertainty <= 1e-6);
        CHECK(one.kept);
    }
    CHECK(checked >= 19);
    for (const char* alpha : {"0.25", "0.7", "1"}) {
        const PhysicsRow& mobile =
            row(rows, Law::normalized, "D_GGX_mobile, alpha = " + std::string{alpha});
        CHECK(!mobile.kept);
        CHECK(std::abs(mobile.exact - pi) <= mobile.uncertainty);
        CHECK(mobile.note == "the term is pi D: 3.1416");
    }
}

TEST_CASE("a distribution that is 1 % too bright is caught", "[physics][device]")
{
    const auto rows = rows_of_text(R"(
module broken
/// GGX, but for the factor.
term D_Broken(alpha: float in [1/64, 1], g: geometry) -> float =
  1.01 * alpha^2 / (pi * (g.cos_h^2 * (alpha^2 - 1) + 1)^2)
/// GGX.
term D_Whole(alpha: float in [1/64, 1], g: geometry) -> float =
  alpha^2 / (pi * (g.cos_h^2 * (alpha^2 - 1) + 1)^2)
)");
    std::size_t checked = 0;
    for (const PhysicsRow& one : rows) {
        if (one.law != Law::normalized) continue;
        CAPTURE(one.subject);
        const bool broken = one.subject.starts_with("D_Broken");
        CHECK(one.kept != broken);
        CHECK(std::abs(one.exact - (broken ? 1.01 : 1)) <= one.uncertainty);
        checked += broken;
    }
    CHECK(checked == 5);
}

TEST_CASE("a perfect mirror of GGX facets loses what is known", "[physics][device]")
{
    Furnace separable{emitted_model("callisto"), "callisto_lambert_specular"};
    separable.check(1, {{"roughness", 0.5}}, 0.915812, 6);
    separable.check(0.1, {{"roughness", 0.5}}, 0.854296, 6);
    separable.check(1, {{"roughness", 1}}, 1 - std::log(2.0), 12);
    separable.check(0.1, {{"roughness", 1}}, 0.557914, 6);
    const Emitted text = emitted_text(R"(
module correlated
import microfacet { D_GGX, V_SmithGGXCorrelated }
/// One lobe.
model mirror(g: geometry, s: surface) {
  specular = D_GGX(s.alpha, g) * V_SmithGGXCorrelated(s.alpha, g) * g.cos_i
}
)");
    Furnace correlated{text, "mirror_specular"};
    correlated.check(1, {{"roughness", 1}}, 0.306853, 6);
    correlated.check(0.1, {{"roughness", 1}}, 0.760210, 6);
}

TEST_CASE("Proxima loses what is known", "[physics][device]")
{
    Furnace proxima{emitted_model("callisto"), "callisto_diffuse"};
    for (const double roughness : {0.1, 0.5, 1.0}) {
        const double alpha = roughness * roughness;
        proxima.check(1, {{"roughness", roughness}}, 1 - 0.17 * alpha, 7);
        proxima.check(0.5, {{"roughness", roughness}}, 1 - 0.17393 * alpha, 5);
        proxima.check(0.1, {{"roughness", roughness}}, 1 - 0.13986 * alpha, 5);
        proxima.check(1e-4, {{"roughness", roughness}}, 1 - 0.12887 * alpha, 5);
    }
}

TEST_CASE("diffuse Fresnel and retroreflection gain what is known", "[physics][device]")
{
    Furnace lambert{emitted_model("callisto"), "callisto_lambert_diffuse"};
    struct Known {
        double gain;
        double albedo[3];
        int decimals[3];
    };
    const Known all[] = {{2, {1.0062, 1.0919, 1.1702}, {4, 4, 4}},
                         {4, {1.0187, 1.2764, 1.5124}, {4, 4, 4}},
                         {16, {1.0979, 2.4043, 3.6191}, {4, 4, 4}},
                         {256, {4.1954, 32.52, 64.95}, {4, 2, 2}}};
    for (const Known& known : all) {
        const Settings settings{{"diffuse_fresnel", known.gain}, {"retroreflection", known.gain}};
        lambert.check(1, settings, known.albedo[0], known.decimals[0]);
        lambert.check(0.4, settings, known.albedo[1], known.decimals[1]);
        lambert.check(0.01, settings, known.albedo[2], known.decimals[2]);
    }
}

TEST_CASE("the smooth terminator loses and gains what is known", "[physics][device]")
{
    Furnace lambert{emitted_model("callisto"), "callisto_lambert_diffuse"};
    const auto check = [&](double strength, double length, double normal, double grazing) {
        const Settings settings{{"smooth_terminator", strength},
                                {"smooth_terminator_length", length}};
        lambert.check(1, settings, normal, 5);
        lambert.check(0.1, settings, grazing, 5);
    };
    check(1, 0.5, 0.92864, 0.99441);
    check(1, 1, 0.70477, 0.89681);
    check(-1, 1, 1.29523, 1.10319);
}

TEST_CASE("Callisto as a whole gains energy, and the report says where", "[physics][device]")
{
    const std::vector<PhysicsRow>& rows = rows_of("callisto");
    struct Known {
        const char* subject;
        const char* where;
        double albedo;
    };
    for (const Known& known :
         {Known{"callisto_lambert", "n.v = 1", 1.0367},
          Known{"callisto_lambert", "n.v = 0.1", 1.1563},
          Known{"callisto_lambert", "n.v = 0.02", 1.1798}, Known{"callisto", "n.v = 1", 0.9942},
          Known{"callisto", "n.v = 0.1", 1.1213}, Known{"callisto", "n.v = 0.02", 1.1470}}) {
        const PhysicsRow& one =
            row(rows, Law::albedo,
                std::string{known.subject} + ", white dielectric, roughness = 0.5", known.where);
        CAPTURE(known.subject, known.where);
        CHECK(std::abs(one.exact - known.albedo) <= one.uncertainty + 0.5e-4);
        CHECK(one.kept == (known.albedo <= 1));
        CHECK((one.note.find("gains energy") == 0) == (known.albedo > 1));
    }
    // Specular alone does not.
    for (const PhysicsRow& one : rows)
        if (one.law == Law::albedo && one.subject.find("specular") < one.subject.find(',')) {
            CAPTURE(one.subject, one.where, one.value);
            CHECK(one.kept);
        }
    const PhysicsRow& gain =
        row(rows, Law::albedo, "callisto_lambert_diffuse, retroreflection = 256");
    CHECK(!gain.kept);
    CHECK(gain.note == "gains energy: 32.02 of what arrives");
}

TEST_CASE("light and view may be swapped where nothing softens the terminator", "[physics][device]")
{
    const std::vector<PhysicsRow>& rows = rows_of("callisto");
    std::size_t checked = 0;
    for (const PhysicsRow& one : rows) {
        if (one.law != Law::reciprocal) continue;
        ++checked;
        CAPTURE(one.subject, one.value, one.exact);
        // Proxima is not reciprocal, nor is anything under the smooth terminator.
        const bool reciprocal = !one.subject.starts_with("callisto_diffuse") &&
                                one.subject.find("smooth_terminator =") == std::string::npos;
        CHECK(one.kept == reciprocal);
        if (!reciprocal) CHECK(std::abs(one.value - one.exact) <= 0x1p-20);
    }
    CHECK(checked >= 30);

    // With v = n and the light at the least cosine of the suite: q = 1.
    const double cosine = 0.02;
    for (const double roughness : {0.5, 1.0}) {
        const double alpha = roughness * roughness;
        const double one = 1 - 0.55 * alpha + 0.19 * alpha / cosine;
        const double other = 1 - 0.36 * alpha;
        const PhysicsRow& proxima = row(rows, Law::reciprocal,
                                        roughness < 1 ? "callisto_diffuse, roughness = 0.5"
                                                      : "callisto_diffuse, roughness = 1");
        // Where the view is at this cosine, q falls short of 1 by no more than alpha lets it:
        // v.l is 0.02 there and above, so that it is 1.
        CHECK(std::abs(proxima.exact - (1 - other / one)) <= 0x1p-40);
        CHECK(proxima.exact >= (roughness < 1 ? 0.713 : 0.932));
    }
    // Known from samples, and bounded by the mask at v = n: 0.950379.
    const PhysicsRow& soft =
        row(rows, Law::reciprocal, "callisto_lambert_diffuse, smooth_terminator = 1");
    CHECK(soft.exact >= 0.945);
    CHECK(soft.exact <= 0.950379);
    const PhysicsRow& hard =
        row(rows, Law::reciprocal, "callisto_lambert_diffuse, smooth_terminator = -1");
    CHECK(hard.exact >= 0.486);
    CHECK(hard.exact <= 0.950379 / 1.950379);
}

TEST_CASE("nothing of Callisto is negative", "[physics][device][shipped]")
{
    for (const char* model : {"callisto", "microfacet"})
        for (const PhysicsRow& one : rows_of(model))
            if (one.law == Law::positive) {
                CAPTURE(one.subject, one.value, one.where);
                CHECK(one.kept);
            }
    // The fit of the environment is known to leave [0, 1].
    CHECK(!row(rows_of("ue4"), Law::positive, "EnvBRDFApprox_bias").kept);
}

TEST_CASE("an output that becomes negative is caught, and where", "[physics][device]")
{
    const auto rows = rows_of_text(R"(
module broken
/// Dark where the half vector is away from the normal.
model dip(g: geometry, s: surface) {
  diffuse = (g.cos_h - 0.25) * s.diffuse_color * g.cos_i
}
)");
    const PhysicsRow& dip = row(rows, Law::positive, "dip_diffuse");
    CHECK(!dip.kept);
    // l = n, v = -n: there is no half vector, so cos_h is 0, and cos_i is 1.
    CHECK(dip.value == -0.25);
    CHECK(dip.exact == -0.25);
    CHECK(dip.where.find("l = (") != std::string::npos);
}

TEST_CASE("without a device the evaluator's floats are asked", "[physics]")
{
    const Emitted& model = emitted_model("microfacet");
    analyze::PhysicsOptions options;
    options.execute = false;
    const auto rows = analyze::physics(model.module, model.sources, options, {});
    const PhysicsRow& ggx = row(rows, Law::normalized, "D_GGX, alpha = 0.25");
    CHECK(ggx.kept);
    CHECK(ggx.value != ggx.exact);
}

TEST_CASE("kept rows are the rows, for every number of threads", "[physics][device]")
{
    const Emitted& model = emitted_model("ue4");
    std::map<std::string, std::string> known;
    std::mutex mutex;
    int missed = 0;
    analyze::Store store;
    store.load = [&](std::string_view key) -> std::optional<std::string> {
        const std::lock_guard lock{mutex};
        const auto found = known.find(std::string{key});
        if (found != known.end()) return found->second;
        ++missed;
        return std::nullopt;
    };
    store.save = [&](std::string_view key, std::string_view value) {
        const std::lock_guard lock{mutex};
        known.emplace(key, value);
    };
    analyze::PhysicsOptions options;
    options.jobs = 1;
    const auto first = analyze::physics(model.module, model.sources, options, store);
    CHECK(missed > 0);
    missed = 0;
    options.jobs = 4;
    const auto again = analyze::physics(model.module, model.sources, options, store);
    CHECK(missed == 0);
    const auto anew = analyze::physics(model.module, model.sources, options, {});
    for (const auto* other : {&again, &anew}) {
        REQUIRE(other->size() == first.size());
        for (std::size_t i = 0; i < first.size(); ++i) {
            const PhysicsRow& a = first[i];
            const PhysicsRow& b = (*other)[i];
            CAPTURE(a.subject, b.subject);
            CHECK(a.subject == b.subject);
            CHECK(a.where == b.where);
            CHECK(a.value == b.value);
            CHECK(a.exact == b.exact);
            CHECK(a.uncertainty == b.uncertainty);
            CHECK(a.kept == b.kept);
            CHECK(a.note == b.note);
        }
    }
}
