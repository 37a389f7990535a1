#include "analyze/cells.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

namespace lobe::analyze {
namespace {

using evaluate::Acceptance;
using evaluate::Interval;
using evaluate::Real;

std::string_view trimmed(std::string_view text)
{
    constexpr std::string_view blanks = " \t";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    text = text.substr(first, text.find_last_not_of(blanks) - first + 1);
    // from_chars knows no plus sign.
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+')
        text.remove_prefix(1);
    return text;
}

/// The nearest float or double. A decimal beyond the type's range becomes 0 or infinity.
template <class Number>
bool read_nearest(std::string_view text, Number& number)
{
    text = trimmed(text);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range)
        number = static_cast<Number>(Real{text, 64}.to_double());
    return true;
}

template <class Number>
void write_number(std::string& record, Number number)
{
    // The sign of a NaN says nothing and is not the same everywhere.
    if (std::isnan(number))
        record += ",nan";
    else
        fmt::format_to(std::back_inserter(record), ",{}", number);
}

}  // namespace

bool read_cell(std::string_view text, const NumberKind&, float& number)
{
    return read_nearest(text, number);
}

bool read_cell(std::string_view text, const NumberKind&, double& number)
{
    return read_nearest(text, number);
}

bool read_cell(std::string_view text, const NumberKind&, Interval& number)
{
    double nearest = 0;
    if (!read_nearest(text, nearest) || std::isnan(nearest)) return false;
    const std::string decimal{trimmed(text)};
    Real bound{53};
    mpfr_strtofr(bound.get(), decimal.c_str(), nullptr, 10, MPFR_RNDD);
    number.low = mpfr_get_d(bound.get(), MPFR_RNDD);
    mpfr_strtofr(bound.get(), decimal.c_str(), nullptr, 10, MPFR_RNDU);
    number.high = mpfr_get_d(bound.get(), MPFR_RNDU);
    return true;
}

bool read_cell(std::string_view text, const NumberKind&, Acceptance& number)
{
    float nearest = 0;
    if (!read_nearest(text, nearest) || std::isnan(nearest)) return false;
    number = {nearest, nearest, false};
    return true;
}

bool read_cell(std::string_view text, const NumberKind& kind, Real& number)
{
    double nearest = 0;
    if (!read_nearest(text, nearest)) return false;
    number = std::isfinite(nearest) ? Real{trimmed(text), kind.bits} : Real{nearest, kind.bits};
    return true;
}

void write_cells(std::string& record, float number) { write_number(record, number); }
void write_cells(std::string& record, double number) { write_number(record, number); }

void write_cells(std::string& record, const Interval& number)
{
    write_number(record, number.low);
    write_number(record, number.high);
}

void write_cells(std::string& record, const Acceptance& number)
{
    write_number(record, number.low);
    write_number(record, number.high);
    record += number.undefined ? ",1" : ",0";
}

void write_cells(std::string& record, const Real& number)
{
    record += ',';
    record += number.text();
}

std::span<const std::string_view> result_suffixes(const NumberKind& kind)
{
    using Kind = NumberKind::Kind;
    static constexpr std::array<std::string_view, 1> plain{""};
    static constexpr std::array<std::string_view, 2> bounds{".low", ".high"};
    static constexpr std::array<std::string_view, 3> accepted{".low", ".high", ".undefined"};
    switch (kind.kind) {
    case Kind::float32:
    case Kind::float64:
    case Kind::half:
    case Kind::half_flush:
    case Kind::real: return plain;
    case Kind::interval: return bounds;
    case Kind::acceptance:
    case Kind::acceptance_half: return accepted;
    }
    return plain;
}

void run_cells(const evaluate::Tape& tape, const NumberKind& kind, evaluate::Columns<float> inputs,
               evaluate::Results<float> outputs, std::size_t count)
{
    using enum NumberKind::Kind;
    if (kind.kind == half)
        evaluate::run_half(tape, evaluate::HalfMode::keep_denormals, inputs, outputs, count);
    else if (kind.kind == half_flush)
        evaluate::run_half(tape, evaluate::HalfMode::flush_denormals, inputs, outputs, count);
    else
        evaluate::run(tape, inputs, outputs, count);
}

void run_cells(const evaluate::Tape& tape, const NumberKind&, evaluate::Columns<double> inputs,
               evaluate::Results<double> outputs, std::size_t count)
{
    evaluate::run(tape, inputs, outputs, count);
}

void run_cells(const evaluate::Tape& tape, const NumberKind&, evaluate::Columns<Interval> inputs,
               evaluate::Results<Interval> outputs, std::size_t count)
{
    evaluate::run(tape, inputs, outputs, count);
}

void run_cells(const evaluate::Tape& tape, const NumberKind& kind,
               evaluate::Columns<Acceptance> inputs, evaluate::Results<Acceptance> outputs,
               std::size_t count)
{
    const auto precision = kind.kind == NumberKind::Kind::acceptance_half
                               ? evaluate::Precision::float16
                               : evaluate::Precision::float32;
    evaluate::run_acceptance(tape, precision, inputs, outputs, count);
}

void run_cells(const evaluate::Tape& tape, const NumberKind& kind, evaluate::Columns<Real> inputs,
               evaluate::Results<Real> outputs, std::size_t count)
{
    evaluate::run_real(tape, kind.bits, inputs, outputs, count);
}

}  // namespace lobe::analyze
