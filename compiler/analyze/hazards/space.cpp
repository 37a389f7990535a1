#include "analyze/hazards/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lobe::analyze {
namespace {

/// Unit, or z.
Vector unit(const Vector& a)
{
    const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    if (!(length > 0)) return {0, 0, 1};
    return {a.x / length, a.y / length, a.z / length};
}

/// Directions in the plane y = 0 above, at and below the horizon of z, simple ones first: axes,
/// the triangle 3 4 5, and small angles from the axes.
const std::vector<Vector>& plain_directions()
{
    static const std::vector<Vector> directions = [] {
        std::vector<Vector> out{{0, 0, 1},      {1, 0, 0},     {-1, 0, 0},     {0.6, 0, 0.8},
                                {-0.6, 0, 0.8}, {0.8, 0, 0.6}, {-0.8, 0, 0.6}, {0, 0, -1}};
        for (const double small : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
            const double rest = std::sqrt(1 - small * small);
            out.push_back({small, 0, rest});
            out.push_back({-small, 0, rest});
            out.push_back({rest, 0, small});
            out.push_back({-rest, 0, small});
        }
        return out;
    }();
    return directions;
}

/// The value with this many significant decimal digits.
double with_digits(double value, int digits)
{
    const std::string text = fmt::format("{:.{}g}", value, digits);
    double out = 0;
    std::from_chars(text.data(), text.data() + text.size(), out);
    return out;
}

}  // namespace

HazardSpace::HazardSpace(const ir::Module& module, ir::FunctionId function,
                         evaluate::Precision precision)
    : grid_{&grid_of(precision)}, inputs_{module, function, *grid_}
{
    std::size_t column = 0;
    for (const ir::Input& input : inputs_.entry().inputs) {
        const auto size = static_cast<std::size_t>(ir::components(input.type));
        const bool frame = input.origin == ir::Origin::geometry &&
                           input.which != static_cast<std::uint32_t>(ir::GeometryField::l) &&
                           input.which != static_cast<std::uint32_t>(ir::GeometryField::v);
        if (input.quantity == ir::Quantity::direction) {
            vectors_.push_back(column);
            if (!frame) turnable_.push_back(column);
        } else {
            for (std::size_t k = 0; k < size; ++k) numbers_.push_back(column + k);
        }
        column += size;
    }
}

double HazardSpace::inside(double value, const Scalar& scalar) const
{
    if (scalar.whole) value = std::floor(value + 0.5);
    // Ends are on the grid already.
    return static_cast<double>(
        to_grid(std::clamp(value, scalar.low, scalar.high), grid_->precision));
}

void HazardSpace::place(Point& point, std::size_t first, const Vector& value) const
{
    point[first] = static_cast<double>(to_grid(value.x, grid_->precision));
    point[first + 1] = static_cast<double>(to_grid(value.y, grid_->precision));
    point[first + 2] = static_cast<double>(to_grid(value.z, grid_->precision));
}

void HazardSpace::reflect(Point& point, const Vector& mirror) const
{
    for (const std::size_t first : vectors_) {
        const Vector v{point[first], point[first + 1], point[first + 2]};
        const double twice = 2 * (v.x * mirror.x + v.y * mirror.y + v.z * mirror.z);
        place(point, first,
              {v.x - twice * mirror.x, v.y - twice * mirror.y, v.z - twice * mirror.z});
    }
}

