#include "analyze/minimax/surface.h"

#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::Interval;

/// t in 0 .. 1, denser towards both ends; exactly 0 and 1 there.
double crowded(std::size_t i, std::size_t count)
{
    const double t = static_cast<double>(i) / static_cast<double>(count - 1);
    return t * t * (3 - 2 * t);
}

double between(Interval side, double t)
{
    return t == 1 ? side.high : side.low + (side.high - side.low) * t;
}

std::vector<double> grid_line(Interval side, std::size_t count)
{
    std::vector<double> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(between(side, crowded(i, count)));
    return result;
}

/// What is left of the box around a peak.
struct Cell {
    Interval x;
    Interval y;
    Difference best;
};

double distance(double a, double b)
{
    const double result = std::fabs(a - b);
    return std::isnan(result) ? std::numeric_limits<double>::infinity() : result;
}

std::vector<double> differences(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<double> result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = distance(a[i], b[i]);
    return result;
}

/// `count` places evenly over a side; one that has no width has one.
std::vector<double> evenly(Interval side, std::size_t count)
{
    if (side.low == side.high) return {side.low};
    std::vector<double> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(between(side, static_cast<double>(i) / static_cast<double>(count - 1)));
    return result;
}

/// A cell narrowed to the neighbors of its best place.
Interval around(double best, Interval side, std::size_t count)
{
    const double step = (side.high - side.low) / static_cast<double>(count - 1);
    return {std::fmax(side.low, best - step), std::fmin(side.high, best + step)};
}

}  // namespace

Surface::Surface(evaluate::Tape tape, std::vector<Interval> sides)
    : tape_(std::move(tape)), sides_(std::move(sides))
{
}

std::vector<double> Surface::values(std::span<const Place> places) const
{
    std::vector<double> x;
    std::vector<double> y;
    for (const Place place : places) {
        x.push_back(place.x);
        y.push_back(place.y);
    }
    const std::array<const double*, 2> inputs{x.data(), y.data()};
    std::vector<double> result(places.size());
    double* const output = result.data();
    evaluate::run(tape_, std::span{inputs}.first(sides_.size()), {&output, 1}, places.size());
    return result;
}

std::vector<double> Surface::confirmed(std::span<const Place> places) const
{
    constexpr int bits = 113;
    std::vector<evaluate::Real> x;
    std::vector<evaluate::Real> y;
    for (const Place place : places) {
        x.emplace_back(place.x, bits);
        y.emplace_back(place.y, bits);
    }
    const std::array<const evaluate::Real*, 2> inputs{x.data(), y.data()};
    std::vector<evaluate::Real> result(places.size(), evaluate::Real{bits});
    evaluate::Real* const output = result.data();
    evaluate::run_real(tape_, bits, std::span{inputs}.first(sides_.size()), {&output, 1},
                       places.size());
    std::vector<double> rounded;
    for (const evaluate::Real& value : result) rounded.push_back(value.to_double());
    return rounded;
}

Samples Surface::samples() const
{
    Samples result;
    result.width = 1025;
    result.height = 1;
    if (sides_.size() == 2) {
        // A long tape, such as a quadrature, is asked at fewer places: about two seconds at most.
        constexpr std::size_t most_operations = std::size_t{1} << 31;
        result.width = 257;
        while (result.width > 33 &&
               tape_.code.size() * result.width * result.width > most_operations)
            result.width = result.width / 2 + 1;
        result.height = result.width;
    }
    const auto x = grid_line(sides_[0], result.width);
    const auto y =
        sides_.size() == 2 ? grid_line(sides_[1], result.height) : std::vector<double>{0};
    for (const double row : y)
        for (const double column : x) result.places.push_back({column, row});
    result.values = values(result.places);
    return result;
}

std::vector<Difference> greatest_differences(const Surface& surface, const Samples& samples,
                                             const OtherValues& other)
{
    constexpr std::size_t most_peaks = 64;
    constexpr int rounds = 3;
    constexpr std::size_t lines = 9;

    const auto coarse = differences(samples.values, other(samples.places));
    std::vector<Cell> cells;
    for (const std::size_t peak : peaks(coarse, samples.width, samples.height, -1, most_peaks)) {
        const std::size_t column = peak % samples.width;
        const std::size_t row = peak / samples.width;
        const auto x = [&](std::size_t c) { return samples.places[c].x; };
        const auto y = [&](std::size_t r) { return samples.places[r * samples.width].y; };
        cells.push_back(
            {{x(column == 0 ? 0 : column - 1), x(std::min(column + 1, samples.width - 1))},
             {y(row == 0 ? 0 : row - 1), y(std::min(row + 1, samples.height - 1))},
             {samples.places[peak], coarse[peak]}});
    }

    for (int round = 0; round < rounds; ++round) {
        // All cells in one run: it is much faster than many.
        std::vector<Place> places;
        std::vector<std::size_t> ends;
        for (const Cell& cell : cells) {
            for (const double y : evenly(cell.y, lines))
                for (const double x : evenly(cell.x, lines)) places.push_back({x, y});
            ends.push_back(places.size());
        }
        const auto sizes = differences(surface.values(places), other(places));
        std::size_t begin = 0;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            Cell& cell = cells[i];
            for (std::size_t k = begin; k < ends[i]; ++k)
                if (sizes[k] > cell.best.size) cell.best = {places[k], sizes[k]};
            cell.x = around(cell.best.at.x, cell.x, lines);
            cell.y = around(cell.best.at.y, cell.y, lines);
            begin = ends[i];
        }
    }

    std::vector<Difference> result;
    for (const Cell& cell : cells) result.push_back(cell.best);
    std::ranges::stable_sort(
        result, [](const Difference& a, const Difference& b) { return a.size > b.size; });
    return result;
}

}  // namespace lobe::analyze
