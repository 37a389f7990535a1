#include "analyze/radiance_meter.h"

#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lobe::analyze {
namespace {

/// Radiance of an 18 % grey card under the light that makes the pixel: 0.18 / pi n.l.
constexpr double grey_card = 0.18 / std::numbers::pi;

void run(const evaluate::Tape& tape, const std::vector<const float*>& in,
         std::vector<float>& results, std::size_t rows)
{
    std::vector<float*> out;
    for (std::size_t i = 0; i < tape.outputs.size(); ++i) out.push_back(&results[i * rows]);
    evaluate::run(tape, evaluate::Columns<float>{in}, evaluate::Results<float>{out}, rows);
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
    for (std::size_t i = 0; i < point.size(); ++i) std::fill_n(column(i), rows_, point[i]);
}

std::vector<float> RadianceMeter::point(std::size_t row) const
{
    std::vector<float> values;
    for (std::size_t i = 0; i < box_.width(); ++i) values.push_back(points_[i * rows_ + row]);
    return values;
}

std::vector<const float*> RadianceMeter::heads(const std::vector<float>& table) const
{
    std::vector<const float*> columns;
    for (std::size_t i = 0; i < box_.width(); ++i) columns.push_back(&table[i * rows_]);
    return columns;
}

void RadianceMeter::light() { run(box_.tape, heads(points_), exact_, rows_); }

float RadianceMeter::floor_of(std::size_t row) const
{
    // The normal is the z axis.
    const float cosine = box_.light ? points_[(*box_.light + 2) * rows_ + row] : 1.0F;
    return static_cast<float>(grey_card) * cosine;
}

const std::vector<float>& RadianceMeter::compare(const StoredAs& stored)
{
    std::vector<const float*> columns = heads(points_);
    for (std::size_t i = 0; i < stored.size(); ++i) {
        if (stored[i] == nullptr) continue;
        const float* const from = &points_[i * rows_];
        float* const to = &stored_[i * rows_];
        // In a climb most rows have the value of the first.
        const float usual = stored[i]->stored(from[0]);
        for (std::size_t row = 0; row < rows_; ++row)
            to[row] = from[row] == from[0] ? usual : stored[i]->stored(from[row]);
        columns[i] = to;
    }
    run(box_.tape, columns, packed_, rows_);

    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::ranges::fill(errors_, 0.0F);
    std::vector<bool> dark(rows_);
    for (std::size_t k = 0; k < exact_.size(); k += rows_)
        for (std::size_t row = 0; row < rows_; ++row) {
            const float exact = exact_[k + row];
            const float packed = packed_[k + row];
            if (!std::isfinite(exact)) {
                dark[row] = true;
                continue;
            }
            const float scale = std::max(std::abs(exact), floor_of(row));
            const float error = std::isfinite(packed) ? std::abs(packed - exact) / scale : infinity;
            errors_[row] = std::max(errors_[row], error);
        }
    for (std::size_t row = 0; row < rows_; ++row)
        if (dark[row]) errors_[row] = 0;
    return errors_;
}

RadianceMeter::Detail RadianceMeter::detail(std::size_t row) const
{
    Detail worst{-1, 0, 0};
    for (std::size_t k = 0; k < exact_.size(); k += rows_) {
        const double exact = exact_[k + row];
        const double packed = packed_[k + row];
        const double scale = std::max(std::abs(exact), static_cast<double>(floor_of(row)));
        const double error = std::isfinite(packed) ? std::abs(packed - exact) / scale
                                                   : std::numeric_limits<double>::infinity();
        if (error > worst.error) worst = {error, exact, packed};
    }
    return worst;
}

}  // namespace lobe::analyze
