#include "analyze/minimax/fit.h"

#include "analyze/minimax/linear_program.h"
#include "analyze/minimax/orthogonal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

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

double sum(const std::vector<Powers>& powers, std::span<const double> coefficients, Place at)
{
    double result = 0;
    for (std::size_t i = 0; i < powers.size(); ++i)
        result += coefficients[i] * monomial(powers[i], at);
    return result;
}

/// Which coefficients may not change any more; numerator first, then the denominator's with its
/// constant.
using Fixed = std::vector<bool>;

/// All coefficients in one row, with the denominator's constant: what can be scaled as a whole.
class Fitting {
public:
    Fitting(const Shape& shape, const Samples& samples) : shape_{shape}, samples_{samples}
    {
        if (!shape.denominator.empty())
            shape_.denominator.insert(shape_.denominator.begin(), Powers{0, 0});
        // Every place between, and of the lattice enough to begin with.
        const std::size_t lattice = samples.width * samples.height;
        const std::size_t step =
            std::max<std::size_t>(1, (samples.width - 1) / (samples.height == 1 ? 64 : 16));
        for (std::size_t i = lattice; i < samples.places.size(); ++i) seen_.push_back(i);
        for (std::size_t row = 0; row < samples.height; row += step)
            for (std::size_t column = 0; column < samples.width; column += step)
                seen_.push_back(row * samples.width + column);
        for (const double value : samples.values) scale_ = std::fmax(scale_, std::fabs(value));
    }

    std::size_t coefficients() const { return shape_.numerator.size() + shape_.denominator.size(); }
    bool is_ratio() const { return !shape_.denominator.empty(); }

    /// 0, or 0 / 1.
    std::vector<double> nothing() const
    {
        std::vector<double> result(coefficients(), 0);
        if (is_ratio()) result[shape_.numerator.size()] = 1;
        return result;
    }

    std::vector<double> row_of(const Ratio& ratio) const
    {
        std::vector<double> result = ratio.numerator;
        if (is_ratio()) result.push_back(1);
        result.insert(result.end(), ratio.denominator.begin(), ratio.denominator.end());
        return result;
    }

    /// With 1 for the denominator's constant.
    Ratio ratio_of(const std::vector<double>& row) const
    {
        const auto middle = row.begin() + static_cast<std::ptrdiff_t>(shape_.numerator.size());
        Ratio result{{row.begin(), middle}, {}};
        if (!is_ratio()) return result;
        for (double& c : result.numerator) c /= *middle;
        for (auto c = middle + 1; c != row.end(); ++c) result.denominator.push_back(*c / *middle);
        return result;
    }

    /// The greatest difference over all samples; infinite where the denominator falls too low.
    double level(const std::vector<double>& row) const
    {
        const std::vector<double> all = differences(row);
        return *std::ranges::max_element(all);
    }

    /// Steps until neither a program nor an exchange makes it better.
    std::vector<double> improve(std::vector<double> row, const Fixed& fixed)
    {
        constexpr int most_steps = 64;  // what has not settled by then is a fit all the same
        constexpr double settled = 1 - 1e-5;
        constexpr double worse = 1 + 1e-3;
        constexpr std::size_t most_new = 48;
        const double exact = 0x1p-46 * scale_;  // no difference, for a double's digits

        double reached = level_over_seen(row);
        for (int step = 0; step < most_steps; ++step) {
            const auto better = reached > exact ? corrected(row, reached, fixed) : std::nullopt;
            const double next = better ? level_over_seen(*better) : infinity;
            if (next < reached * settled) {
                row = *better;
                reached = next;
                continue;
            }
            auto worst = peaks(differences(row), samples_.width, samples_.height,
                               std::fmax(reached * worse, exact), most_new);
            std::erase_if(worst, [&](std::size_t place) {
                return std::ranges::find(seen_, place) != seen_.end();
            });
            if (worst.empty()) break;
            seen_.insert(seen_.end(), worst.begin(), worst.end());
            reached = level_over_seen(row);
            if (reached < infinity) continue;
            // The denominator fell too low between the places that were seen: start over.
            if (std::ranges::find(fixed, true) != fixed.end()) break;
            row = nothing();
            reached = level_over_seen(row);
        }
        return row;
    }

private:
    double top(const std::vector<double>& row, Place at) const
    {
        return sum(shape_.numerator, std::span{row}.first(shape_.numerator.size()), at);
    }

    double bottom(const std::vector<double>& row, Place at) const
    {
        if (!is_ratio()) return 1;
        return sum(shape_.denominator, std::span{row}.subspan(shape_.numerator.size()), at);
    }

    double difference(const std::vector<double>& row, std::size_t place) const
    {
        constexpr double nearly = 1 - 1e-6;
        const Place at = samples_.places[place];
        const double q = bottom(row, at);
        if (is_ratio() && !(q >= least_denominator * row[shape_.numerator.size()] * nearly))
            return infinity;
        return std::fabs(samples_.values[place] - top(row, at) / q);
    }

    double level_over_seen(const std::vector<double>& row) const
    {
        double result = 0;
        for (const std::size_t place : seen_) result = std::fmax(result, difference(row, place));
        return result;
    }

    std::vector<double> differences(const std::vector<double>& row) const
    {
        std::vector<double> result(samples_.places.size());
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = difference(row, i);
        return result;
    }

