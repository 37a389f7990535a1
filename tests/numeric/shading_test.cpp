// Models under lights: what shades is the light's outputs and the model's, put together; and lights
// stay where they belong at every place where a formula of theirs divides by nothing.
#include "compile.h"
#include "lights.h"
#include "numeric/library.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace lobe::tests {
namespace {

using Vector = std::array<double, 3>;

/// One light at one point.
struct Place {
    Vector to_light{0, 0, 4};
    Vector axis{1, 0, 0};
    double radius = 0;
    double half_length = 0;
    double inverse_range = 0;
    double cos_inner = 1;
    double cos_outer = 0.7;
    Vector v{0, 0, 1};
    Vector n{0, 0, 1};
    double roughness = 0.5;
};

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector unit(const Vector& a)
{
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

void add(Points& points, const std::string& name, const std::vector<Vector>& vectors)
{
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> column;
        for (const Vector& vector : vectors) column.push_back(vector[k]);
        points.emplace_back(name + "." + "xyz"[k], std::move(column));
    }
}

template <class Member>
auto column(const std::vector<Place>& places, Member member)
{
    std::vector<std::decay_t<decltype(places.front().*member)>> result;
    for (const Place& place : places) result.push_back(place.*member);
    return result;
}

/// The columns that a function reads, with `l` where it is asked for a geometry.
Points points_of(const ir::Module& module, const std::string& function,
                 const std::vector<Place>& places, const std::vector<Vector>& l)
{
    Points points;
    bool geometry = false;
    for (const ir::Input& input : module[*module.find(function)].inputs) {
        geometry |= input.origin == ir::Origin::geometry;
        if (input.name == "to_light") add(points, "to_light", column(places, &Place::to_light));
        if (input.name == "axis") add(points, "axis", column(places, &Place::axis));
        for (const auto& [name, member] :
             {std::pair{"radius", &Place::radius}, std::pair{"half_length", &Place::half_length},
              std::pair{"inverse_range", &Place::inverse_range},
              std::pair{"cos_inner", &Place::cos_inner}, std::pair{"cos_outer", &Place::cos_outer},
              std::pair{"roughness", &Place::roughness}})
            if (input.name == name) points.emplace_back(name, column(places, member));
        for (const auto& [name, value] : {std::pair{"diffuse_color", 0.5}, std::pair{"f0", 0.04}})
            if (input.name == name)
                points.emplace_back(name, std::vector<double>(places.size(), value));
    }
    if (points.empty() || geometry) {
        add(points, "l", l);
        add(points, "v", column(places, &Place::v));
        add(points, "n", column(places, &Place::n));
    }
    return points;
}

template <class Number = double>
std::vector<std::vector<Number>> at(const ir::Module& module, const std::string& function,
                                    const std::vector<Place>& places,
                                    std::optional<std::vector<Vector>> l = {})
{
    if (!l) l = column(places, &Place::n);
    return run<Number>(module, function, points_of(module, function, places, *l));
}

std::vector<Vector> vectors(const std::vector<std::vector<double>>& columns)
{
    std::vector<Vector> result;
    for (std::size_t i = 0; i < columns[0].size(); ++i)
        result.push_back({columns[0][i], columns[1][i], columns[2][i]});
    return result;
}

const std::string all_lights = "directional, point, punctual, spot, sphere, tube, capsule";

const ir::Module& scene()
{
    static const ir::Module module =
        compiled("module scene\nimport callisto { callisto, callisto_lambert }\nimport lights { " +
                 all_lights + " }\n");
    return module;
}

/// Anywhere within some lengths of the source, the eye above the horizon.
std::vector<Place> some_places(std::size_t count)
{
    std::mt19937 random{7};
    const auto between = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    const auto direction = [&] { return unit({between(-1, 1), between(-1, 1), between(-1, 1)}); };
    std::vector<Place> places;
    for (std::size_t i = 0; i < count; ++i) {
        Place place;
        place.to_light = {between(-5, 5), between(-5, 5), between(-5, 5)};
        place.axis = direction();
        place.radius = between(0, 3);
        place.half_length = between(0, 3);
        place.inverse_range = i % 3 == 0 ? 0 : between(0, 0.3);
        place.cos_outer = between(0, 0.9);
        place.cos_inner = between(place.cos_outer, 1);
        place.n = direction();
        do place.v = direction();
        while (dot(place.v, place.n) < 0.05);
        place.roughness = between(0.1, 1);
        places.push_back(place);
    }
    return places;
}

}  // namespace

