// Every row of data/karis.csv that is about lights, held against models/lights.lobe; and what holds
// of the shipped lights wherever their formulas divide by nothing.
#include "numeric/library.h"
#include "numeric/table.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <sstream>

namespace lobe::tests {
namespace {

/// `L0`, `distance` to one number or three.
using Given = std::map<std::string, std::vector<std::string>>;

Given given(const Row& row)
{
    Given result;
    std::istringstream text{row.at("inputs")};
    for (std::string item; std::getline(text, item, ';');) {
        const std::size_t equals = item.find('=');
        std::string value = item.substr(equals + 1);
        if (value.front() == '(') value = value.substr(1, value.size() - 2);
        std::istringstream numbers{value};
        for (std::string number; numbers >> number;)
            result[item.substr(0, equals)].push_back(number);
    }
    return result;
}

void put(Inputs& inputs, const std::string& name, const std::vector<std::string>& vector)
{
    for (std::size_t k = 0; k < 3; ++k) inputs[name + "." + "xyz"[k]] = vector[k];
}

/// (a + b) / 2 and (b - a) / 2
std::vector<std::string> middle_of(const std::vector<std::string>& a,
                                   const std::vector<std::string>& b)
{
    std::vector<std::string> result;
    for (std::size_t k = 0; k < 3; ++k) result.push_back(product(sum(a[k], b[k]), "0.5"));
    return result;
}

std::vector<std::string> half_way(const std::vector<std::string>& a,
                                  const std::vector<std::string>& b)
{
    std::vector<std::string> result;
    for (std::size_t k = 0; k < 3; ++k)
        result.push_back(product(sum(b[k], product(a[k], "-1")), "0.5"));
    return result;
}

// The table prints 20 significant digits: the last one may be off by a half. Zeros are exact.
constexpr Tolerance printed{0.5e-19, 0.5e-19};
// Some tens of roundings of doubles; a power of 256 multiplies those of its base by that.
constexpr Tolerance of_doubles{1e-13, 1e-15};

using ToInputs = std::function<Inputs(const Given&)>;

const std::vector<Row>& table()
{
    static const std::vector<Row> rows = read_table("data/karis.csv");
    return rows;
}

/// Holds `count` rows of a formula against a function; of rows of components, `l.x`, each against
/// the component it names.
void hold(const std::string& formula, const std::string& output, std::size_t count,
          const ir::Module& module, const std::string& function, const ToInputs& to_inputs,
          const std::string& equation = "")
{
    std::vector<Row> rows;
    for (const Row& row : table())
        if (row.at("formula") == formula && row.at("output").starts_with(output) &&
            (equation.empty() || row.at("eq") == equation))
            rows.push_back(row);
    CAPTURE(formula, output, function);
    REQUIRE(rows.size() == count);
    std::vector<Inputs> inputs;
    for (const Row& row : rows) inputs.push_back(to_inputs(given(row)));
    for (const auto& [number, tolerance] :
         {std::pair{"double", of_doubles}, std::pair{"mpfr:200", printed}}) {
        const auto results = evaluate(module, function, inputs, number);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::string& name = rows[i].at("output");
            const std::size_t component =
                results[i].size() == 1 ? 0 : std::string{"xyz"}.find(name.back());
            const std::string& expected = rows[i].at("value");
            const std::string& computed = results[i].at(component);
            const Distance off = distance(computed, expected);
            CAPTURE(rows[i].at("id"), rows[i].at("inputs"), name, expected, computed, number);
            CAPTURE(shown(off.relative), shown(off.absolute));
            CHECK(within(off, tolerance));
        }
    }
}

/// What the notes derive lights from, and parts of what is shipped.
const char* const derivations = R"(
module derivations
import lights { closest_on_sphere, line_vector, line_irradiance, along_tube, along_tube_least_angle }

term center_to_ray(to_light: float3 in [-100, 100], r: direction) -> float3 =
  closest_on_sphere(to_light, r, 4096) - to_light
term I_point(p: float in [1, 1000], phi_r: float in [0, 1.5]) -> float =
  (p + 2) / (2 * pi) * max(cos(phi_r), 0)^p
term I_sphere(p: float in [1, 1000], phi_r: float in [0, 1.6], phi_s: unit) -> float =
  (p + 2) / (2 * pi) * max(cos(max(phi_r - phi_s, 0)), 0)^p
term of_line(l0: float3 in [-100, 100], l1: float3 in [-100, 100], n: direction) -> float {
  let vector = line_vector(l0, l1)
  dot(n, vector) / (length(l0) * length(l1) * dot(vector, vector)) else 0
}
term of_element(l: float3 in [-100, 100], n: direction) -> float = dot(n, l) / length(l)^3 else 0
term softened(l0: float3 in [-100, 100], l1: float3 in [-100, 100], n: direction) -> float =
  line_irradiance(l0, l1) * max(dot(n, normalize(line_vector(l0, l1))), 0)
term t_nearest(l0: float3 in [-100, 100], l1: float3 in [-100, 100], r: direction) -> float {
  let along = along_tube((l0 + l1) / 2, normalize(l1 - l0), r, 4096)
  1 / 2 + (along / length(l1 - l0) else 0)
}
term t_least_angle(l0: float3 in [-100, 100], l1: float3 in [-100, 100], r: direction) -> float {
  let along = along_tube_least_angle((l0 + l1) / 2, normalize(l1 - l0), r, 4096)
  1 / 2 + (along / length(l1 - l0) else 0)
}
term of_least_angle(l0: float3 in [-100, 100], l1: float3 in [-100, 100], r: direction) -> direction =
  normalize(l0 + saturate(t_least_angle(l0, l1, r)) * (l1 - l0))
)";

