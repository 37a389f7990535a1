// `lobec evaluate` as a function of text: columns bound by name, results appended, mistakes named.
#include "analyze/table.h"
#include "base/render.h"
#include "compile.h"
#include "evaluate/real.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>

namespace lobe::analyze {
namespace {

const char* const text = R"(
module demo
source paper = "A paper"
param gain : float in [0, 4] = 0.1 "Gain"
param tint : color = (1, 0.5, 0.25) "Tint"
/// paper 1
term twice(a: float in [-1000, 1000]) -> float = 2 * a
/// paper 2
term third(a: float in [-1000, 1000]) -> float = a / 3
/// paper 3
term tinted(f0: color) -> color = gain * tint * f0
/// paper 4
term facing(g: geometry) -> float = g.cos_i
/// paper 5
term grazing(g: geometry) -> float = (1 - g.cos_d)^2 + (1 - g.cos_h^2) + g.cos_o
/// paper 6
term schlick(cos_d: unit) -> float = (1 - cos_d)^5
  /// paper 7
  form half = 0.5 * (1 - cos_d)
model m(g: geometry, s: surface) {
  diffuse = s.diffuse_color * g.cos_i
}
)";

const ir::Module& demo()
{
    static const ir::Module module = [] {
        Sources sources;
        Diagnostics diagnostics;
        const auto root = sources.add("demo.lobe", text);
        const check::Loader none = [](Sources&, std::string_view, std::string_view) {
            return std::optional<std::uint32_t>{};
        };
        const auto checked = front(sources, root, none, diagnostics);
        INFO(render_text(sources, diagnostics));
        REQUIRE(checked);
        return middle(*checked);
    }();
    return module;
}

struct Run {
    TableOutcome outcome;
    std::string table;
};

Run run(const std::string& term, const std::string& table, const std::string& number = "double")
{
    const auto function = find_function(demo(), term);
    INFO(term);
    REQUIRE(function);
    const auto kind = find_number_kind(number);
    REQUIRE(kind);
    std::istringstream in{table};
    std::ostringstream out;
    Run result{evaluate_table(demo(), *function, *kind, in, out), {}};
    result.table = out.str();
    return result;
}

std::string computed(const std::string& term, const std::string& table,
                     const std::string& number = "double")
{
    const Run result = run(term, table, number);
    INFO((result.outcome.error ? result.outcome.error->message : ""));
    REQUIRE(!result.outcome.error);
    return result.table;
}

/// |computed - expected|, where the texts' difference is far below a double's resolution.
double off_by(std::string computed, const std::string& expected)
{
    while (!computed.empty() && computed.back() == '\n') computed.pop_back();
    evaluate::Real difference{computed, 400};
    mpfr_sub(difference.get(), difference.get(), evaluate::Real{expected, 400}.get(), MPFR_RNDN);
    return std::abs(difference.to_double());
}

}  // namespace

TEST_CASE("kinds of number have names")
{
    using enum NumberKind::Kind;
    CHECK(find_number_kind("double") == NumberKind{float64, 200});
    CHECK(find_number_kind("half:flush") == NumberKind{half_flush, 200});
    CHECK(find_number_kind("acceptance:half") == NumberKind{acceptance_half, 200});
    CHECK(find_number_kind("mpfr") == NumberKind{real, 200});
    CHECK(find_number_kind("mpfr:53") == NumberKind{real, 53});
    for (const char* wrong : {"", "Double", "mpfr:", "mpfr:52", "mpfr:4097", "mpfr:1e3", "int"})
        CHECK(!find_number_kind(wrong));
}

TEST_CASE("results are appended, other columns pass through")
{
    CHECK(computed("twice", "note,a\nx,1.5\n\"y, z\",-2\n") ==
          "note,a,twice\nx,1.5,3\n\"y, z\",-2,-4\n");
    CHECK(computed("twice", "a\r\n0.25\r\n") == "a,twice\n0.25,0.5\n");
    CHECK(computed("twice", "a\n") == "a,twice\n");
}

