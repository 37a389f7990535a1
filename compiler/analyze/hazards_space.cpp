#include "analyze/hazards_space.h"

#include "evaluate/tape.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lobe::analyze {
namespace {

using Triple = std::array<double, 3>;

Triple sum(const Triple& a, const Triple& b, double factor)
{
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// Unit, or z.
Triple unit(const Triple& a)
{
    const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if (!(length > 0)) return {0, 0, 1};
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// Directions in the plane y = 0 above, at and below the horizon of z, simple ones first: axes,
/// the triangle 3 4 5, and small angles from the axes.
const std::vector<Triple>& plain_directions()
{
    static const std::vector<Triple> directions = [] {
        std::vector<Triple> out{{0, 0, 1},      {1, 0, 0},     {-1, 0, 0},     {0.6, 0, 0.8},
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
    : entry_{ir::entry_point(module, function)}, grid_{&grid_of(precision)}
{
    for (const ir::Input& input : entry_.inputs) {
        const bool parameter = input.origin == ir::Origin::parameter;
        defaults_.push_back(parameter ? module.parameters[input.which].default_value
                                      : std::vector<double>{});
        const bool direction = input.quantity == ir::Quantity::direction;
        const bool geometry = input.origin == ir::Origin::geometry;
        if (geometry) geometry_.push_back(names_.size());
        // l and v come first; n and the tangent frame stay where they are.
        if (direction && (!geometry || geometry_.size() <= 2)) vectors_.push_back(names_.size());
        for (int k = 0; k < ir::components(input.type); ++k) {
            if (!direction) free_scalars_.push_back(names_.size());
            names_.push_back(input.name +
                             evaluate::component_suffix(input.type, input.quantity, k));
            Scalar scalar;
            scalar.low = std::max(input.range.low, -grid_->largest);
            scalar.high = std::min(input.range.high, grid_->largest);
            scalar.whole =
                input.quantity == ir::Quantity::integer || input.quantity == ir::Quantity::boolean;
            if (input.quantity == ir::Quantity::boolean) scalar.low = 0, scalar.high = 1;
            scalar.neutral = parameter ? defaults_.back()[static_cast<std::size_t>(k)]
                                       : std::clamp(1.0, scalar.low, scalar.high);
            scalars_.push_back(scalar);
        }
    }
}

double HazardSpace::inside(double value, const Scalar& scalar) const
{
    if (scalar.whole) value = std::floor(value + 0.5);
    double rounded =
        static_cast<double>(to_grid(std::clamp(value, scalar.low, scalar.high), grid_->precision));
    // Ends are rounded inwards: a range is a promise that points must keep.
    if (rounded > scalar.high) rounded = next_below(rounded, *grid_);
    if (rounded < scalar.low) rounded = next_above(rounded, *grid_);
    return rounded;
}

void HazardSpace::place(Point& point, std::size_t first, const Triple& value) const
{
    for (std::size_t k = 0; k < 3; ++k)
        point[first + k] = static_cast<double>(to_grid(value[k], grid_->precision));
}

HazardSpace::Triple HazardSpace::at(const Point& point, std::size_t first) const
{
    return {point[first], point[first + 1], point[first + 2]};
}

HazardSpace::Point HazardSpace::neighbor(const Point& point, Random& random) const
{
    Point out = point;
    const auto choices = static_cast<std::uint32_t>(vectors_.size() + free_scalars_.size());
    if (choices == 0) return out;
    const std::uint32_t choice = random.below(choices);
    if (choice < vectors_.size()) {
        const std::size_t first = vectors_[choice];
        const std::size_t other =
            vectors_[random.below(static_cast<std::uint32_t>(vectors_.size()))];
        const Triple here = at(point, first);
        Triple turned = at(point, other);
        switch (random.below(4)) {
        case 0: break;
        case 1: turned = {-turned[0], -turned[1], -turned[2]}; break;
        default: {
            const Triple aside{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
            turned = sum(random.coin() ? here : turned, aside, random.magnitude(-24, 0));
        }
        }
        place(out, first, unit(turned));
        return out;
    }
    const std::size_t column = free_scalars_[choice - vectors_.size()];
    const Scalar& scalar = scalars_[column];
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
    for (const std::size_t column : free_scalars_) {
        const Scalar& scalar = scalars_[column];
        if (!scalar.whole) add(column, step_at(point[column], *grid_) / 2);
    }
    for (const std::vector<std::size_t>* vectors : {&vectors_, &geometry_})
        for (const std::size_t first : *vectors)
            for (std::size_t k = 0; k < 3; ++k) add(first + k, step_at(1, *grid_) / 2);
    return out;
}

void HazardSpace::simplify_directions(Point& point,
                                      const std::function<bool(const Point&)>& holds) const
{
    constexpr std::size_t vectors_of_frame = 5;
    if (geometry_.size() < 3) return;
    Point tried = point;
    place(tried, geometry_[2], {0, 0, 1});
    if (geometry_.size() == vectors_of_frame) {
        place(tried, geometry_[3], {1, 0, 0});
        place(tried, geometry_[4], {0, 1, 0});
    }
    const std::vector<Triple>& plain = plain_directions();
    // Pairs by the sum of their places: simple ones first.
    for (std::size_t both = 0; both < 2 * plain.size() - 1; ++both)
        for (std::size_t i = 0; i <= both; ++i) {
            if (i >= plain.size() || both - i >= plain.size()) continue;
            place(tried, geometry_[0], plain[i]);
            place(tried, geometry_[1], plain[both - i]);
            if (!holds(tried)) continue;
            point = tried;
            return;
        }
}

void HazardSpace::simplify_scalar(Point& point, std::size_t column,
                                  const std::function<bool(const Point&)>& holds) const
{
    const Scalar& scalar = scalars_[column];
    std::vector<double> candidates{scalar.neutral, 0.5, 1, 0, scalar.low, scalar.high, 0.25, 0.1};
    for (int digits = 1; digits <= 5; ++digits)
        candidates.push_back(with_digits(point[column], digits));
    const double before = point[column];
    for (const double candidate : candidates) {
        if (!(candidate >= scalar.low && candidate <= scalar.high)) continue;
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
    for (const std::size_t column : free_scalars_) simplify_scalar(out, column, holds);
    return out;
}

std::string HazardSpace::describe(const Point& point) const
{
    std::string text;
    std::size_t column = 0;
    for (std::size_t i = 0; i < entry_.inputs.size(); ++i) {
        const auto size = static_cast<std::size_t>(ir::components(entry_.inputs[i].type));
        bool standard = !defaults_[i].empty();
        std::string value;
        for (std::size_t k = 0; k < size; ++k, ++column) {
            standard = standard && point[column] == inside(defaults_[i][k], scalars_[column]);
            value += fmt::format("{}{}", k == 0 ? "" : ", ", static_cast<float>(point[column]));
        }
        if (standard) continue;
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", entry_.inputs[i].name,
                            size == 1 ? value : "(" + value + ")");
    }
    return text.empty() ? "everywhere" : text;
}

}  // namespace lobe::analyze
