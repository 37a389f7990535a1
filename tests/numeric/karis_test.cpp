// Every row of data/karis.csv: either held against a shipped term, or listed as not in this
// edition. The counts are exact, so no row can drop out unseen.
#include "numeric/library.h"
#include "numeric/table.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

namespace lobe::tests {
namespace {

/// How a formula of the table is asked of a model. `inputs` maps the table's names to ours; an
/// alpha asked of a roughness is its square.
struct Formula {
    std::string name;
    std::string output;  ///< of those that have several; else empty
    std::size_t rows;
    std::string model;
    std::string term;
    std::vector<std::pair<std::string, std::string>> inputs;
    /// Results the doubles of the inputs cannot hold better, see the entries.
    Tolerance double_tolerance{1e-12, 0};
    double changed = 0;  ///< by the passes, over the reals, relative
};

// Below the smallest normal double the result is a denormal or 0.
constexpr Tolerance underflowing{1e-12, 0x1p-1022};
// The logarithm of a cosine near 1 is another by 2^-31 (optimize/near_one.cpp). The narrowest lobe
// that a row has near 1, roughness 0.3 at cos_h 0.999, is 1/4 of a logarithm below its peak.
constexpr double near_one = 0x1p-33;
constexpr Tolerance near_one_in_double{1e-12 + near_one, 0x1p-1022};

const std::vector<std::pair<std::string, std::string>> of_h{{"roughness", "alpha"},
                                                            {"NoH", "cos_h"}};
const std::vector<std::pair<std::string, std::string>> of_vectors{{"l", "l"}, {"v", "v"}};
const std::vector<std::pair<std::string, std::string>> of_alpha{
    {"l", "l"}, {"v", "v"}, {"roughness", "alpha"}};
const std::vector<std::pair<std::string, std::string>> of_theta{{"roughness", "alpha"},
                                                                {"NoV", "cos_theta"}};
const std::vector<std::pair<std::string, std::string>> of_f0{{"F0", "f0"}, {"VoH", "cos_d"}};
const std::vector<std::pair<std::string, std::string>> of_material{
    {"BaseColor", "base_color"}, {"Metallic", "metallic"}, {"Specular", "specular"}};
const std::vector<std::pair<std::string, std::string>> of_view{{"roughness", "roughness"},
                                                               {"NoV", "cos_o"}};

const std::vector<Formula> formulas{
    {"D_Blinn", "", 23, "microfacet", "D_BlinnPhong", of_h, near_one_in_double, near_one},
    {"D_Beckmann", "", 23, "microfacet", "D_Beckmann", of_h, underflowing},
    {"D_GGX", "", 23, "microfacet", "D_GGX", of_h},
    {"D_GGXaniso",
     "",
     5,
     "microfacet",
     "D_GGX_anisotropic",
     {{"alpha_x", "alpha_x"}, {"alpha_y", "alpha_y"}, {"m", "m"}}},
    {"GGX_Mobile", "", 20, "microfacet", "D_GGX_mobile", of_h},
    {"G_Implicit", "", 5, "microfacet", "G_Implicit", of_vectors},
    {"G_Neumann", "", 5, "microfacet", "G_Neumann", of_vectors},
    {"G_CookTorrance", "", 5, "microfacet", "G_CookTorrance", of_vectors},
    {"G_Kelemen", "", 5, "microfacet", "G_Kelemen", of_vectors},
    {"G_SmithBeckmann_approx", "", 16, "microfacet", "G_SmithBeckmann", of_alpha},
    {"G_SmithGGX", "", 16, "microfacet", "G_SmithGGX", of_alpha},
    {"G_Schlick_Beckmann k=a*sqrt(2/pi)", "", 16, "microfacet", "G_SchlickBeckmann", of_alpha},
    {"G_Schlick_UE4 k=a/2", "", 16, "microfacet", "G_SchlickGGX", of_alpha},
    {"G_Schlick_analytic k=(r+1)^2/8",
     "",
     16,
     "microfacet",
     "G_SchlickGGX_analytic",
     {{"l", "l"}, {"v", "v"}, {"roughness", "roughness"}}},
    {"G1_Beckmann_approx", "", 17, "microfacet", "G1_SmithBeckmann", of_theta},
    {"G1_GGX", "", 17, "microfacet", "G1_SmithGGX", of_theta},
    {"G1_Schlick k=a*sqrt(2/pi)", "", 17, "microfacet", "G1_SchlickBeckmann", of_theta},
    {"G1_Schlick k=a/2", "", 17, "microfacet", "G1_SchlickGGX", of_theta},
    {"G1_Schlick k=(r+1)^2/8",
     "",
     17,
     "microfacet",
     "G1_SchlickGGX_analytic",
     {{"roughness", "roughness"}, {"NoV", "cos_theta"}}},
    {"Vis_SmithGGX_hlsl", "", 16, "microfacet", "V_SmithGGX", of_alpha},
    {"F_None", "", 17, "microfacet", "F_None", {{"F0", "f0"}}},
    {"F_Schlick", "", 17, "microfacet", "F_Schlick", of_f0},
    {"F_SphericalGaussian", "", 17, "microfacet", "F_Schlick.spherical_gaussian", of_f0},
    // At F0 = 0 the table holds the rounding of its own 50 digits, 3e-80; the term has 0.
    {"F_CookTorrance", "", 17, "microfacet", "F_CookTorrance", of_f0, {1e-12, 1e-79}},
    {"Lambert", "", 1, "microfacet", "Diffuse_Lambert", {{"c", "diffuse_color"}}},
    {"DiffuseColor",
     "",
     3,
     "ue4",
     "DiffuseColor",
     {{"BaseColor", "base_color"}, {"Metallic", "metallic"}}},
    {"SpecularColor", "", 3, "ue4", "SpecularColor", of_material},
    {"EnvBRDFApprox", "A", 20, "ue4", "EnvBRDFApprox_scale", of_view},
    {"EnvBRDFApprox", "B", 20, "ue4", "EnvBRDFApprox_bias", of_view},
    {"EnvBRDFApprox result",
     "",
     60,
     "ue4",
     "EnvBRDFApprox",
     {{"roughness", "roughness"}, {"NoV", "cos_o"}, {"SpecularColor", "f0"}}},
    {"CalcSpecular",
     "",
     20,
     "ue4",
     "specular_mobile",
     {{"roughness", "roughness"}, {"NoH", "cos_h"}}},
};

/// Formulas that a test case of their own uses, those of lights in lights_test.cpp, and those of
/// environments in tests/analyze/environment_test.cpp.
const std::vector<std::pair<std::string, std::size_t>> composed{
    {"GGX_Mobile unclamped", 20},
    {"geometry", 11},
    {"specular_full (Eq2: D3*F5*G4/(4 NoL NoV)) - F0=0.04", 16},
    {"G1_Beckmann_exact_erf", 17},
    {"IntegrateBRDF exact - G=Schlick k=alpha/2", 40},
    {"Hammersley N=1024", 12},
    {"ImportanceSampleGGX tangent space", 36},
    {"IntegrateBRDF 1024-sample Hammersley - k=alpha/2", 40},
    {"IntegrateBRDF exact - G=Schlick k=(r+1)^2/8 (wrong for IBL)", 40},
    {"IntegrateBRDF exact - G=Smith GGX height-correlated", 40},
    {"IntegrateBRDF exact - G=Smith GGX separable", 40},
    {"I_point", 16},
    {"I_sphere", 16},
    {"I_sphere hemisphere integral (no cosine)", 4},
    {"I_sphere hemisphere integral (times cos phi_r)", 4},
    {"LineNormalization", 4},
    {"SphereNormalization", 4},
    {"alpha_prime", 4},
    {"falloff", 5},
    {"sphere_light", 36},
    {"tube irradiance (UE4 form)", 4},
    {"tube irradiance closed form", 4},
    {"tube irradiance integral over arc length", 3},
    {"tube irradiance integral over unit parameter", 3},
    {"tube l (Eq17) from Eq18", 10},
    {"tube l (Eq17) from Eq19", 10},
    {"tube t", 7},
};

/// The exact Smith-Beckmann G, which no model ships: its G1 is used above, to measure the
/// approximation's.
const std::vector<std::pair<std::string, std::size_t>> out_of_scope{
    {"G_SmithBeckmann_exact_erf", 16},
};

const std::vector<Row>& table()
{
    static const std::vector<Row> rows = read_table("data/karis.csv");
    return rows;
}

std::vector<Row> rows_of(const std::string& formula, const std::string& output = "")
{
    std::vector<Row> rows;
    for (const Row& row : table())
        if (row.at("formula") == formula && (output.empty() || row.at("output") == output))
            rows.push_back(row);
    return rows;
}

/// `a=1;l=(0.6 0 0.8)` with our names: `a`, and `l.x`, `l.y`, `l.z`.
Inputs inputs_of(const Row& row, const std::vector<std::pair<std::string, std::string>>& names)
{
    Inputs inputs;
    std::istringstream text{row.at("inputs")};
    for (std::string item; std::getline(text, item, ';');) {
        const std::size_t equals = item.find('=');
        const std::string name = item.substr(0, equals);
        const std::string value = item.substr(equals + 1);
        for (const auto& [theirs, ours] : names) {
            if (theirs != name) continue;
            if (value.front() == '(') {
                std::istringstream vector{value.substr(1, value.size() - 2)};
                std::string x, y, z;
                vector >> x >> y >> z;
                // A half vector given outright stands in the tangent frame's own axes.
                const bool half = ours == "m";
                inputs[half ? "x_dot_h" : ours + ".x"] = x;
                inputs[half ? "y_dot_h" : ours + ".y"] = y;
                inputs[half ? "cos_h" : ours + ".z"] = z;
            } else {
                inputs[ours] = ours == "alpha" ? square(value) : value;
            }
        }
    }
    return inputs;
}

std::vector<Inputs> all_inputs(const std::vector<Row>& rows,
                               const std::vector<std::pair<std::string, std::string>>& names)
{
    std::vector<Inputs> inputs;
    for (const Row& row : rows) inputs.push_back(inputs_of(row, names));
    return inputs;
}

void compare(const Formula& formula, const ir::Module& module, const std::string& number,
             Tolerance tolerance)
{
    const auto rows = rows_of(formula.name, formula.output);
    CAPTURE(formula.name, formula.output, number);
    REQUIRE(rows.size() == formula.rows);
    const auto results = evaluate(module, formula.term, all_inputs(rows, formula.inputs), number);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const std::string& computed : results[i]) {
            const std::string& expected = rows[i].at("value");
            const Distance off = distance(computed, expected);
            CAPTURE(rows[i].at("id"), rows[i].at("inputs"), expected, computed);
            CAPTURE(shown(off.relative), shown(off.absolute));
            CHECK(within(off, tolerance));
        }
}

// The table prints 20 significant digits: the last one may be off by a half.
constexpr double printed = 0.5e-19;

}  // namespace

