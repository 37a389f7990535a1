#include "analyze/trade/rows.h"

#include "analyze/packing/radiance_search.h"
#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

/// Results of `count` rows, one column per output of the tape.
template <class Number>
std::vector<Number*> heads(std::vector<Number>& columns, std::size_t outputs, std::size_t rows)
{
    columns.resize(outputs * rows);
    std::vector<Number*> result;
    for (std::size_t i = 0; i < outputs; ++i) result.push_back(&columns[i * rows]);
    return result;
}

}  // namespace

std::vector<std::size_t> columns_of(const RadianceBox& box, const evaluate::Tape& tape)
{
    std::vector<std::size_t> columns;
    for (const evaluate::TapeInput& input : tape.inputs) {
        const auto at = std::ranges::find(box.coordinates, input.name, &Coordinate::name);
        assert(at != box.coordinates.end());
        columns.push_back(static_cast<std::size_t>(at - box.coordinates.begin()));
    }
    return columns;
}

Rows::Rows(const Yardstick& yardstick, std::size_t size)
    : yardstick_{&yardstick}, size_{size}, given_(yardstick.box().width() * size),
      stands_(given_.size()), floors_(size)
{
}

std::vector<float> Rows::point(std::size_t row) const
{
    std::vector<float> values;
    for (std::size_t i = row; i < given_.size(); i += size_) values.push_back(given_[i]);
    return values;
}

void Rows::take(RadianceMeter& meter)
{
    for (std::size_t i = 0; i < yardstick_->box().width(); ++i)
        for (std::size_t row = 0; row < size_; ++row)
            column(i)[row] = static_cast<float>(meter.column(i)[row]);
}

void Rows::normalize(std::size_t first)
{
    double* const x = &stands_[first * size_];
    double* const y = x + size_;
    double* const z = y + size_;
    for (std::size_t row = 0; row < size_; ++row) {
        const double length = std::sqrt(x[row] * x[row] + y[row] * y[row] + z[row] * z[row]);
        x[row] /= length;
        y[row] /= length;
        z[row] /= length;
    }
}

void Rows::settle()
{
    const RadianceBox& box = yardstick_->box();
    std::ranges::copy(given_, stands_.begin());
    for (const std::size_t first : yardstick_->vectors()) normalize(first);

    std::vector<const double*> in;
    for (std::size_t i = 0; i < box.tape.inputs.size(); ++i) in.push_back(&stands_[i * size_]);
    const auto out = heads(exact_, box.tape.outputs.size(), size_);
    evaluate::run(box.tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out}, size_);

    for (std::size_t row = 0; row < size_; ++row) {
        floors_[row] = grey_albedo;
        // The normal is the z axis.
        if (yardstick_->is_radiance() && box.light)
            floors_[row] *= stands_[(*box.light + 2) * size_ + row] / std::numbers::pi;
    }
}

void Rows::run(const evaluate::Tape& tape, std::span<const std::size_t> columns,
               std::optional<Format> format, std::vector<double>& results) const
{
    const std::size_t outputs = tape.outputs.size();
    if (!format) {
        std::vector<const double*> in;
        for (const std::size_t column : columns) in.push_back(&stands_[column * size_]);
        const auto out = heads(results, outputs, size_);
        evaluate::run(tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out}, size_);
        return;
    }
    std::vector<const float*> in;
    for (const std::size_t column : columns) in.push_back(&given_[column * size_]);
    std::vector<float> rounded;
    const auto out = heads(rounded, outputs, size_);
    if (*format == Format::float32)
        evaluate::run(tape, evaluate::Columns<float>{in}, evaluate::Results<float>{out}, size_);
    else
        evaluate::run_half(tape, evaluate::HalfMode::keep_denormals, evaluate::Columns<float>{in},
                           evaluate::Results<float>{out}, size_);
    results.assign(rounded.begin(), rounded.end());
}

std::vector<double> Rows::confirm(const evaluate::Tape& tape, std::span<const std::size_t> columns,
                                  std::size_t row) const
{
    constexpr int bits = 113;
    std::vector<evaluate::Real> values;
    for (const std::size_t column : columns)
        values.emplace_back(stands_[column * size_ + row], bits);
    std::vector<const evaluate::Real*> in;
    for (const evaluate::Real& value : values) in.push_back(&value);
    std::vector<evaluate::Real> results(tape.outputs.size(), evaluate::Real{bits});
    std::vector<evaluate::Real*> out;
    for (evaluate::Real& result : results) out.push_back(&result);
    evaluate::run_real(tape, bits, in, out, 1);
    std::vector<double> doubles;
    for (const evaluate::Real& result : results) doubles.push_back(result.to_double());
    return doubles;
}

std::string Rows::describe(std::size_t row) const
{
    std::string text;
    std::string open;  // the vector or color whose components are being written
    for (std::size_t i = 0; i < yardstick_->box().width(); ++i) {
        const std::string& column = yardstick_->box().coordinates[i].name;
        const std::string name = column.substr(0, column.find('.'));
        if (column != name && (name == "n" || name == "x" || name == "y")) continue;
        const float value = given_[i * size_ + row];
        if (name == open) {
            text += fmt::format(", {}", value);
            continue;
        }
        if (!open.empty()) text += ")";
        open = column == name ? "" : name;
        text += fmt::format("{}{} = {}{}", text.empty() ? "" : ", ", name, open.empty() ? "" : "(",
                            value);
    }
    return open.empty() ? text : text + ")";
}

std::vector<Rows> survey(const Yardstick& yardstick, std::size_t points, unsigned jobs)
{
    constexpr std::size_t part = 1024;
    const StoredAs nothing(yardstick.box().width(), nullptr);
    const std::size_t parts = std::max<std::size_t>(1, points / part);
    std::vector<Rows> out(parts, Rows{yardstick, part});
    for_each_task(parts, jobs, [&](std::size_t task) {
        RadianceMeter meter{yardstick.box(), part};
        for (std::size_t row = 0; row < part; ++row) {
            const std::size_t index = task * part + row;
            if (index % 2 != 0)
                place_point(yardstick.box(), nothing, index, meter, row);
            else
                place_usual_point(yardstick.box(),
                                  index % 4 == 0 ? Directions::anywhere : Directions::near_peak,
                                  index, meter, row);
        }
        out[task].take(meter);
        out[task].settle();
    });
    return out;
}

}  // namespace lobe::analyze