const ir::Module& derived()
{
    static const ir::Module module = compiled(derivations);
    return module;
}

const ir::Module& lights() { return optimized("lights"); }

Inputs in_alpha(const Given& row)
{
    return {{"alpha", row.at("alpha")[0]},
            {"source_radius", row.at("sourceRadius")[0]},
            {"distance", row.at("distance")[0]}};
}

Inputs on_ray(const Given& row)
{
    Inputs inputs;
    put(inputs, "to_light", row.at("L"));
    put(inputs, "r", row.at("r"));
    return inputs;
}

/// The eye on the normal: there it is its own mirror image.
Inputs seen_along_ray(const Given& row)
{
    Inputs inputs;
    put(inputs, "to_light", row.at("L"));
    for (const char* vector : {"l", "v", "n"}) put(inputs, vector, row.at("r"));
    inputs["radius"] = row.at("sourceRadius")[0];
    return inputs;
}

Inputs of_ends(const Given& row)
{
    Inputs inputs;
    put(inputs, "l0", row.at("L0"));
    put(inputs, "l1", row.at("L1"));
    put(inputs, "n", row.at("n"));
    return inputs;
}

Inputs of_ends_on_ray(const Given& row)
{
    Inputs inputs;
    put(inputs, "l0", row.at("L0"));
    put(inputs, "l1", row.at("L1"));
    put(inputs, "r", row.at("r"));
    return inputs;
}

/// A tube whose unit of length along the axis is half of it, which equation 19 does not mind.
Inputs of_tube(const Given& row)
{
    Inputs inputs;
    put(inputs, "to_light", middle_of(row.at("L0"), row.at("L1")));
    put(inputs, "axis", half_way(row.at("L0"), row.at("L1")));
    for (const char* vector : {"l", "v", "n"}) put(inputs, vector, row.at("r"));
    inputs["half_length"] = "1";
    return inputs;
}

/// Simpson's rule over [low, high].
double integral(double low, double high, std::size_t intervals,
                const std::function<std::vector<double>(const std::vector<double>&)>& f)
{
    std::vector<double> at;
    const double step = (high - low) / static_cast<double>(intervals);
    for (std::size_t i = 0; i <= intervals; ++i) at.push_back(low + step * static_cast<double>(i));
    const std::vector<double> values = f(at);
    double total = values.front() + values.back();
    for (std::size_t i = 1; i < intervals; ++i) total += (i % 2 == 1 ? 4 : 2) * values[i];
    return total * step / 3;
}

double number_of(const std::string& text) { return std::stod(text); }

}  // namespace

TEST_CASE("falloff, widths and energies agree with karis.csv")
{
    hold("falloff", "falloff", 5, lights(), "falloff", [](const Given& row) {
        return Inputs{{"distance_squared", square(row.at("distance")[0])},
                      {"inverse_range", quotient("1", row.at("lightRadius")[0])}};
    });
    hold("alpha_prime", "alpha_prime", 4, lights(), "alpha_prime", in_alpha);
    hold("SphereNormalization", "norm", 4, lights(), "SphereNormalization", in_alpha);
    hold("LineNormalization", "norm", 4, lights(), "LineNormalization", in_alpha);
}

