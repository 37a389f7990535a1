#include "check/witness.h"

#include "check/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace lobe::check {
namespace {

using Point = std::vector<double>;

/// Doubles round; a claim is broken only by more than that.
constexpr double rounding = 0x1p-40;

/// An input of the function: one number, or the components of a vector.
struct Coordinate {
    const ir::Input* input = nullptr;
    std::size_t first = 0;  ///< place of its first component in a point
    std::size_t count = 1;
    bool varied = true;
};

/// Where l and v are tried, above the horizon first: simple ones, so that a reader can picture
/// them, and some near the edges.
constexpr std::array<std::array<double, 3>, 16> directions{{
    {0, 0, 1},
    {1, 0, 0},
    {-1, 0, 0},
    {0, 1, 0},
    {0.6, 0, 0.8},
    {-0.6, 0, 0.8},
    {0.8, 0, 0.6},
    {-0.8, 0, 0.6},
    {0, 0.6, 0.8},
    {0, -0.8, 0.6},
    {0.28, 0, 0.96},
    {0.96, 0, 0.28},
    {-0.96, 0, 0.28},
    {0.8, 0, -0.6},
    {-0.6, 0, -0.8},
    {0, 0, -1},
}};

/// Numbers in [0, 1) that are the same on every platform.
class Random {
public:
    double unit() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
    std::size_t below(std::size_t count)
    {
        return static_cast<std::size_t>(unit() * static_cast<double>(count));
    }

private:
    std::mt19937_64 generator_{20230323};
};

class Hunt {
public:
    explicit Hunt(const Search& search) : search_(search), analysis_(search.flat)
    {
        std::size_t place = 0;
        for (const ir::Input& input : analysis_.function().inputs) {
            const auto count = static_cast<std::size_t>(ir::components(input.type));
            const bool varied = place < analysis_.inputs().size() && analysis_.depends_on(place);
            coordinates_.push_back({&input, place, count, varied});
            place += count;
        }
        size_ = place;
    }

    std::optional<Point> run()
    {
        for (const Point& point : corners())
            if (breaks(point)) return point;
        const bool closes = std::ranges::any_of(search_.claims, &Requirement::nonzero);
        std::optional<Point> positive;
        std::optional<Point> negative;
        for (int i = 0; i < samples; ++i) {
            const Point point = sample(i);
            if (breaks(point)) return point;
            if (!closes || !holds_facts(point)) continue;
            const double value = analysis_.values(point)[0][0];
            if (value > 0 && !positive) positive = point;
            if (value < 0 && !negative) negative = point;
            if (positive && negative)
                if (const auto found = close_in(*positive, *negative)) return found;
        }
        return std::nullopt;
    }

    Witness describe(const Point& point)
    {
        Witness witness;
        for (const Coordinate& coordinate : coordinates_) {
            if (!coordinate.varied && !is_frame(coordinate)) continue;
            std::string text;
            for (std::size_t i = 0; i < coordinate.count; ++i)
                text += (i > 0 ? ", " : "") + check::describe(point[coordinate.first + i], true);
            if (coordinate.count > 1) text = fmt::format("({})", text);
            if (coordinate.input->type == ir::Type::boolean)
                text = point[coordinate.first] != 0 ? "true" : "false";
            witness.point += fmt::format("{}{} = {}", witness.point.empty() ? "" : ", ",
                                         coordinate.input->name, text);
        }
        witness.values = analysis_.values(point)[0];
        return witness;
    }

private:
    static constexpr int samples = 6000;
    static constexpr std::size_t most_corners = 4096;

    static bool is_frame(const Coordinate& coordinate)
    {
        return coordinate.input->origin == ir::Origin::geometry && coordinate.count == 3 &&
               coordinate.input->which <= static_cast<std::uint32_t>(ir::GeometryField::y);
    }

