#include "analyze/minimax/error.h"

#include "analyze/random.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lobe::analyze {
namespace {

using evaluate::Interval;
using evaluate::Tape;

/// A number per scalar of the inputs.
using Point = std::vector<double>;

class Pair {
public:
    Pair(const ir::Module& module, const ir::Function& term, const ir::Function& form)
        : term_{evaluate::compile(module, term)}, form_{evaluate::compile(module, form)}
    {
        for (const evaluate::TapeInput& input : term_.inputs) {
            const ir::Range range = term.inputs[input.input].range;
            sides_.push_back({range.low, range.high});
        }
    }

    const std::vector<Interval>& sides() const { return sides_; }
    const Tape& tape() const { return term_; }

    /// The difference at every point; adds the term's values to `least` and `greatest`.
    std::vector<double> differences(const std::vector<Point>& points)
    {
        const auto exact = run(term_, points);
        const auto approximate = run(form_, points);
        std::vector<double> result(points.size(), 0);
        for (std::size_t k = 0; k < exact.size(); ++k)
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double difference = std::fabs(exact[k][i] - approximate[k][i]);
                result[i] = std::isnan(difference) ? std::numeric_limits<double>::infinity()
                                                   : std::fmax(result[i], difference);
                least_ = std::fmin(least_, exact[k][i]);
                greatest_ = std::fmax(greatest_, exact[k][i]);
            }
        return result;
    }

    double range() const { return greatest_ - least_; }

private:
    static std::vector<std::vector<double>> run(const Tape& tape, const std::vector<Point>& points)
    {
        std::vector<std::vector<double>> columns(tape.inputs.size());
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (const Point& point : points) columns[i].push_back(point[i]);
        std::vector<const double*> inputs;
        for (const auto& column : columns) inputs.push_back(column.data());
        std::vector<std::vector<double>> results(tape.outputs.size(),
                                                 std::vector<double>(points.size()));
        std::vector<double*> outputs;
        for (auto& result : results) outputs.push_back(result.data());
        evaluate::run(tape, inputs, outputs, points.size());
        return results;
    }

    Tape term_;
    Tape form_;
    std::vector<Interval> sides_;
    double least_ = std::numeric_limits<double>::infinity();
    double greatest_ = -std::numeric_limits<double>::infinity();
};

std::vector<Point> points_of(const Pair& pair, const std::vector<Held>& held)
{
    constexpr std::size_t count = std::size_t{1} << 14;
    constexpr std::uint64_t key = 0x6d696e696d6178;
    Random random{key};
    std::vector<Point> result;
    for (std::size_t p = 0; p < count; ++p) {
        Point point;
        for (const Interval side : pair.sides()) {
            const double anywhere = random.between(side.low, side.high);
            const bool at_end = random.coin();
            point.push_back(!at_end ? anywhere : random.coin() ? side.low : side.high);
        }
        const Held& part = held[p % held.size()];
        const Place place = part.places[(p / held.size()) % part.places.size()];
        for (std::size_t i = 0; i < point.size(); ++i) {
            const auto input = std::ranges::find(part.inputs, pair.tape().inputs[i].input);
            if (input != part.inputs.end())
                point[i] = input == part.inputs.begin() ? place.x : place.y;
        }
        result.push_back(std::move(point));
    }
    return result;
}

/// Uphill along one input after another, by steps that halve.
double climbed(Pair& pair, Point point, double from)
{
    constexpr int rounds = 16;
    double best = from;
    double step = 1.0 / 8;
    for (int round = 0; round < rounds; ++round, step /= 2) {
        std::vector<Point> around;
        for (std::size_t i = 0; i < point.size(); ++i)
            for (const double way : {-step, step}) {
                const Interval side = pair.sides()[i];
                Point moved = point;
                moved[i] = std::clamp(moved[i] + way * (side.high - side.low), side.low, side.high);
                around.push_back(std::move(moved));
            }
        const auto sizes = pair.differences(around);
        const auto top = std::ranges::max_element(sizes);
        if (*top <= best) continue;
        best = *top;
        point = around[static_cast<std::size_t>(top - sizes.begin())];
    }
    return best;
}

}  // namespace

std::optional<Departure> departure(const ir::Module& module, const ir::Function& term,
                                   const ir::Function& form, const std::vector<Held>& held)
{
    constexpr std::size_t climbers = 8;
    Pair pair{module, term, form};
    for (const Interval side : pair.sides())
        if (!std::isfinite(side.low) || !std::isfinite(side.high)) return std::nullopt;

    const std::vector<Point> points = points_of(pair, held);
    const auto sizes = pair.differences(points);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    double error = sizes[order.front()];
    for (std::size_t i = 0; i < climbers; ++i)
        error = std::fmax(error, climbed(pair, points[order[i]], sizes[order[i]]));
    if (!std::isfinite(error) || !std::isfinite(pair.range())) return std::nullopt;
    return Departure{error, pair.range()};
}

}  // namespace lobe::analyze