TEST_CASE("what shades is the light's outputs and the model's", "[lights]")
{
    const std::vector<Place> places = some_places(500);
    const ir::Module& module = scene();
    REQUIRE(module.shadings.size() == 14);
    for (const ir::Shading& shading : module.shadings) {
        const std::string& name = module[shading.function].name;
        CAPTURE(name);
        const auto output = [&](const std::string& which, const char* otherwise) {
            const std::string& of = shading.light.name;
            const bool has = module.find(of + "_" + which).has_value();
            return has ? of + "_" + which : of + "_" + otherwise;
        };
        const auto l = vectors(at(module, output("direction", ""), places));
        const auto mirrored =
            vectors(at(module, output("specular_direction", "direction"), places));
        const auto irradiance = at(module, output("irradiance", ""), places)[0];
        std::vector<double> gain(places.size(), 1);
        if (module.find(shading.light.name + "_specular_gain"))
            gain = at(module, shading.light.name + "_specular_gain", places)[0];
        const auto diffuse = at(module, shading.model.name + "_diffuse", places, l);
        const auto specular = at(module, shading.model.name + "_specular", places, mirrored);
        const auto whole = at(module, name, places);
        REQUIRE(whole.size() == 3);
        for (std::size_t i = 0; i < places.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const double expected = irradiance[i] * (diffuse[k][i] + gain[i] * specular[k][i]);
                CAPTURE(i, k);
                // A few roundings of doubles, of what is summed.
                CHECK(whole[k][i] == Approx(expected).epsilon(1e-12).margin(1e-15));
            }
    }
}

TEST_CASE("lights joined to a module are those that a file imports", "[lights]")
{
    Sources sources;
    const ir::Module joined = middle(
        with_lights(definition("callisto"), {"sphere", "point", "no_light"}, sources, "callisto"));
    const ir::Module written =
        compiled("module scene\nimport callisto { callisto }\nimport lights { point, sphere }\n");
    REQUIRE(joined.shadings.size() == 2);
    for (const char* name : {"shade_callisto_point", "shade_callisto_sphere"}) {
        const auto a = joined.find(name);
        const auto b = written.find(name);
        REQUIRE(a);
        REQUIRE(b);
        const std::vector<Place> places = some_places(50);
        CHECK(at(joined, name, places) == at(written, name, places));
        CHECK(joined[*a].inputs.size() == written[*b].inputs.size());
    }
    // No light that was not asked for, nor what only that one calls.
    CHECK(!joined.find("tube_direction"));
    CHECK(!joined.find("line_irradiance"));
    CHECK(joined.find("closest_on_sphere"));
    CHECK(light_names() == std::vector<std::string>{"directional", "point", "punctual", "spot",
                                                    "sphere", "tube", "capsule"});
}

TEST_CASE("a light whose functions have taken names brings them under its own", "[lights]")
{
    const ir::Module module = module_of(R"(
module taken
/// Ours.
term falloff(x: unit) -> unit = x / 2
model matte(g: geometry) { diffuse = falloff(g.cos_i) }
)");
    Sources sources;
    const ir::Module joined = middle(with_lights(module, {"point"}, sources));
    REQUIRE(joined.find("lights_falloff"));
    Place place;
    place.to_light = {0, 0, 1};
    // The model's falloff halves; the light's is 1 / (1 + 1).
    CHECK(at(joined, "shade_matte_point", {place})[0][0] == Approx(0.25));
}

TEST_CASE("a light without an extent is the one with less of it", "[lights]")
{
    std::vector<Place> places = some_places(200);
    const ir::Module& module = optimized("lights");
    const auto same = [&](const std::string& a, const std::string& b) {
        CAPTURE(a, b);
        const auto of_a = at(module, a, places);
        const auto of_b = at(module, b, places);
        for (std::size_t k = 0; k < of_a.size(); ++k)
            for (std::size_t i = 0; i < places.size(); ++i)
                CHECK(of_a[k][i] == Approx(of_b[k][i]).epsilon(1e-12).margin(1e-14));
    };
    for (Place& place : places) place.radius = 0;
    same("sphere_specular_direction", "point_direction");
    same("sphere_irradiance", "point_irradiance");
    same("capsule_specular_direction", "tube_specular_direction");
    same("capsule_specular_gain", "tube_specular_gain");
    for (Place& place : places) {
        place.half_length = 0;
        place.radius = 1;
    }
    same("tube_direction", "point_direction");
    same("tube_irradiance", "point_irradiance");
    same("tube_specular_direction", "point_direction");
    same("capsule_specular_direction", "sphere_specular_direction");
    same("capsule_specular_gain", "sphere_specular_gain");
    const auto gains = at(module, "tube_specular_gain", places);
    for (const double gain : gains[0]) CHECK(gain == 1);
}