TEST_CASE("a missing parameter takes its default, a gray column feeds every channel")
{
    CHECK(computed("tinted", "f0,gain\n1,2\n") ==
          "f0,gain,tinted.r,tinted.g,tinted.b\n1,2,2,1,0.5\n");
    CHECK(computed("tinted", "f0.r,f0.g,f0.b,tint,gain\n1,0.5,0,1,1\n") ==
          "f0.r,f0.g,f0.b,tint,gain,tinted.r,tinted.g,tinted.b\n1,0.5,0,1,1,1,0.5,0\n");
    // The default is the decimal 0.1, not the double nearest to it.
    const std::string exact = computed("tinted", "f0.r,f0.g,f0.b,tint\n1,1,1,1\n", "mpfr:200");
    CHECK(off_by(exact.substr(exact.rfind(',') + 1), "0.1") < 0x1p-200);
}

TEST_CASE("the geometry is given by vectors or by fields")
{
    CHECK(computed("facing", "l.x,l.y,l.z,v.x,v.y,v.z\n0,0.6,0.8,0,0,1\n").ends_with(",0.8\n"));
    CHECK(computed("facing", "l.x,l.y,l.z,v.x,v.y,v.z,n.x,n.y,n.z\n0,0.6,0.8,0,0,1,0,1,0\n")
              .ends_with(",0.6\n"));
    CHECK(computed("facing", "cos_i\n0.25\n") == "cos_i,facing\n0.25,0.25\n");
    // Whatever the compiler made of the differences, the cosines are enough.
    CHECK(computed("grazing", "cos_d,cos_h,cos_o\n0.5,0.5,1\n") ==
          "cos_d,cos_h,cos_o,grazing\n0.5,0.5,1,2\n");
    CHECK(computed("m.diffuse", "cos_i,diffuse_color\n0.5,0.5\n").ends_with(",0.25,0.25,0.25\n"));
}

TEST_CASE("forms and outputs are found with a point or an underscore")
{
    CHECK(computed("schlick.half", "cos_d\n0\n") == computed("schlick_half", "cos_d\n0\n"));
    CHECK(find_function(demo(), "m.diffuse") == find_function(demo(), "m_diffuse"));
    CHECK(!find_function(demo(), "nothing"));
}

TEST_CASE("every kind of number writes what reads back")
{
    CHECK(computed("third", "a\n1\n", "double") == "a,third\n1,0.3333333333333333\n");
    CHECK(computed("third", "a\n1\n", "float") == "a,third\n1,0.33333334\n");
    CHECK(computed("third", "a\n1\n", "half") == "a,third\n1,0.33325195\n");
    const std::string exact = computed("twice", "a\n0.1\n", "mpfr:100");
    CHECK(off_by(exact.substr(exact.rfind(',') + 1), "0.2") < 0x1p-100);
    CHECK(computed("third", "a\n1\n", "interval").starts_with("a,third.low,third.high\n1,"));
    CHECK(computed("third", "a\n1\n", "acceptance")
              .starts_with("a,third.low,third.high,third.undefined\n1,"));

    std::mt19937_64 random{7};
    std::string table = "a\n";
    for (int i = 0; i < 2000; ++i)
        table += fmt::format("{}\n", static_cast<double>(random() % 2000001) / 1000 - 1000);
    std::istringstream lines{computed("third", table, "double")};
    std::string line;
    std::getline(lines, line);
    int rows = 0;
    while (std::getline(lines, line)) {
        double a = 0;
        double third = 0;
        const std::size_t comma = line.find(',');
        std::from_chars(line.data(), line.data() + comma, a);
        std::from_chars(line.data() + comma + 1, line.data() + line.size(), third);
        REQUIRE(std::bit_cast<std::uint64_t>(third) == std::bit_cast<std::uint64_t>(a / 3));
        ++rows;
    }
    CHECK(rows == 2000);
}

