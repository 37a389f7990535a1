#include "analyze/packing/radiance_meter.h"

#include "analyze/trade/deviation.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

void run(const evaluate::Tape& tape, const std::vector<const double*>& in,
         std::vector<double>& results, std::size_t rows)
{
    std::vector<double*> out;
    for (std::size_t i = 0; i < tape.outputs.size(); ++i) out.push_back(&results[i * rows]);
    evaluate::run(tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out}, rows);
}

}  // namespace

RadianceMeter::RadianceMeter(const RadianceBox& box, std::size_t rows)
    : box_{box}, rows_{rows}, points_(box.width() * rows), stored_(box.width() * rows),
      exact_(box.tape.outputs.size() * rows), packed_(exact_.size()), errors_(rows)
{
}

void RadianceMeter::set(std::size_t row, std::span<const float> point)
{
    for (std::size_t i = 0; i < point.size(); ++i) column(i)[row] = point[i];
}

void RadianceMeter::set_all(std::span<const float> point)
{
    for (std::size_t i = 0; i < point.size(); ++i) std::fill_n(column(i), rows_, double{point[i]});
}

std::vector<float> RadianceMeter::point(std::size_t row) const
{
    std::vector<float> values;
    for (std::size_t i = 0; i < box_.width(); ++i)
        values.push_back(static_cast<float>(points_[i * rows_ + row]));
    return values;
}

std::vector<const double*> RadianceMeter::heads() const
{
    std::vector<const double*> columns;
    for (std::size_t i = 0; i < box_.width(); ++i) columns.push_back(&points_[i * rows_]);
    return columns;
}

void RadianceMeter::light() { run(box_.tape, heads(), exact_, rows_); }

double RadianceMeter::floor_of(std::size_t row) const
{
    // The normal is the z axis.
    return grey_card * (box_.light ? points_[(*box_.light + 2) * rows_ + row] : 1);
}

const std::vector<double>& RadianceMeter::compare(const StoredAs& stored)
{
    std::vector<const double*> columns = heads();
    for (std::size_t i = 0; i < stored.size(); ++i) {
        if (stored[i] == nullptr) continue;
        const double* const from = &points_[i * rows_];
        double* const to = &stored_[i * rows_];
        // In a climb most rows have the value of the first.
        const auto kept = [&](double value) {
            return double{stored[i]->stored(static_cast<float>(value))};
        };
        const double usual = kept(from[0]);
        for (std::size_t row = 0; row < rows_; ++row)
            to[row] = from[row] == from[0] ? usual : kept(from[row]);
        columns[i] = to;
    }
    run(box_.tape, columns, packed_, rows_);
    for (std::size_t row = 0; row < rows_; ++row) errors_[row] = detail(row).error;
    return errors_;
}

RadianceMeter::Detail RadianceMeter::detail(std::size_t row) const
{
    const double floor = floor_of(row);
    Detail worst{-1, 0, 0};
    for (std::size_t k = row; k < exact_.size(); k += rows_) {
        const double exact = exact_[k];
        const double packed = packed_[k];
        if (!std::isfinite(exact)) return {0, exact, packed};
        const double error = std::isfinite(packed)
                                 ? std::abs(packed - exact) / std::max(std::abs(exact), floor)
                                 : std::numeric_limits<double>::infinity();
        if (error > worst.error) worst = {error, exact, packed};
    }
    return worst;
}

double RadianceMeter::codes(std::size_t row) const
{
    double worst = 0;
    for (std::size_t k = row; k < exact_.size(); k += rows_)
        if (std::isfinite(exact_[k]))
            worst = std::max(worst, std::abs(display_code(packed_[k]) - display_code(exact_[k])));
    return worst;
}

}  // namespace lobe::analyze