TEST_CASE("lights in float have values where their formulas have none", "[lights][hard]")
{
    const Vector zero{0, 0, 0};
    const Vector slanted = unit({0.6, 0.1, 0.7});
    std::vector<Place> places;
    for (const Vector& to_light :
         {zero, Vector{0, 0, 4}, Vector{0, 0, -4}, Vector{3, 0, 0}, Vector{0, 0, 1e-30},
          Vector{1e-23, 0, 1e-23}, Vector{0x1p24, 0x1p24, 0x1p24}, Vector{0, 0, 0x1p24},
          Vector{0x1p-149, 0, 0}, Vector{2.1, 0.35, 2.45}})
        for (const double radius : {0.0, 0x1p-149, 1e-20, 0.5, 4.0, 4096.0})
            for (const double half_length : {0.0, 0x1p-149, 1e-20, 0.5, 4.0, 4096.0})
                for (const Vector& axis : {Vector{0, 0, 1}, Vector{1, 0, 0}, slanted})
                    for (const Vector& v : {Vector{0, 0, 1}, slanted, Vector{0, 1, 0}})
                        for (const double inverse_range : {0.0, 1e-38, 0.25, 4096.0}) {
                            Place place;
                            place.to_light = to_light;
                            place.radius = radius;
                            place.half_length = half_length;
                            place.axis = axis;
                            place.v = v;
                            place.inverse_range = inverse_range;
                            place.cos_inner = place.cos_outer = radius < 1 ? 0.5 : 1;
                            place.roughness = 1.0 / 64;
                            places.push_back(place);
                        }
    const ir::Module& module = optimized("lights");
    for (const ir::Model& light : module.lights)
        for (const ir::ModelOutput& output : light.outputs) {
            const std::string& name = module[output.function].name;
            CAPTURE(name);
            const bool is_direction = module[output.function].type() == ir::Type::vec3;
            const auto results = at<float>(module, name, places);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < places.size(); ++i) {
                double length = 0;
                for (const auto& component : results) {
                    wrong += !std::isfinite(component[i]);
                    length += static_cast<double>(component[i]) * component[i];
                }
                // A direction has length 1 or less, but for roundings; everything else is
                // promised to be a factor.
                if (is_direction) wrong += length > 1 + 1e-6;
                if (!is_direction) wrong += results[0][i] < 0 || results[0][i] > 10000;
            }
            CHECK(wrong == 0);
        }
}

TEST_CASE("where the notes have 0 / 0 the lights have the limit", "[lights][hard]")
{
    const ir::Module& module = optimized("lights");
    const auto direction = [&](const std::string& light, const Place& place) {
        return vectors(at(module, light + "_specular_direction", {place}))[0];
    };
    // The ray through the center: of any radius, the center.
    Place place;
    for (const double radius : {0.0, 0.5, 10.0}) {
        place.radius = radius;
        CHECK(direction("sphere", place) == Vector{0, 0, 1});
    }
    // A ray along the tube sees all of it alike: the middle.
    place = {};
    place.axis = {0, 0, 1};
    place.to_light = {1, 0, 4};
    place.half_length = 2;
    const Vector middle = unit({1, 0, 4});
    CHECK(direction("tube", place)[0] == Approx(middle[0]));
    CHECK(direction("tube", place)[2] == Approx(middle[2]));
    // Nearly along it: equation 19 as printed has lost all digits here; the nearest point is known.
    // The ray (0, 0, 1) and the axis (s, 0, 1): the tube's point over the ray's axis, at -1 / s.
    for (const double s : {1e-3, 1e-5, 1e-7}) {
        Place near = place;
        near.axis = unit({s, 0, 1});
        near.to_light = {s / 2, 0, 4};
        const auto results = at<float>(module, "tube_specular_direction", {near});
        CAPTURE(s);
        // At -1/2 of the axis the tube meets the ray: straight on.
        CHECK(std::abs(results[0][0]) <= 2 * 0x1p-24 * s + 1e-9);
        CHECK(results[2][0] == Approx(1).epsilon(1e-6));
    }
    // The light is the point: no direction, and the falloff's own value.
    place = {};
    place.to_light = {0, 0, 0};
    for (const char* light : {"point", "punctual", "sphere"}) {
        const auto of = vectors(at(module, std::string{light} + "_direction", {place}))[0];
        CHECK(of == Vector{0, 0, 0});
    }
    CHECK(at(module, "point_irradiance", {place})[0][0] == 1);
    CHECK(at(module, "punctual_irradiance", {place})[0][0] == 10000);
    // Between a tube's ends, on it, where |l0| |l1| + l0.l1 cancels: its light cancels too.
    place.half_length = 2;
    CHECK(at(module, "tube_irradiance", {place})[0][0] == 0);
    // A spot's two angles may be one.
    place = {};
    place.axis = {0, 0, -1};
    place.cos_inner = place.cos_outer = 0.5;
    CHECK(at(module, "spot_irradiance", {place})[0][0] == Approx(1.0 / 16));
    place.axis = {0, 0, 1};
    CHECK(at(module, "spot_irradiance", {place})[0][0] == 0);
}

}  // namespace lobe::tests