TEST_CASE("a sphere's representative point agrees with karis.csv")
{
    hold("sphere_light", "closestPoint", 12, lights(), "closest_on_sphere", [](const Given& row) {
        Inputs inputs = on_ray(row);
        inputs["radius"] = row.at("sourceRadius")[0];
        return inputs;
    });
    hold("sphere_light", "l.", 12, lights(), "sphere_specular_direction", seen_along_ray);
    hold("sphere_light", "centerToRay", 12, derived(), "center_to_ray", on_ray);
}

TEST_CASE("a tube's irradiance and representative points agree with karis.csv")
{
    hold("tube irradiance closed form", "value", 4, derived(), "of_line", of_ends);
    hold("tube irradiance (UE4 form)", "irradiance", 4, derived(), "softened", of_ends);
    hold("tube t", "t", 3, derived(), "t_nearest", of_ends_on_ray, "Eq19");
    hold("tube t", "t", 4, derived(), "t_least_angle", of_ends_on_ray, "Eq18");
    hold("tube l (Eq17) from Eq19", "l.", 10, lights(), "tube_specular_direction", of_tube);
    hold("tube l (Eq17) from Eq18", "l.", 10, derived(), "of_least_angle", of_ends_on_ray);
}

TEST_CASE("a tube's irradiance is the integral over its points")
{
    std::size_t held = 0;
    for (const Row& row : table()) {
        const bool of_length = row.at("formula") == "tube irradiance integral over arc length";
        if (!of_length && row.at("formula") != "tube irradiance integral over unit parameter")
            continue;
        const Given ends = given(row);
        std::array<double, 3> from{}, along{}, n{};
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            from[k] = number_of(ends.at("L0")[k]);
            along[k] = number_of(ends.at("L1")[k]) - from[k];
            n[k] = number_of(ends.at("n")[k]);
            squared += along[k] * along[k];
        }
        const double value = integral(0, 1, 4096, [&](const std::vector<double>& at) {
            Points points;
            for (std::size_t k = 0; k < 3; ++k) {
                std::vector<double> column;
                for (const double t : at) column.push_back(from[k] + t * along[k]);
                points.emplace_back(std::string{"l."} + "xyz"[k], std::move(column));
                points.emplace_back(std::string{"n."} + "xyz"[k],
                                    std::vector<double>(at.size(), n[k]));
            }
            return run<double>(derived(), "of_element", points).front();
        });
        CAPTURE(row.at("id"));
        // Simpson's error here is below 1e-12: the fourth derivative of 1/d^2 at d >= 1 and
        // lengths up to 6 is below 5!/d^6 6^4 = 2e5, over 180 4096^4.
        CHECK(value * (of_length ? std::sqrt(squared) : 1) ==
              Approx(number_of(row.at("value"))).epsilon(1e-11));
        ++held;
    }
    CHECK(held == 6);
}

TEST_CASE("the notes' own measure of a sphere's widening agrees with karis.csv")
{
    hold("I_point", "I", 16, derived(), "I_point", [](const Given& row) {
        return Inputs{{"p", row.at("p")[0]}, {"phi_r", row.at("phi_r")[0]}};
    });
    hold("I_sphere", "I", 16, derived(), "I_sphere", [](const Given& row) {
        return Inputs{
            {"p", row.at("p")[0]}, {"phi_r", row.at("phi_r")[0]}, {"phi_s", row.at("phi_s")[0]}};
    });

    std::size_t held = 0;
    for (const Row& row : table()) {
        const bool with_cosine =
            row.at("formula") == "I_sphere hemisphere integral (times cos phi_r)";
        if (!with_cosine && row.at("formula") != "I_sphere hemisphere integral (no cosine)")
            continue;
        const Given inputs = given(row);
        const double pi = std::acos(-1.0);
        const double phi_s = number_of(inputs.at("phi_s")[0]);
        const auto ring = [&](const std::vector<double>& at) {
            const std::size_t size = at.size();
            std::vector<double> values =
                run<double>(derived(), "I_sphere",
                            {{"p", std::vector<double>(size, number_of(inputs.at("p")[0]))},
                             {"phi_r", at},
                             {"phi_s", std::vector<double>(size, phi_s)}})
                    .front();
            for (std::size_t i = 0; i < size; ++i)
                values[i] *= 2 * pi * std::sin(at[i]) * (with_cosine ? std::cos(at[i]) : 1);
            return values;
        };
        // In two parts, for the integrand bends at phi_s.
        double value = integral(phi_s, pi / 2, 4096, ring);
        if (phi_s > 0) value += integral(0, phi_s, 4096, ring);
        CAPTURE(row.at("id"));
        CHECK(value == Approx(number_of(row.at("value"))).epsilon(1e-9));
        ++held;
    }
    CHECK(held == 8);
}

}  // namespace lobe::tests
