// Every row and every column of data/callisto.csv: held against the models, or named as a rejected
// reading.
#include "compile.h"
#include "numeric/library.h"
#include "numeric/table.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>

namespace lobe::tests {
namespace {

const std::vector<Row>& table()
{
    static const std::vector<Row> rows = read_table("data/callisto.csv");
    return rows;
}

/// A row's cells by the names that the models use. A row's one channel stands for all three, with
/// its gains and the terminator's strength already tinted.
Inputs inputs_of(const Row& row)
{
    Inputs inputs;
    const std::vector<std::pair<std::string, std::string>> names{
        {"lx", "l.x"},
        {"ly", "l.y"},
        {"lz", "l.z"},
        {"vx", "v.x"},
        {"vy", "v.y"},
        {"vz", "v.z"},
        {"roughness", "roughness"},
        {"albedo", "diffuse_color"},
        {"f0", "f0"},
        {"rho_f", "diffuse_fresnel"},
        {"n_f", "diffuse_fresnel_falloff"},
        {"m_f", "diffuse_fresnel_tangent_falloff"},
        {"rho_r", "retroreflection"},
        {"n_r", "retroreflection_falloff"},
        {"m_r", "retroreflection_tangent_falloff"},
        {"n_s", "specular_fresnel_falloff"},
        {"o", "smooth_terminator"},
        {"p", "smooth_terminator_length"},
        {"dual_scale", "dual_specular_roughness_scale"},
        {"dual_opacity", "dual_specular_opacity"}};
    for (const auto& [theirs, ours] : names) inputs[ours] = row.at(theirs);
    inputs["alpha"] = square(row.at("roughness"));
    return inputs;
}

/// Terms that the table has a column of but the models write inside others.
const char* const probes = R"(
module probes
import callisto { F_Callisto, specular_cos }

term ndotl(g: geometry) -> float = dot(g.n, g.l)
term ndotv(g: geometry) -> float = dot(g.n, g.v)
term ndoth(g: geometry) -> float = dot(g.n, g.h)
term ldoth(g: geometry) -> float = dot(g.l, g.h)
term vdotl(g: geometry) -> float = g.v_dot_l
term alpha_of(roughness: float in [1/64, 1]) -> float = roughness^2
term smooth_s(edge: unit, g: geometry) -> float = smoothstep(0, edge, g.cos_i)
term F(f0: color, g: geometry) -> color = F_Callisto(f0, g.cos_d)
)";

const ir::Module& probe(bool passes)
{
    static const ir::Module written = module_of(probes);
    static const ir::Module whole = middle(written);
    return passes ? whole : written;
}

const ir::Module& model(const std::string& name, bool passes)
{
    if (name == "probes") return probe(passes);
    return passes ? optimized(name) : definition(name);
}

/// One column of the table and how to compute it: the sum of some functions of one module.
struct Column {
    std::string name;
    std::string model;
    std::vector<std::string> functions;
    /// Changes a row's inputs before they are used.
    std::function<void(Inputs&, const Row&)> prepare = [](Inputs&, const Row&) {};
    /// Rows that the models define otherwise, and why.
    std::set<std::string> except = {};
};

const std::vector<Column>& columns()
{
    static const std::vector<Column> all{
        {"ndotl", "probes", {"ndotl"}},
        {"ndotv", "probes", {"ndotv"}},
        {"ndoth", "probes", {"ndoth"}},
        {"ldoth", "probes", {"ldoth"}},
        {"vdotl", "probes", {"vdotl"}},
        {"alpha", "probes", {"alpha_of"}},
        {"alpha_f", "callisto", {"alpha_f"}},
        {"alpha_r", "callisto", {"alpha_r"}},
        {"alpha_s", "callisto", {"alpha_s"}},
        {"smooth_s",
         "probes",
         {"smooth_s"},
         [](Inputs& inputs, const Row& row) {
             inputs["edge"] = product(row.at("alpha_s"), row.at("p"));
         }},
        {"c1", "callisto", {"c1"}},
        {"c2", "callisto", {"c2"}},
        {"F", "probes", {"F"}},
        // 105: h is below the horizon. The table's D is even in n.h; the models' cos_h is 0 there.
        {"D", "callisto", {"D_GGX"}, [](Inputs&, const Row&) {}, {"105"}},
        {"G", "microfacet", {"G_SmithGGX"}},
        {"vis", "callisto", {"V_SmithGGX"}},
        // 105: both directions below the horizon. The table says inf, the model names the limit 0.
        {"vis_joint", "microfacet", {"V_SmithGGXCorrelated"}, [](Inputs&, const Row&) {}, {"105"}},
        {"f_lambert_cos", "callisto", {"lambert_cos"}},
        {"f_proxima_cos", "callisto", {"proxima_cos"}},
        {"f_ggx_cos", "callisto", {"specular_cos"}},
        {"f_ggx_lobe1_cos",
         "callisto",
         {"specular_cos"},
         [](Inputs& inputs, const Row&) { inputs["dual_specular_opacity"] = "0"; }},
        {"f_ggx_lobe2_cos",
         "callisto",
         {"specular_cos"},
         [](Inputs& inputs, const Row&) { inputs["dual_specular_opacity"] = "1"; }},
        {"L_o_lambert", "callisto", {"callisto_lambert_diffuse", "callisto_lambert_specular"}},
        {"L_o", "callisto", {"callisto_diffuse", "callisto_specular"}},
    };
    return all;
}

const std::vector<std::string> rejected{"x_c1_NoL_NoV", "x_alpha_s_angles", "x_c2_angles",
                                        "x_c2_port_tint05", "x_F_port_floor"};
const std::vector<std::string> given{"id",    "group", "note", "lx",         "ly",          "lz",
                                     "vx",    "vy",    "vz",   "roughness",  "albedo",      "f0",
                                     "rho_f", "n_f",   "m_f",  "rho_r",      "n_r",         "m_r",
                                     "n_s",   "o",     "p",    "dual_scale", "dual_opacity"};
const std::vector<std::string> in_float{"L_o_lambert_f32in", "L_o_f32in"};

/// The computed column: one text per row.
std::vector<std::string> compute(const Column& column, const std::string& number, bool passes)
{
    std::vector<Inputs> inputs;
    for (const Row& row : table()) {
        inputs.push_back(inputs_of(row));
        column.prepare(inputs.back(), row);
    }
    std::vector<std::string> total;
    for (const std::string& function : column.functions) {
        const auto results = evaluate(model(column.model, passes), function, inputs, number);
        for (std::size_t i = 0; i < results.size(); ++i) {
            // White tints: the channels are alike to the last bit.
            for (const std::string& channel : results[i]) CHECK(channel == results[i].front());
            if (total.size() <= i)
                total.push_back(results[i].front());
            else
                total[i] = sum(total[i], results[i].front());
        }
    }
    return total;
}

void compare(const std::string& number, bool passes,
             const std::function<Tolerance(const Column&, const Row&)>& tolerance)
{
    for (const Column& column : columns()) {
        const auto computed = compute(column, number, passes);
        REQUIRE(computed.size() == table().size());
        for (std::size_t i = 0; i < computed.size(); ++i) {
            const Row& row = table()[i];
            if (column.except.contains(row.at("id"))) continue;
            const std::string& expected = row.at(column.name);
            const Distance off = distance(computed[i], expected);
            CAPTURE(number, column.name, row.at("id"), row.at("note"), expected, computed[i]);
            CAPTURE(shown(off.relative), shown(off.absolute));
            CHECK(within(off, tolerance(column, row)));
        }
    }
}

}  // namespace

