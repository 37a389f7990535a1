#include "analyze/fit.h"

#include "analyze/linear_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lobe::analyze {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double power(double x, int exponent)
{
    double result = 1;
    for (int i = 0; i < exponent; ++i) result *= x;
    return result;
}

double monomial(Powers powers, Place at) { return power(at.x, powers.x) * power(at.y, powers.y); }

double sum(const std::vector<Powers>& powers, const std::vector<double>& coefficients, Place at)
{
    double result = 0;
    for (std::size_t i = 0; i < powers.size(); ++i)
        result += coefficients[i] * monomial(powers[i], at);
    return result;
}

Ratio nothing(const Shape& shape)
{
    return {std::vector<double>(shape.numerator.size(), 0),
            std::vector<double>(shape.denominator.size(), 0)};
}

/// Which coefficients may not change any more; numerator first.
using Fixed = std::vector<bool>;

class Fitting {
public:
    Fitting(const Shape& shape, const Samples& samples) : shape_{shape}, samples_{samples}
    {
        // Every place between, and of the lattice enough to begin with.
        const std::size_t lattice = samples.width * samples.height;
        const std::size_t step = samples.height == 1 ? 16 : 8;
        for (std::size_t i = lattice; i < samples.places.size(); ++i) seen_.push_back(i);
        for (std::size_t row = 0; row < samples.height; row += step)
            for (std::size_t column = 0; column < samples.width; column += step)
                seen_.push_back(row * samples.width + column);
        for (const double value : samples.values) scale_ = std::fmax(scale_, std::fabs(value));
    }

    /// Steps until neither a program nor an exchange makes it better.
    std::optional<Fit> improve(Ratio ratio, const Fixed& fixed)
    {
        constexpr int most_steps = 64;  // what has not settled by then is a fit all the same
        constexpr double settled = 1 - 1e-5;
        constexpr double worse = 1 + 1e-3;
        constexpr std::size_t most_new = 48;
        const double exact = 0x1p-46 * scale_;  // no difference, for a double's digits

        double level = level_over_seen(ratio);
        for (int step = 0; step < most_steps; ++step) {
            const auto better = level > exact ? corrected(ratio, level, fixed) : std::nullopt;
            const double reached = better ? level_over_seen(*better) : infinity;
            if (reached < level * settled) {
                ratio = *better;
                level = reached;
                continue;
            }
            auto worst = peaks(differences(ratio), samples_.width, samples_.height,
                               std::fmax(level * worse, exact), most_new);
            std::erase_if(worst, [&](std::size_t place) {
                return std::ranges::find(seen_, place) != seen_.end();
            });
            if (worst.empty()) break;
            seen_.insert(seen_.end(), worst.begin(), worst.end());
            level = level_over_seen(ratio);
            if (level < infinity) continue;
            // The denominator fell too low between the places that were seen: start over.
            if (std::ranges::find(fixed, true) != fixed.end()) return std::nullopt;
            ratio = nothing(shape_);
            level = level_over_seen(ratio);
        }
        level = this->level(ratio);
        if (!(level < infinity)) return std::nullopt;
        return Fit{std::move(ratio), level};
    }

    /// The greatest difference over all samples.
    double level(const Ratio& ratio) const
    {
        const std::vector<double> all = differences(ratio);
        return *std::ranges::max_element(all);
    }

private:
    double difference(const Ratio& ratio, std::size_t place) const
    {
        const Place at = samples_.places[place];
        const double bottom = 1 + sum(shape_.denominator, ratio.denominator, at);
        if (!(bottom >= least_denominator * (1 - 1e-6))) return infinity;
        return std::fabs(samples_.values[place] -
                         sum(shape_.numerator, ratio.numerator, at) / bottom);
    }

    double level_over_seen(const Ratio& ratio) const
    {
        double level = 0;
        for (const std::size_t place : seen_) level = std::fmax(level, difference(ratio, place));
        return level;
    }

    std::vector<double> differences(const Ratio& ratio) const
    {
        std::vector<double> result(samples_.places.size());
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = difference(ratio, i);
        return result;
    }