    bool holds_facts(const Point& point)
    {
        const auto& values = analysis_.values(point);
        for (std::size_t i = 0; i < search_.facts.size(); ++i) {
            const double left = values[search_.claims.size() + 2 * i][0];
            const double right = values[search_.claims.size() + 2 * i + 1][0];
            const bool holds = [&] {
                switch (search_.facts[i]) {
                case Relation::less: return left < right;
                case Relation::less_equal: return left <= right;
                case Relation::equal: return left == right;
                case Relation::not_equal: return left != right;
                }
                return false;
            }();
            if (!holds) return false;
        }
        return true;
    }

    bool breaks(const Point& point)
    {
        if (!holds_facts(point)) return false;
        const auto& values = analysis_.values(point);
        for (std::size_t i = 0; i < search_.claims.size(); ++i) {
            const auto& value = values[i];
            if (std::ranges::any_of(value, [](double x) { return std::isnan(x); })) return false;
            if (satisfies(value, search_.claims[i], rounding)) return false;
            // A bound at 0 is missed by rounding as easily as any other.
            const Requirement& claim = search_.claims[i];
            if (!claim.nonzero && !claim.low_open && !claim.high_open &&
                std::ranges::all_of(value, [&](double x) {
                    return x >= claim.low - 1e-12 && x <= claim.high + 1e-12;
                }))
                return false;
        }
        return true;
    }

    /// Ends of every range; vectors from the list. As many combinations as there is room for.
    std::vector<Point> corners()
    {
        std::vector<Point> points{Point(size_, 0.0)};
        for (const Coordinate& coordinate : coordinates_) {
            const auto choices = choices_of(coordinate);
            std::vector<Point> next;
            const std::size_t room = std::max<std::size_t>(most_corners / points.size(), 1);
            for (const std::vector<double>& choice : choices) {
                if (next.size() >= points.size() * room) break;
                for (const Point& point : points) {
                    Point moved = point;
                    std::ranges::copy(choice, moved.begin() +
                                                  static_cast<std::ptrdiff_t>(coordinate.first));
                    next.push_back(std::move(moved));
                }
            }
            points = std::move(next);
        }
        return points;
    }

    std::vector<std::vector<double>> choices_of(const Coordinate& coordinate) const
    {
        std::vector<std::vector<double>> choices;
        const ir::Input& input = *coordinate.input;
        if (is_frame(coordinate)) {
            const auto field = static_cast<ir::GeometryField>(input.which);
            if (field == ir::GeometryField::n) return {{0, 0, 1}};
            if (field == ir::GeometryField::x) return {{1, 0, 0}};
            if (field == ir::GeometryField::y) return {{0, 1, 0}};
        }
        if (input.quantity == ir::Quantity::direction) {
            for (const auto& direction : directions)
                choices.emplace_back(direction.begin(), direction.end());
            return choices;
        }
        const auto add = [&](double value) {
            if (value >= input.range.low && value <= input.range.high && std::isfinite(value))
                choices.push_back(std::vector<double>(coordinate.count, value));
        };
        if (!coordinate.varied) {
            add(std::isfinite(input.range.low) ? input.range.low : 0);
            return choices.empty() ? std::vector<std::vector<double>>{{input.range.high}} : choices;
        }
        add(input.range.low);
        add(input.range.high);
        for (const double simple : {0.0, 1.0, -1.0, 0.5, 2.0, -2.0, 10.0, -10.0})
            if (simple != input.range.low && simple != input.range.high) add(simple);
        if (choices.empty()) add((input.range.low + input.range.high) / 2);
        return choices;
    }

    Point sample(int number)
    {
        Point point(size_, 0.0);
        for (const Coordinate& coordinate : coordinates_) {
            const auto choices = choices_of(coordinate);
            const bool fixed = choices.size() == 1 || !coordinate.varied;
            // Half of the coordinates are simple, so that a find is easy to read.
            if (fixed || random_.unit() < 0.5) {
                std::ranges::copy(choices[random_.below(choices.size())],
                                  point.begin() + static_cast<std::ptrdiff_t>(coordinate.first));
                continue;
            }
            if (coordinate.input->quantity == ir::Quantity::direction) {
                random_direction(point, coordinate, number);
                continue;
            }
            for (std::size_t i = 0; i < coordinate.count; ++i)
                point[coordinate.first + i] = random_value(*coordinate.input);
        }
        return point;
    }