TEST_CASE("every row and column of callisto.csv is used or named as rejected")
{
    CHECK(table().size() == 86);
    std::set<std::string> known;
    for (const Column& column : columns()) known.insert(column.name);
    for (const auto* list : {&rejected, &given, &in_float})
        known.insert(list->begin(), list->end());
    std::set<std::string> present;
    for (const auto& [name, cell] : table().front()) present.insert(name);
    CHECK(present == known);
    CHECK(present.size() == 54);
    std::size_t excepted = 0;
    for (const Column& column : columns()) excepted += column.except.size();
    CHECK(excepted == 2);
    WARN("callisto.csv: " << columns().size() * table().size() - excepted
                          << " values are held against terms; " << excepted
                          << " are defined otherwise, " << rejected.size()
                          << " columns are rejected readings");
}

namespace {

bool is_weight(const Column& column)
{
    return column.name == "alpha_f" || column.name == "alpha_r" || column.name == "alpha_s";
}

/// 1e-12 of the value, or what the rounding of the inputs to double leaves of it.
Tolerance in_double(const Column& column, const Row& row)
{
    // Near l = v and h = n the weights are 1e-16 and below; a rounded vector does not know its
    // angle to another any better, so they are compared absolutely.
    if (column.name == "alpha_f" || column.name == "alpha_r") return {1e-12, 1e-16};
    // Three products of cosines of at most 1, rounded, and two sums.
    if (column.name == "vdotl") return {1e-12, 5 * 0x1p-53};
    // v.l is 0 to 20 digits: Proxima's square root makes 1e-8 of its rounding.
    const bool cusp = column.name == "f_proxima_cos" || column.name == "L_o";
    if (cusp && row.at("id") == "124") return {1e-8, 0};
    return {1e-12, 0};
}

/// The table prints 20 digits, so its vectors are unit to 1e-20, and two ways to a cosine that are
/// the same for unit vectors differ by that.
Tolerance in_print(const Column& column, const Row& row)
{
    // l = v = n at an exponent of 0.5: 0^0.5 counts as (2^-126)^0.5, which is 2^-63. All else that
    // Fresnel is multiplied by is below 2 there.
    if (row.at("id") == "109") return {1e-18, 2 * 0x1p-63};
    // A weight's derivative by a cosine is at most its exponent, 10; there are two cosines.
    if (is_weight(column)) return {1e-18, 20 * 1e-20};
    return {1e-18, 0};
}

}  // namespace