    /// One step of the differential correction, in units of the level E: p + E a and q + E b with
    /// the least u in
    ///
    ///   |f (q + E b) - (p + E a)| / E - (q + E b) <= u q,   q + E b >= least_denominator
    std::optional<Ratio> corrected(const Ratio& from, double level, const Fixed& fixed) const
    {
        const std::size_t tops = shape_.numerator.size();
        const std::size_t bottoms = shape_.denominator.size();
        const std::size_t unknowns = tops + bottoms + 1;
        std::vector<double> cost(unknowns, 0);
        std::vector<double> low(unknowns, -infinity);
        std::vector<double> high(unknowns, infinity);
        cost.back() = 1;
        low.back() = -1;
        // Bounded, as the algorithm's convergence asks for.
        constexpr double largest = 0x1p14;
        for (std::size_t i = 0; i < bottoms; ++i) {
            low[tops + i] = (-largest - from.denominator[i]) / level;
            high[tops + i] = (largest - from.denominator[i]) / level;
        }
        for (std::size_t i = 0; i < fixed.size(); ++i)
            if (fixed[i]) low[i] = high[i] = 0;

        LinearProgram program{cost, low, high};
        std::vector<double> row(unknowns);
        for (const std::size_t place : seen_) {
            const Place at = samples_.places[place];
            const double f = samples_.values[place];
            const double q = 1 + sum(shape_.denominator, from.denominator, at);
            const double p = sum(shape_.numerator, from.numerator, at);
            const double residue = (f * q - p) / level;
            for (const double sign : {1.0, -1.0}) {
                for (std::size_t i = 0; i < tops; ++i)
                    row[i] = -sign * monomial(shape_.numerator[i], at) / q;
                for (std::size_t i = 0; i < bottoms; ++i)
                    row[tops + i] = (sign * f - level) * monomial(shape_.denominator[i], at) / q;
                row.back() = -1;
                program.require(row, 1 - sign * residue / q);
            }
            if (bottoms == 0) continue;
            std::ranges::fill(row, 0);
            for (std::size_t i = 0; i < bottoms; ++i)
                row[tops + i] = -level * monomial(shape_.denominator[i], at);
            program.require(row, q - least_denominator);
        }
        const auto solution = program.solve();
        if (!solution) return std::nullopt;
        Ratio result = from;
        for (std::size_t i = 0; i < tops; ++i) result.numerator[i] += level * (*solution)[i];
        for (std::size_t i = 0; i < bottoms; ++i)
            result.denominator[i] += level * (*solution)[tops + i];
        return result;
    }

    const Shape& shape_;
    const Samples& samples_;
    std::vector<std::size_t> seen_;
    double scale_ = 0;
};

double to_float(double value) { return static_cast<double>(static_cast<float>(value)); }

}  // namespace

double denominator_at(const Shape& shape, const Ratio& ratio, Place at)
{
    return 1 + sum(shape.denominator, ratio.denominator, at);
}

double value_at(const Shape& shape, const Ratio& ratio, Place at)
{
    return sum(shape.numerator, ratio.numerator, at) / denominator_at(shape, ratio, at);
}

std::vector<std::size_t> peaks(const std::vector<double>& differences, std::size_t width,
                               std::size_t height, double above, std::size_t most)
{
    const auto is_peak = [&](std::size_t row, std::size_t column) {
        const double here = differences[row * width + column];
        if (!(here > above)) return false;
        for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, height - 1); ++r)
            for (std::size_t c = column == 0 ? 0 : column - 1; c <= std::min(column + 1, width - 1);
                 ++c)
                if (differences[r * width + c] > here) return false;
        return true;
    };
    std::vector<std::size_t> result;
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t column = 0; column < width; ++column)
            if (is_peak(row, column)) result.push_back(row * width + column);
    std::ranges::stable_sort(
        result, [&](std::size_t a, std::size_t b) { return differences[a] > differences[b]; });
    if (result.size() > most) result.resize(most);
    return result;
}

std::optional<Fit> best_fit(const Shape& shape, const Samples& samples)
{
    return Fitting{shape, samples}.improve(
        nothing(shape), Fixed(shape.numerator.size() + shape.denominator.size(), false));
}

Fit round_to_float(const Shape& shape, const Samples& samples, const Fit& fit)
{
    const std::size_t tops = shape.numerator.size();
    const auto coefficient = [&](Ratio& ratio, std::size_t i) -> double& {
        return i < tops ? ratio.numerator[i] : ratio.denominator[i - tops];
    };
    const auto degree = [&](std::size_t i) {
        const Powers powers = i < tops ? shape.numerator[i] : shape.denominator[i - tops];
        return powers.x + powers.y;
    };
    std::vector<std::size_t> order(tops + shape.denominator.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return degree(a) > degree(b); });

    Fitting fitting{shape, samples};
    Fit at_once = fit;
    for (const std::size_t i : order) {
        double& value = coefficient(at_once.ratio, i);
        value = to_float(value);
    }
    at_once.level = fitting.level(at_once.ratio);
    // What rounding costs here nobody sees.
    constexpr double good_enough = 1 + 1e-3;
    if (at_once.level <= fit.level * good_enough) return at_once;

    Ratio ratio = fit.ratio;
    Fixed fixed(order.size(), false);
    for (const std::size_t i : order) {
        double& value = coefficient(ratio, i);
        value = to_float(value);
        fixed[i] = true;
        if (auto better = fitting.improve(ratio, fixed)) ratio = std::move(better->ratio);
    }
    const Fit one_by_one{ratio, fitting.level(ratio)};
    return one_by_one.level < at_once.level ? one_by_one : at_once;
}

}  // namespace lobe::analyze
