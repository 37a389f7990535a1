#include "analyze/points.h"

#include "analyze/directions.h"
#include "analyze/grid.h"
#include "analyze/packing/borders.h"
#include "analyze/random.h"
#include "analyze/scalar.h"
#include "evaluate/tape.h"

#include <fmt/format.h>

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

std::string describe_inputs(const ir::Function& entry, const Points& points, std::size_t point)
{
    std::string text;
    std::size_t column = 0;
    for (const ir::Input& input : entry.inputs) {
        const auto size = static_cast<std::size_t>(ir::components(input.type));
        std::string value;
        for (std::size_t k = 0; k < size; ++k)
            value += fmt::format("{}{}", k == 0 ? "" : ", ", points.columns[column + k][point]);
        column += size;
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", input.name,
                            size == 1 ? value : "(" + value + ")");
    }
    return text;
}

std::vector<float> interleaved(const Points& points)
{
    const std::size_t columns = points.columns.size();
    std::vector<float> out(columns * points.size());
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t point = 0; point < points.size(); ++point)
            out[point * columns + i] = points.columns[i][point];
    return out;
}

Points points(const ir::Module& module, const ir::Function& entry, std::size_t count,
              Precision precision)
{
    const Grid& grid = grid_of(precision);
    Points out;
    const std::vector<Scalar> scalars = scalars_of(module, entry, grid);  // one per column
    std::vector<std::size_t> choices;  // the columns that `Values` speaks of
    bool has_directions = false;
    for (const ir::Input& input : entry.inputs)
        for (int k = 0; k < ir::components(input.type); ++k) {
            out.names.push_back(input.name +
                                evaluate::component_suffix(input.type, input.quantity, k));
            out.columns.emplace_back(count);
            if (input.origin == ir::Origin::geometry)
                has_directions = true;
            else if (input.quantity != ir::Quantity::direction)
                choices.push_back(out.names.size() - 1);
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