TEST_CASE("every row of karis.csv is used or named as out of scope")
{
    std::size_t accounted = 0;
    for (const Formula& formula : formulas) {
        CAPTURE(formula.name, formula.output);
        CHECK(rows_of(formula.name, formula.output).size() == formula.rows);
        accounted += formula.rows;
    }
    std::size_t used = accounted;
    for (const auto& [name, rows] : composed) {
        CAPTURE(name);
        CHECK(rows_of(name).size() == rows);
        used += rows;
    }
    accounted = used;
    for (const auto& [name, rows] : out_of_scope) {
        CAPTURE(name);
        CHECK(rows_of(name).size() == rows);
        accounted += rows;
    }
    CHECK(accounted == table().size());
    CHECK(table().size() == 952);
    WARN("karis.csv: " << used << " of " << table().size() << " rows are held against terms; "
                       << table().size() - used << " are about the exact Smith-Beckmann G");
}

TEST_CASE("terms agree with karis.csv in double")
{
    for (const Formula& formula : formulas)
        compare(formula, optimized(formula.model), "double", formula.double_tolerance);
}

TEST_CASE("definitions agree with karis.csv to the digits printed")
{
    for (const Formula& formula : formulas)
        compare(formula, definition(formula.model), "mpfr:200",
                {printed, formula.name == "F_CookTorrance" ? 1e-79 : 0});
}

