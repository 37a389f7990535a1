#include "analyze/proof/search.h"

#include "analyze/grid.h"
#include "analyze/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

using evaluate::Interval;

constexpr std::size_t capacity = 48;

double anywhere(Random& random, const Interval& side, const Grid& grid)
{
    const double width = side.high - side.low;
    switch (random.below(8)) {
    case 0: return random.coin() ? side.low : side.high;
    case 1: return side.low + width * random.magnitude(-26, 0);
    case 2: return side.high - width * random.magnitude(-26, 0);
    case 3: {
        // By binades of the value itself.
        const double most = std::max(std::abs(side.low), std::abs(side.high));
        const double least = side.low > 0 ? side.low : grid.least;
        if (!(most > 0) || !(least < most)) return side.low;
        const double low = std::log2(least);
        const double value = std::exp2(random.between(low, std::log2(most)));
        return side.low < 0 && (side.high <= 0 || random.coin()) ? -value : value;
    }
    default: return random.between(side.low, side.high);
    }
}

using Coordinates = std::array<double, 3>;

Coordinates coordinates(const Point& point, const std::array<std::size_t, 3>& vector)
{
    return {point[vector[0]], point[vector[1]], point[vector[2]]};
}

void place(const Subject& subject, const Box& box, const std::array<std::size_t, 3>& vector,
           const Coordinates& at, double scale, Point& point)
{
    for (std::size_t k = 0; k < 3; ++k)
        point[vector[k]] = on_grid(at[k] * scale, box[vector[k]], subject.precision);
}

/// Vectors as scenes have them: of length one where they fit, along each other, across each other.
void relate_vectors(const Subject& subject, const Box& box, Random& random, Point& point)
{
    const auto length = [](const Coordinates& v) { return std::hypot(v[0], v[1], v[2]); };
    for (const auto& vector : subject.vectors) {
        const Coordinates v = coordinates(point, vector);
        if (box[vector[0]].high <= 1 && length(v) > 0)
            place(subject, box, vector, v, 1 / length(v), point);
    }
    const auto number = static_cast<std::uint32_t>(subject.vectors.size());
    if (number < 2) return;
    const auto& moved = subject.vectors[random.below(number)];
    const auto& other = subject.vectors[random.below(number)];
    const Coordinates to = coordinates(point, other);
    if (&moved == &other || !(length(to) > 0)) return;
    Coordinates v = coordinates(point, moved);
    const double size = length(v);
    const double along = (v[0] * to[0] + v[1] * to[1] + v[2] * to[2]) / (length(to) * length(to));
    switch (random.below(3)) {
    case 0:
        place(subject, box, moved, to, (random.coin() ? size : -size) / length(to), point);
        break;
    case 1:
        for (std::size_t k = 0; k < 3; ++k) v[k] -= along * to[k];
        if (length(v) > 0) place(subject, box, moved, v, size / length(v), point);
        break;
    default: break;
    }
}

}  // namespace

double error_of(const Subject& subject, const Observed& value, Measure measure)
{
    const double error = std::abs(value.computed - value.exact);
    if (error != error) return HUGE_VAL;
    return measure == Measure::relative ? error / std::max(std::abs(value.exact), subject.floor)
                                        : error;
}

Worst::Worst(const Subject& subject, Measure measure)
    : subject_{subject}, measure_{measure}, bounds_{subject.steps,
                                                    evaluate::rounding(evaluate::Machine::kernels,
                                                                       subject.precision),
                                                    subject.floor},
      may_jump_{bounds_.error(subject.box).jump > 0}
{
}

/// More than rounding explains, where a decision may turn.
bool Worst::is_jump(const Point& point, double error)
{
    Box here;
    for (const float x : point) here.push_back({x, x});
    const evaluate::BoxError bound = bounds_.error(here);
    const double smooth = measure_ == Measure::relative ? bound.relative : bound.absolute;
    return bound.jump > 0 && error > smooth;
}

void Worst::consider(const std::vector<Point>& points, const std::vector<Observed>& values)
{
    if (measure_ == Measure::jump && !may_jump_) return;
    std::vector<std::pair<double, std::size_t>> order;  // by error, the greatest first
    const double least = entries_.size() == capacity ? entries_.back().error : 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const double error = error_of(subject_, values[i], measure_); error > least)
            order.emplace_back(-error, i);
    std::ranges::sort(order);
    // Whether a point is a jump takes a bound to know: of many points, of the worst.
    if (order.size() > capacity) order.resize(capacity);
    if (measure_ == Measure::jump && order.size() > 4) order.resize(4);
    for (const auto& each : order) {
        const double error = -each.first;
        const Point& point = points[each.second];
        if (entries_.size() == capacity && error <= entries_.back().error) break;
        if (std::ranges::any_of(entries_, [&](const Entry& e) { return e.point == point; }))
            continue;
        const bool jumps = may_jump_ && is_jump(point, error);
        if (jumps != (measure_ == Measure::jump)) continue;
        const auto at = std::ranges::find_if(
            entries_, [error](const Entry& entry) { return entry.error < error; });
        entries_.insert(at, {error, point});
        if (entries_.size() > capacity) entries_.pop_back();
    }
}

std::vector<Point> points_in(const Subject& subject, const Box& box, std::size_t count,
                             std::uint64_t key)
{
    const Grid& grid = grid_of(subject.precision);
    std::vector<Point> points(count, Point(box.size()));
    for (std::size_t p = 0; p < count; ++p) {
        Random random{key + p};
        const bool corner = random.below(4) == 0;
        for (std::size_t i = 0; i < box.size(); ++i) {
            double value = anywhere(random, box[i], grid);
            if (corner && random.below(3) > 0) value = random.coin() ? box[i].low : box[i].high;
            if (subject.whole[i]) value = std::floor(value + 0.5);
            points[p][i] = on_grid(value, box[i], subject.precision);
        }
        if (!subject.vectors.empty() && random.below(4) == 0)
            relate_vectors(subject, box, random, points[p]);
    }
    return points;
}

std::vector<Point> points_near(const Subject& subject, const Point& center, std::size_t count,
                               std::uint64_t key)
{
    const Grid& grid = grid_of(subject.precision);
    std::vector<Point> points(count, center);
    for (std::size_t p = 0; p < count; ++p) {
        Random random{key + p};
        const double scale = random.magnitude(-24, -1);
        const std::uint32_t all = random.below(3);
        const std::uint32_t chosen = random.below(static_cast<std::uint32_t>(center.size()));
        for (std::size_t i = 0; i < center.size(); ++i) {
            if (all == 0 ? i != chosen : random.coin()) continue;
            const double x = center[i];
            double value = x;
            switch (random.below(9)) {
            case 0: value = random.coin() ? subject.box[i].low : subject.box[i].high; break;
            case 1:
            case 2:
                value = x + step_at(x, grid) * (static_cast<double>(random.below(9)) - 4);
                break;
            case 3:
            case 4: value = x * (1 + random.between(-scale, scale)); break;
            case 5:
            case 6: value = 1 - (1 - x) * (1 + random.between(-scale, scale)); break;
            default:
                value =
                    x + (subject.box[i].high - subject.box[i].low) * random.between(-scale, scale);
            }
            if (subject.whole[i]) value = std::floor(value + 0.5);
            points[p][i] = on_grid(value, subject.box[i], subject.precision);
        }
    }
    return points;
}

}  // namespace lobe::analyze