    double random_value(const ir::Input& input)
    {
        if (input.quantity == ir::Quantity::boolean) return random_.unit() < 0.5 ? 0 : 1;
        const double value = random_number(input.range);
        return input.quantity == ir::Quantity::integer ? std::floor(value) : value;
    }

    double random_number(const ir::Range& range)
    {
        const double low = std::isfinite(range.low) ? range.low : std::min(-1e6, range.high - 1);
        const double high = std::isfinite(range.high) ? range.high : std::max(1e6, low + 1);
        // Hazards are often near an end: half the numbers fall towards one, by orders of magnitude.
        const double t = random_.unit();
        const double near = std::exp2(-20 * random_.unit());
        switch (random_.below(4)) {
        case 0: return low + (high - low) * near;
        case 1: return high - (high - low) * near;
        default: return low + (high - low) * t;
        }
    }

    void random_direction(Point& point, const Coordinate& coordinate, int number)
    {
        std::array<double, 3> direction{};
        double square = 0;
        do {
            square = 0;
            for (double& component : direction) {
                component = 2 * random_.unit() - 1;
                square += component * component;
            }
        } while (square > 1 || square < 0.01);
        // Mostly above the horizon.
        if (number % 8 != 0) direction[2] = std::abs(direction[2]);
        for (std::size_t i = 0; i < 3; ++i)
            point[coordinate.first + i] = direction[i] / std::sqrt(square);
    }

    Point between(const Point& a, const Point& b, double t) const
    {
        Point point(size_);
        for (std::size_t i = 0; i < size_; ++i) point[i] = a[i] + (b[i] - a[i]) * t;
        for (const Coordinate& coordinate : coordinates_) {
            if (coordinate.input->quantity != ir::Quantity::direction) continue;
            double square = 0;
            for (std::size_t i = 0; i < 3; ++i)
                square += point[coordinate.first + i] * point[coordinate.first + i];
            if (square == 0) continue;
            for (std::size_t i = 0; i < 3; ++i) point[coordinate.first + i] /= std::sqrt(square);
        }
        return point;
    }

    /// A value that changes its sign between two points is 0 between them, unless it jumps.
    std::optional<Point> close_in(const Point& positive, const Point& negative)
    {
        double above = 0;
        double below = 1;
        const double scale =
            std::abs(analysis_.values(positive)[0][0]) + std::abs(analysis_.values(negative)[0][0]);
        for (int i = 0; i < 80; ++i) {
            const double middle = above + (below - above) / 2;
            const Point point = between(positive, negative, middle);
            const double value = analysis_.values(point)[0][0];
            if (std::isnan(value)) return std::nullopt;
            if (value == 0 || i == 79) {
                const bool is_zero = std::abs(value) <= scale * 1e-12;
                if (is_zero && holds_facts(point)) return point;
                return std::nullopt;
            }
            (value > 0 ? above : below) = middle;
        }
        return std::nullopt;
    }

    const Search& search_;
    Analysis analysis_;
    std::vector<Coordinate> coordinates_;
    std::size_t size_ = 0;
    Random random_;
};

bool takes_geometry(const Flat& flat)
{
    return std::ranges::any_of(flat.function.inputs, [](const ir::Input& input) {
        return input.origin == ir::Origin::geometry;
    });
}

}  // namespace

std::optional<Witness> find_witness(const Search& search)
{
    if (takes_geometry(search.flat)) {
        Search real = search;
        real.flat = over_vectors(search.flat);
        Hunt hunt{real};
        if (const auto point = hunt.run()) return hunt.describe(*point);
    }
    Hunt hunt{search};
    const auto point = hunt.run();
    if (!point) return std::nullopt;
    Witness witness = hunt.describe(*point);
    witness.on_vectors = !takes_geometry(search.flat);
    return witness;
}

}  // namespace lobe::check