HazardSpace::Point HazardSpace::neighbor(const Point& point, Random& random) const
{
    Point out = point;
    if (!vectors_.empty() && random.below(4) == 0) {
        reflect(out, on_sphere(random));
        return out;
    }
    const auto choices = static_cast<std::uint32_t>(turnable_.size() + numbers_.size());
    if (choices == 0) return out;
    const std::uint32_t choice = random.below(choices);
    if (choice < turnable_.size()) {
        const std::size_t other =
            vectors_[random.below(static_cast<std::uint32_t>(vectors_.size()))];
        const std::size_t from = random.coin() ? turnable_[choice] : other;
        Vector turned{point[from], point[from + 1], point[from + 2]};
        switch (random.below(4)) {
        case 0: break;
        case 1: turned = {-turned.x, -turned.y, -turned.z}; break;
        default: {
            const double angle = random.magnitude(-grid_->digits, 0);
            turned.x += angle * random.between(-1, 1);
            turned.y += angle * random.between(-1, 1);
            turned.z += angle * random.between(-1, 1);
        }
        }
        place(out, turnable_[choice], unit(turned));
        return out;
    }
    const std::size_t column = numbers_[choice - turnable_.size()];
    const Scalar& scalar = inputs_.scalars()[column];
    double value = point[column];
    const double sign = random.coin() ? 1 : -1;
    switch (random.below(5)) {
    case 0: value = scalar.low; break;
    case 1: value = scalar.high; break;
    case 2: value = scalar.neutral; break;
    case 3: value *= random.coin() ? 0.5 : 2; break;
    default: value += sign * step_at(value, *grid_) * random.magnitude(0, grid_->digits); break;
    }
    out[column] = inside(value, scalar);
    return out;
}

std::vector<HazardSpace::Point> HazardSpace::indistinguishable(const Point& point) const
{
    std::vector<Point> out;
    const auto add = [&](std::size_t column, double step) {
        for (const double sign : {-1.0, 1.0}) {
            out.push_back(point);
            out.back()[column] += sign * step;
        }
    };
    for (const std::size_t column : numbers_)
        if (!inputs_.scalars()[column].whole) add(column, step_at(point[column], *grid_) / 2);
    for (const std::size_t first : vectors_)
        for (std::size_t k = 0; k < 3; ++k) add(first + k, step_at(1, *grid_) / 2);
    return out;
}

void HazardSpace::simplify_directions(Point& point,
                                      const std::function<bool(const Point&)>& holds) const
{
    if (!inputs_.has_geometry()) return;
    const auto column = [&](ir::GeometryField field) { return *inputs_.find(field); };
    Point tried = point;
    place(tried, column(ir::GeometryField::n), {0, 0, 1});
    if (inputs_.has_tangents()) {
        place(tried, column(ir::GeometryField::x), {1, 0, 0});
        place(tried, column(ir::GeometryField::y), {0, 1, 0});
    }
    const std::vector<Vector>& plain = plain_directions();
    // Pairs by the sum of their places: simple ones first.
    for (std::size_t both = 0; both < 2 * plain.size() - 1; ++both)
        for (std::size_t i = 0; i <= both; ++i) {
            if (i >= plain.size() || both - i >= plain.size()) continue;
            place(tried, column(ir::GeometryField::l), plain[i]);
            place(tried, column(ir::GeometryField::v), plain[both - i]);
            if (!holds(tried)) continue;
            point = tried;
            return;
        }
}

void HazardSpace::simplify_scalar(Point& point, std::size_t column,
                                  const std::function<bool(const Point&)>& holds) const
{
    const Scalar& scalar = inputs_.scalars()[column];
    std::vector<double> candidates{scalar.neutral, 0.5, 1, 0, scalar.low, scalar.high, 0.25, 0.1};
    for (int digits = 1; digits <= 5; ++digits)
        candidates.push_back(with_digits(point[column], digits));
    const double before = point[column];
    for (const double candidate : candidates) {
        if (!scalar.contains(candidate)) continue;
        point[column] = inside(candidate, scalar);
        if (point[column] == before || holds(point)) return;
    }
    point[column] = before;
}

HazardSpace::Point HazardSpace::simplest(const Point& point,
                                         const std::function<bool(const Point&)>& holds) const
{
    Point out = point;
    simplify_directions(out, holds);
    for (const std::size_t column : numbers_) simplify_scalar(out, column, holds);
    return out;
}

}  // namespace lobe::analyze