    /// One step of the differential correction, in units of the level E: p + E a and q + E b with
    /// the least u in
    ///
    ///   |f (q + E b) - (p + E a)| / E - (q + E b) <= u q
    ///
    /// and, where p and q may be scaled, coefficients of the denominator in [-1, 1].
    std::optional<std::vector<double>> corrected(const std::vector<double>& from, double level,
                                                 const Fixed& fixed) const
    {
        const std::size_t tops = shape_.numerator.size();
        std::vector<std::size_t> open;  // coefficients that may change
        for (std::size_t i = 0; i < fixed.size(); ++i)
            if (!fixed[i]) open.push_back(i);
        const auto power_of = [&](std::size_t k, Place at) {
            return open[k] < tops ? monomial(shape_.numerator[open[k]], at)
                                  : monomial(shape_.denominator[open[k] - tops], at);
        };

        // (f b - a) / q and, below, b / q, by coefficient. Orthogonal combinations of these columns
        // are the unknowns: powers alone are so alike that programs lose their way among them.
        Columns columns(open.size(), std::vector<double>(2 * seen_.size(), 0));
        for (std::size_t s = 0; s < seen_.size(); ++s) {
            const Place at = samples_.places[seen_[s]];
            const double q = bottom(from, at);
            for (std::size_t k = 0; k < open.size(); ++k) {
                const double part = power_of(k, at) / q;
                columns[k][s] = open[k] < tops ? -part : samples_.values[seen_[s]] * part;
                if (open[k] >= tops) columns[k][seen_.size() + s] = part;
            }
        }
        const Triangle triangle = orthogonalize(columns);

        const std::size_t unknowns = open.size() + 1;
        std::vector<double> cost(unknowns, 0);
        std::vector<double> low(unknowns, -infinity);
        std::vector<double> high(unknowns, infinity);
        cost.back() = 1;
        high.back() = 0;
        LinearProgram program{cost, low, high};
        // value of coefficients times weights <= limit
        const auto require = [&](std::vector<double> weights, double limit) {
            triangle.divide(weights);
            weights.push_back(0);
            program.require(weights, limit);
        };

        std::vector<double> row(unknowns);
        for (std::size_t s = 0; s < seen_.size(); ++s) {
            const Place at = samples_.places[seen_[s]];
            const double q = bottom(from, at);
            const double residue = (samples_.values[seen_[s]] - top(from, at) / q) / level;
            for (const double sign : {1.0, -1.0}) {
                for (std::size_t k = 0; k < open.size(); ++k)
                    row[k] = sign * columns[k][s] - level * columns[k][seen_.size() + s];
                row.back() = -1;
                program.require(row, 1 - sign * residue);
            }
            if (!is_ratio()) continue;
            // q + E b >= least (c + E d), with c the constant and d its change
            std::vector<double> weights(open.size(), 0);
            for (std::size_t k = 0; k < open.size(); ++k)
                if (open[k] >= tops)
                    weights[k] = (open[k] == tops ? least_denominator : 0) - power_of(k, at);
            for (double& weight : weights) weight *= level / q;
            require(std::move(weights), 1 - least_denominator * from[tops] / q);
        }
        if (is_ratio() && !fixed[tops])
            for (std::size_t k = 0; k < open.size(); ++k) {
                if (open[k] < tops) continue;
                // The constant is what the others are divided by in the end.
                constexpr double least_constant = 0x1p-20;
                std::vector<double> weights(open.size(), 0);
                weights[k] = level;
                require(weights, 1 - from[open[k]]);
                weights[k] = -level;
                require(weights, from[open[k]] + (open[k] == tops ? -least_constant : 1));
            }
        auto solution = program.solve();
        if (!solution) return std::nullopt;
        solution->pop_back();
        triangle.solve(*solution);
        std::vector<double> result = from;
        for (std::size_t k = 0; k < open.size(); ++k) result[open[k]] += level * (*solution)[k];
        return result;
    }

    Shape shape_;  ///< with the denominator's constant
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
    Fitting fitting{shape, samples};
    const auto row = fitting.improve(fitting.nothing(), Fixed(fitting.coefficients(), false));
    const double level = fitting.level(row);
    if (!(level < infinity)) return std::nullopt;
    return Fit{fitting.ratio_of(row), level};
}

Fit round_to_float(const Shape& shape, const Samples& samples, const Fit& fit)
{
    Fitting fitting{shape, samples};
    const std::vector<double> start = fitting.row_of(fit.ratio);
    std::vector<double> at_once = start;
    for (double& value : at_once) value = to_float(value);
    const double level_at_once = fitting.level(at_once);
    // What rounding costs here nobody sees.
    constexpr double good_enough = 1 + 1e-3;
    if (level_at_once <= fit.level * good_enough) return {fitting.ratio_of(at_once), level_at_once};

    std::vector<std::size_t> order(start.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return std::fabs(start[a]) > std::fabs(start[b]);
    });
    std::vector<double> one_by_one = start;
    Fixed fixed(start.size(), false);
    if (fitting.is_ratio()) fixed[shape.numerator.size()] = true;
    for (const std::size_t i : order) {
        one_by_one[i] = to_float(one_by_one[i]);
        fixed[i] = true;
        one_by_one = fitting.improve(one_by_one, fixed);
    }
    const double level = fitting.level(one_by_one);
    if (level < level_at_once) return {fitting.ratio_of(one_by_one), level};
    return {fitting.ratio_of(at_once), level_at_once};
}

}  // namespace lobe::analyze