TEST_CASE("the passes keep what terms mean")
{
    for (const Formula& formula : formulas)
        compare(formula, optimized(formula.model), "mpfr:200",
                {printed + formula.changed, formula.name == "F_CookTorrance" ? 1e-79 : 0});
}

namespace {

/// Formulas of the table that are products or parts of terms.
const char* const composition = R"(
module composition
import microfacet { D_GGX }

term pi_D_GGX(alpha: float in [1/4096, 1], g: geometry) -> float = pi * D_GGX(alpha, g)
term NoH(g: geometry) -> float = g.cos_h
term VoH(g: geometry) -> float = g.cos_d
term denominator(g: geometry) -> float = 4 * g.cos_i * g.cos_o
)";

const ir::Module& composed_terms()
{
    static const ir::Module module = compiled(composition);
    return module;
}

/// Double and, to the digits printed, 200 bits.
const std::vector<std::pair<std::string, double>> numbers{{"double", 1e-12}, {"mpfr:200", printed}};

void compare_rows(const std::vector<Row>& rows, const std::vector<std::string>& computed,
                  double relative)
{
    REQUIRE(computed.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Distance off = distance(computed[i], rows[i].at("value"));
        CAPTURE(rows[i].at("id"), rows[i].at("inputs"), rows[i].at("value"), computed[i]);
        CAPTURE(shown(off.relative));
        CHECK(off.relative <= relative);
    }
}