TEST_CASE("models agree with callisto.csv in double") { compare("double", true, in_double); }

TEST_CASE("definitions agree with callisto.csv to the digits printed")
{
    compare("mpfr:200", false, in_print);
}

TEST_CASE("the passes keep what the models mean") { compare("mpfr:200", true, in_print); }

TEST_CASE("float agrees with the exact result for rounded inputs")
{
    const std::vector<std::pair<std::string, std::vector<std::string>>> targets{
        {"L_o_lambert_f32in", {"callisto_lambert_diffuse", "callisto_lambert_specular"}},
        {"L_o_f32in", {"callisto_diffuse", "callisto_specular"}}};
    for (const auto& [name, functions] : targets) {
        const Column column{name, "callisto", functions};
        const auto computed = compute(column, "float", true);
        for (std::size_t i = 0; i < computed.size(); ++i) {
            const Row& row = table()[i];
            const std::string& expected = row.at(name);
            const double alpha = std::stod(row.at("alpha"));
            const double albedo = std::stod(row.at("albedo"));
            // Proxima's square root has an infinite slope at v.l = 0: the rounding of v.l to
            // 2^-25 alone moves it by 1.7e-4, and with the bracket's 0.36 that is 6e-5.
            const bool cusp = name == "L_o_f32in";
            const double bound = 4e-6 * std::abs(std::stod(expected)) +
                                 (cusp ? 6e-5 * alpha * albedo / 3.14159265358979 : 0);
            const Distance off = distance(computed[i], expected);
            CAPTURE(name, row.at("id"), row.at("note"), expected, computed[i]);
            CAPTURE(shown(off.relative), shown(off.absolute));
            CHECK(off.absolute <= bound);
        }
    }
}

}  // namespace lobe::tests
