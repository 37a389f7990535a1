#include "analyze/points.h"

#include "analyze/borders.h"
#include "analyze/directions.h"
#include "analyze/grid.h"
#include "analyze/random.h"
#include "evaluate/tape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

using evaluate::Precision;

constexpr std::size_t direction_cases = static_cast<std::size_t>(Directions::both_below) + 1;
/// Those that every function has.
constexpr std::size_t value_cases = static_cast<std::size_t>(Values::one_hostile) + 1;

// ---- values of one scalar

/// One scalar input, its ends on the grid.
struct Scalar {
    double low = 0;
    double high = 0;
    double neutral = 0;
    bool whole = false;  ///< holds integers only; booleans are 0 .. 1
    bool parameter = false;

    bool contains(double value) const { return low <= value && value <= high; }
    double nearest_to_zero() const { return std::clamp(0.0, low, high); }
};

double anywhere(Random& random, const Scalar& scalar)
{
    const double width = scalar.high - scalar.low;
    constexpr double wide = 0x1p24;
    double value = 0;
    if (width > wide) {
        value = random.magnitude(-24, 24) * (random.coin() ? -1 : 1);
        if (!scalar.contains(value)) value = -value;
        if (!scalar.contains(value)) value = random.between(scalar.low, scalar.high);
    } else if (random.coin()) {
        value = random.between(scalar.low, scalar.high);
    } else {
        const double offset = width * random.magnitude(-24, 0);
        value = random.coin() ? scalar.low + offset : scalar.high - offset;
    }
    return std::clamp(value, scalar.low, scalar.high);
}

double hostile(Random& random, const Scalar& scalar, Values values, const Grid& grid)
{
    switch (values) {
    case Values::anywhere:
    case Values::one_hostile:
    case Values::at_borders: return anywhere(random, scalar);
    case Values::at_ends: return random.coin() ? scalar.low : scalar.high;
    case Values::inside_ends:
        return random.coin() ? std::min(next_above(scalar.low, grid), scalar.high)
                             : std::max(next_below(scalar.high, grid), scalar.low);
    case Values::at_zero: return scalar.nearest_to_zero();
    case Values::denormal: {
        const std::array tiny{grid.least, grid.least_normal / 8, grid.least_normal - grid.least};
        const double value = tiny[random.below(3)];
        const bool negative = random.coin();
        if (scalar.contains(negative ? -value : value)) return negative ? -value : value;
        return scalar.contains(value) ? value : scalar.nearest_to_zero();
    }
    case Values::small: {
        const double offset = random.coin() ? 1e-4 : random.magnitude(-40, -13);
        const double base = scalar.contains(0) ? 0 : scalar.nearest_to_zero();
        const double value = scalar.contains(base + offset) ? base + offset : base - offset;
        return std::clamp(value, scalar.low, scalar.high);
    }
    case Values::neutral: return scalar.neutral;
    case Values::upper_ends: return scalar.parameter ? scalar.high : anywhere(random, scalar);
    }
    return scalar.low;
}

const Vector& vector_of(const Directional& point, ir::GeometryField field)
{
    switch (field) {
    case ir::GeometryField::l: return point.l;
    case ir::GeometryField::v: return point.v;
    case ir::GeometryField::x: return point.basis.x;
    case ir::GeometryField::y: return point.basis.y;
    default: return point.basis.z;  // an entry point has no other vector than n
    }
}

/// The Scalar of one component of an input. Ends are rounded inwards: a range is a promise that
/// points must keep.
Scalar scalar_of(const ir::Module& module, const ir::Input& input, int component, const Grid& grid)
{
    Scalar scalar;
    const double low = std::max(input.range.low, -grid.largest);
    const double high = std::min(input.range.high, grid.largest);
    scalar.low = to_grid(low, grid.precision);
    if (scalar.low < low) scalar.low = next_above(scalar.low, grid);
    scalar.high = to_grid(high, grid.precision);
    if (scalar.high > high) scalar.high = next_below(scalar.high, grid);
    // A range that holds no number of the grid: the nearest one must do.
    if (scalar.low > scalar.high) scalar.low = scalar.high = to_grid(low, grid.precision);
    scalar.whole =
        input.quantity == ir::Quantity::integer || input.quantity == ir::Quantity::boolean;
    if (input.quantity == ir::Quantity::boolean) scalar = {0, 1, 0, true, false};
    scalar.parameter = input.origin == ir::Origin::parameter;
    if (scalar.parameter)
        scalar.neutral = std::clamp(
            module.parameters[input.which].default_value[static_cast<std::size_t>(component)],
            scalar.low, scalar.high);
    else
        scalar.neutral = scalar.contains(1) ? 1 : scalar.nearest_to_zero();
    return scalar;
}