std::vector<std::string> scalars(const ir::Module& module, const std::string& term,
                                 const std::vector<Inputs>& inputs, const std::string& number)
{
    std::vector<std::string> results;
    for (const auto& row : evaluate(module, term, inputs, number)) results.push_back(row.front());
    return results;
}

}  // namespace

TEST_CASE("the mobile distribution is pi times GGX where it is not clamped")
{
    const auto rows = rows_of("GGX_Mobile unclamped");
    for (const auto& [number, tolerance] : numbers)
        compare_rows(rows, scalars(composed_terms(), "pi_D_GGX", all_inputs(rows, of_h), number),
                     tolerance);
}

TEST_CASE("the half vector's cosines agree with karis.csv")
{
    for (const char* field : {"NoH", "VoH"}) {
        const auto rows = rows_of("geometry", field);
        REQUIRE(!rows.empty());
        for (const auto& [number, tolerance] : numbers)
            compare_rows(rows,
                         scalars(composed_terms(), field, all_inputs(rows, of_vectors), number),
                         tolerance);
    }
    CHECK(rows_of("geometry", "NoH").size() + rows_of("geometry", "VoH").size() == 11);
}

TEST_CASE("the whole specular term of the course notes, from its parts")
{
    const auto rows = rows_of("specular_full (Eq2: D3*F5*G4/(4 NoL NoV)) - F0=0.04");
    const auto vectors = all_inputs(rows, of_vectors);
    const auto with_roughness =
        all_inputs(rows, {{"l", "l"}, {"v", "v"}, {"roughness", "roughness"}});
    const ir::Module& terms = optimized("microfacet");
    for (const auto& [number, tolerance] : numbers) {
        const auto d = scalars(terms, "D_GGX", all_inputs(rows, of_alpha), number);
        const auto g = scalars(terms, "G_SchlickGGX_analytic", with_roughness, number);
        const auto below = scalars(composed_terms(), "denominator", vectors, number);
        std::vector<Inputs> angles;
        for (const std::string& cos_d : scalars(composed_terms(), "VoH", vectors, number))
            angles.push_back({{"cos_d", cos_d}, {"f0", "0.04"}});
        const auto f = scalars(terms, "F_Schlick.spherical_gaussian", angles, number);
        std::vector<std::string> whole;
        for (std::size_t i = 0; i < rows.size(); ++i)
            whole.push_back(quotient(product(product(d[i], f[i]), g[i]), below[i]));
        compare_rows(rows, whole, tolerance);
    }
}

TEST_CASE("scale and bias of the environment are their integrals")
{
    // What environment.lobe states; the table's own digits are good to 1e-12.
    constexpr double stated = 0.0008;
    const std::string formula = "IntegrateBRDF exact - G=Schlick k=alpha/2";
    for (const auto& [output, term] :
         {std::pair{"A (scale)", "EnvBRDF_scale"}, std::pair{"B (bias)", "EnvBRDF_bias"}}) {
        const auto rows = rows_of(formula, output);
        REQUIRE(rows.size() == 20);
        for (const ir::Module* module : {&definition("environment"), &optimized("environment")}) {
            const auto computed = scalars(*module, term, all_inputs(rows, of_view), "double");
            for (std::size_t i = 0; i < rows.size(); ++i) {
                const Distance off = distance(computed[i], rows[i].at("value"));
                CAPTURE(term, rows[i].at("inputs"), rows[i].at("value"), computed[i]);
                CHECK(off.absolute <= stated);
            }
        }
    }
}

TEST_CASE("the rational Smith-Beckmann term is off by at most 0.32 percent")
{
    const auto rows = rows_of("G1_Beckmann_exact_erf");
    const auto rational =
        scalars(optimized("microfacet"), "G1_SmithBeckmann", all_inputs(rows, of_theta), "double");
    // Its largest relative error anywhere is 0.00313, where c = 1.336.
    compare_rows(rows, rational, 0.00313);
}

}  // namespace lobe::tests