TEST_CASE("an interval encloses the decimal that the cell shows")
{
    std::istringstream lines{computed("twice", "a\n0.1\n", "interval")};
    std::string line;
    std::getline(lines, line);
    std::getline(lines, line);
    double low = 0;
    double high = 0;
    const std::size_t first = line.find(',');
    const std::size_t second = line.find(',', first + 1);
    std::from_chars(line.data() + first + 1, line.data() + second, low);
    std::from_chars(line.data() + second + 1, line.data() + line.size(), high);
    // 0.1 lies between two doubles; the nearest, 0.1 in C++, is above it.
    CHECK(low <= 2 * std::nextafter(0.1, 0.0));
    CHECK(high >= 2 * 0.1);
    CHECK(high - low <= 4 * 0x1p-54);
}

TEST_CASE("decimals beyond a type's range become its ends")
{
    CHECK(computed("twice", "a\n1e-400\n", "double") == "a,twice\n1e-400,0\n");
    CHECK(computed("twice", "a\n1e-60\n", "float") == "a,twice\n1e-60,0\n");
    CHECK(computed("twice", "a\n1e60\n", "float") == "a,twice\n1e60,inf\n");
    CHECK(computed("twice", "a\n +1 \n") == "a,twice\n +1 ,2\n");
}

TEST_CASE("a missing column is an error that says what is near")
{
    const Run result = run("schlick", "cos_b\n0\n");
    REQUIRE(result.outcome.error);
    CHECK(result.outcome.error->message == "`schlick` needs 1 more column: `cos_d`");
    REQUIRE(result.outcome.error->hints.size() == 1);
    CHECK(result.outcome.error->hints[0] ==
          "column `cos_b` is not an input of `schlick`; did you mean `cos_d`?");
    CHECK(result.table.empty());

    const Run vectors = run("facing", "a\n0\n");
    REQUIRE(vectors.outcome.error);
    CHECK(vectors.outcome.error->message ==
          "`facing` needs 6 more columns: `l.x`, `l.y`, `l.z`, `v.x`, `v.y`, `v.z`");
    CHECK(vectors.outcome.error->hints ==
          std::vector<std::string>{"the geometry may also be given by its fields: cos_i"});
}

TEST_CASE("a misspelt parameter is a warning, for its default is used")
{
    const Run result = run("tinted", "f0,Gain\n1,2\n");
    CHECK(!result.outcome.error);
    CHECK(result.outcome.warnings ==
          std::vector<std::string>{
              "column `Gain` is not an input of `tinted`; did you mean `gain`?"});
}

TEST_CASE("bad cells are named by line and column")
{
    const auto error = [](const std::string& table) {
        const Run result = run("twice", table);
        REQUIRE(result.outcome.error);
        return fmt::format("{}:{}: {}", result.outcome.error->line, result.outcome.error->column,
                           result.outcome.error->message);
    };
    CHECK(error("b,a\n1,2\n3,x\n") == "3:a: `x` is not a number");
    CHECK(error("b,a\n1,\n") == "2:a: an empty cell, where a number is needed");
    CHECK(error("b,a\n1,0x10\n") == "2:a: `0x10` is not a number");
    CHECK(error("b,a\n1,1 2\n") == "2:a: `1 2` is not a number");
    CHECK(error("b,a\n1\n") == "2:: 1 cells, where the header has 2");
    CHECK(error("a,a\n1,1\n") == "1:a: two columns have one name");
    CHECK(error("") == "0:: the table is empty; its first line names the columns");
    CHECK(error("a\n\"1\n") == "2:: a quoted cell is never closed");
}

TEST_CASE("tables are as long as they like")
{
    std::string table = "a\n";
    for (int i = 0; i < 5000; ++i) table += fmt::format("{}\n", i % 1000);
    const Run result = run("twice", table, "float");
    CHECK(result.outcome.rows == 5000);
    CHECK(result.table.ends_with("\n999,1998\n"));
}

}  // namespace lobe::analyze