std::string_view text_of(Directions which)
{
    constexpr std::array<std::string_view, direction_cases> texts{"",
                                                                  "l = v",
                                                                  "l = -v",
                                                                  "l near -v",
                                                                  "h = n",
                                                                  "h near n",
                                                                  "l = n",
                                                                  "l = v = n",
                                                                  "l grazing",
                                                                  "v grazing",
                                                                  "l, v grazing",
                                                                  "l below the horizon",
                                                                  "v below the horizon",
                                                                  "l, v below the horizon"};
    return texts[static_cast<std::size_t>(which)];
}

std::string_view text_of(Values which)
{
    constexpr std::array<std::string_view, value_cases + 1> texts{
        "",
        "values at their ends",
        "values one float inside their ends",
        "values at 0",
        "denormal values",
        "small values",
        "neutral values",
        "parameters at their upper ends",
        "one hostile value",
        "values at the borders of codes"};
    return texts[static_cast<std::size_t>(which)];
}

}  // namespace

std::string describe(const Case& which)
{
    std::string text{text_of(which.directions)};
    const std::string_view values = text_of(which.values);
    if (!text.empty() && !values.empty()) text += "; ";
    text += values;
    return text.empty() ? "anywhere" : text;
}

Points points(const ir::Module& module, const ir::Function& entry, std::size_t count,
              Precision precision)
{
    const Grid& grid = grid_of(precision);
    Points out;
    std::vector<Scalar> scalars;       // one per column
    std::vector<std::size_t> choices;  // the columns that `Values` speaks of
    bool has_directions = false;
    for (const ir::Input& input : entry.inputs)
        for (int k = 0; k < ir::components(input.type); ++k) {
            out.names.push_back(input.name +
                                evaluate::component_suffix(input.type, input.quantity, k));
            out.columns.emplace_back(count);
            scalars.push_back(scalar_of(module, input, k, grid));
            if (input.origin == ir::Origin::geometry)
                has_directions = true;
            else if (input.quantity != ir::Quantity::direction)
                choices.push_back(scalars.size() - 1);
        }
    const bool has_values = !choices.empty();
    const Borders borders{module, entry};
    out.cases.resize(count);

    std::vector<double> values(scalars.size());
    for (std::size_t point = 0; point < count; ++point) {
        Random random{point};
        Case& which = out.cases[point];
        if (point % 4 == 3) {
            // The cases cycle, so that every pair of them comes up equally often. The pair of
            // two plain ones is left out: it would not be hostile.
            std::size_t turn = point / 4;
            if (has_directions && has_values) {
                turn = 1 + turn % (direction_cases * value_cases - 1);
                which.directions = static_cast<Directions>(turn % direction_cases);
                which.values = static_cast<Values>(turn / direction_cases);
            } else if (has_directions) {
                which.directions = static_cast<Directions>(1 + turn % (direction_cases - 1));
            } else if (has_values) {
                which.values = static_cast<Values>(1 + turn % (value_cases - 1));
            }
        }

        const std::size_t chosen =
            has_values ? choices[random.below(static_cast<std::uint32_t>(choices.size()))] : 0;
        const auto one = static_cast<Values>(1 + random.below(value_cases - 2));
        double alpha = random.magnitude(-12, 0);
        std::size_t column = 0;
        for (const ir::Input& input : entry.inputs) {
            const bool free_direction = input.quantity == ir::Quantity::direction;
            const Vector direction = free_direction && input.origin != ir::Origin::geometry
                                         ? on_sphere(random)
                                         : Vector{};
            for (int k = 0; k < ir::components(input.type); ++k, ++column) {
                const Scalar& scalar = scalars[column];
                if (free_direction) {
                    values[column] = k == 0 ? direction.x : k == 1 ? direction.y : direction.z;
                    continue;
                }
                const Values how = which.values != Values::one_hostile ? which.values
                                   : column == chosen                  ? one
                                                                       : Values::anywhere;
                double value = hostile(random, scalar, how, grid);
                if (scalar.whole) value = std::floor(value + 0.5);
                values[column] = std::clamp(value, scalar.low, scalar.high);
            }
            if (input.name == "roughness") alpha = values[column - 1] * values[column - 1];
            if (input.name == "alpha") alpha = values[column - 1];
        }

        if (has_directions) {
            const Directional at = directions(random, which.directions, alpha);
            column = 0;
            for (const ir::Input& input : entry.inputs) {
                if (input.origin == ir::Origin::geometry) {
                    const Vector& value =
                        vector_of(at, static_cast<ir::GeometryField>(input.which));
                    values[column] = value.x;
                    values[column + 1] = value.y;
                    values[column + 2] = value.z;
                }
                column += static_cast<std::size_t>(ir::components(input.type));
            }
        }
        if (!borders.empty() && point % 2 == 0) {
            which.values = Values::at_borders;
            borders.place(random, values);
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = std::clamp(values[i], scalars[i].low, scalars[i].high);
        }
        for (std::size_t i = 0; i < values.size(); ++i)
            out.columns[i][point] = to_grid(values[i], precision);
    }
    return out;
}

}  // namespace lobe::analyze
