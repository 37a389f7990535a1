#include "numeric/table.h"

#include "analyze/csv.h"
#include "analyze/table.h"
#include "evaluate/real.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace lobe::tests {
namespace {

using evaluate::Real;

constexpr int bits = 400;

}  // namespace

std::vector<Row> read_table(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    INFO(path);
    REQUIRE(file);
    analyze::CsvReader reader{file};
    std::vector<std::string> header;
    REQUIRE(reader.next(header));
    std::vector<Row> rows;
    std::vector<std::string> cells;
    while (reader.next(cells)) {
        REQUIRE(cells.size() == header.size());
        Row row;
        for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = cells[i];
        rows.push_back(std::move(row));
    }
    INFO(reader.error());
    REQUIRE(reader.error().empty());
    return rows;
}

std::vector<std::vector<std::string>> evaluate(const ir::Module& module,
                                               const std::string& function,
                                               const std::vector<Inputs>& inputs,
                                               const std::string& number)
{
    REQUIRE(!inputs.empty());
    std::string text;
    const auto line = [&text](const Inputs& row, bool names) {
        std::string record;
        for (const auto& [name, value] : row) {
            if (!record.empty()) record += ',';
            analyze::append_cell(record, names ? name : value);
        }
        text += record + '\n';
    };
    line(inputs.front(), true);
    for (const Inputs& row : inputs) line(row, false);

    const auto id = analyze::find_function(module, function);
    INFO(function);
    REQUIRE(id);
    const auto kind = analyze::find_number_kind(number);
    REQUIRE(kind);
    std::istringstream in{text};
    std::ostringstream out;
    const auto outcome = analyze::evaluate_table(module, *id, *kind, in, out);
    INFO((outcome.error ? outcome.error->message : ""));
    REQUIRE(!outcome.error);
    REQUIRE(outcome.rows == inputs.size());

    std::istringstream computed{out.str()};
    analyze::CsvReader reader{computed};
    std::vector<std::string> cells;
    REQUIRE(reader.next(cells));
    std::vector<std::vector<std::string>> results;
    while (reader.next(cells)) {
        cells.erase(cells.begin(),
                    cells.begin() + static_cast<std::ptrdiff_t>(inputs.front().size()));
        results.push_back(cells);
    }
    return results;
}

std::string square(const std::string& decimal) { return product(decimal, decimal); }

std::string product(const std::string& a, const std::string& b)
{
    Real value{a, bits};
    mpfr_mul(value.get(), value.get(), Real{b, bits}.get(), MPFR_RNDN);
    return value.text();
}

std::string quotient(const std::string& a, const std::string& b)
{
    Real value{a, bits};
    mpfr_div(value.get(), value.get(), Real{b, bits}.get(), MPFR_RNDN);
    return value.text();
}

std::string sum(const std::string& a, const std::string& b)
{
    Real value{a, bits};
    mpfr_add(value.get(), value.get(), Real{b, bits}.get(), MPFR_RNDN);
    return value.text();
}

Distance distance(const std::string& computed, const std::string& expected)
{
    const Real a{computed, bits};
    const Real b{expected, bits};
    Real difference{bits};
    mpfr_sub(difference.get(), a.get(), b.get(), MPFR_RNDN);
    mpfr_abs(difference.get(), difference.get(), MPFR_RNDN);
    Distance result;
    result.absolute = difference.to_double();
    if (mpfr_zero_p(difference.get())) return result;
    mpfr_div(difference.get(), difference.get(), b.get(), MPFR_RNDN);
    mpfr_abs(difference.get(), difference.get(), MPFR_RNDN);
    result.relative = difference.to_double();
    return result;
}

bool within(const Distance& distance, const Tolerance& tolerance)
{
    return distance.relative <= tolerance.relative || distance.absolute <= tolerance.absolute;
}

std::string shown(double value) { return fmt::format("{:.3g}", value); }

}  // namespace lobe::tests
