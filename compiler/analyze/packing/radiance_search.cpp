#include "analyze/packing/radiance_search.h"

#include "analyze/directions.h"
#include "analyze/random.h"
#include "evaluate/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::exp2_one;
using evaluate::log2_one;

constexpr float infinity = std::numeric_limits<float>::infinity();

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// The unit vector this way, or the nearest one that is high enough above the horizon.
Vector above_horizon(Vector d)
{
    const double length = std::sqrt(dot(d, d));
    const double z = std::clamp(std::abs(d.z) / length, double{least_cosine}, 1.0);
    const double side = std::sqrt(d.x * d.x + d.y * d.y);
    const double sine = std::sqrt((1 - z) * (1 + z));
    // Along the normal there is no side; any will do.
    if (!(side > 1e-300)) return {sine, 0, z};
    return {d.x / side * sine, d.y / side * sine, z};
}

void write(RadianceMeter& meter, std::size_t first, std::size_t row, const Vector& d)
{
    meter.column(first)[row] = double{static_cast<float>(d.x)};
    meter.column(first + 1)[row] = double{static_cast<float>(d.y)};
    meter.column(first + 2)[row] = double{static_cast<float>(d.z)};
}

Vector read(RadianceMeter& meter, std::size_t first, std::size_t row)
{
    return {meter.column(first)[row], meter.column(first + 1)[row], meter.column(first + 2)[row]};
}

float settled(const Coordinate& coordinate, double value)
{
    if (coordinate.whole) value = std::floor(value + 0.5);
    return std::clamp(static_cast<float>(value), coordinate.low, coordinate.high);
}

/// One side or the other of a border between two codes.
float at_border(Random& random, const Steps& steps, std::size_t which)
{
    const float border = steps.borders[which];
    return random.coin() ? border : std::nextafter(border, -infinity);
}

double hostile(Random& random, const Coordinate& coordinate, const Steps* steps)
{
    const double low = coordinate.low;
    const double high = coordinate.high;
    switch (random.below(8)) {
    case 0: return low;
    case 1: return high;
    case 2: return low + (high - low) * random.magnitude(-20, 0);
    case 3: return random.between(low, high);
    default:
        if (steps == nullptr || steps->borders.empty()) return random.between(low, high);
        return at_border(random, *steps,
                         random.below(static_cast<std::uint32_t>(steps->borders.size())));
    }
}

// ---- steps uphill

/// Moves l, v or both; `both` keeps a mirror pair mirrored or a retro pair together.
void move_directions(Random& random, const RadianceBox& box, RadianceMeter& meter, std::size_t row,
                     double reach)
{
    const std::uint32_t what = random.below(box.view ? 4 : 1);
    const Vector step = on_sphere(random);
    const double stretch = exp2_one(8 * reach * random.between(-1, 1));
    const bool lift = random.below(4) == 0;
    const auto moved = [&](const Vector& d, double side) {
        if (lift) return above_horizon({d.x, d.y, d.z * stretch});
        return above_horizon({d.x + side * reach * step.x, d.y + side * reach * step.y,
                              std::abs(d.z + reach * step.z)});
    };
    if (what != 1) write(meter, *box.light, row, moved(read(meter, *box.light, row), 1));
    if (what != 0 && box.view)
        write(meter, *box.view, row, moved(read(meter, *box.view, row), what == 3 ? -1 : 1));
}

float moved_value(Random& random, const Coordinate& coordinate, const Steps* steps, float value,
                  double reach)
{
    const double low = coordinate.low;
    const double high = coordinate.high;
    if (steps != nullptr && !steps->borders.empty() && random.below(8) < 5) {
        const auto last = static_cast<double>(steps->borders.size() - 1);
        const double jump = std::floor(exp2_one(random.unit() * log2_one(last * reach + 2)));
        const double from = static_cast<double>(steps->step_of(value)) - (random.coin() ? 1 : 0);
        const double to = std::clamp(from + (random.coin() ? jump - 1 : 1 - jump), 0.0, last);
        return settled(coordinate, at_border(random, *steps, static_cast<std::size_t>(to)));
    }
    switch (random.below(16)) {
    case 0: return coordinate.low;
    case 1: return coordinate.high;
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
        return settled(coordinate,
                       low + (value - low) * exp2_one(8 * reach * random.between(-1, 1)));
    default: return settled(coordinate, value + (high - low) * reach * random.between(-1, 1));
    }
}

}  // namespace

namespace {

void place_directions(Random& random, const RadianceBox& box, Directions family,
                      RadianceMeter& meter, std::size_t row)
{
    if (!box.light && !box.view) return;
    double alpha = random.magnitude(-12, 0);
    if (box.roughness)
        alpha = meter.column(*box.roughness)[row] * meter.column(*box.roughness)[row];
    else if (box.alpha)
        alpha = meter.column(*box.alpha)[row];
    const Directional at = directions(random, family, alpha);
    const auto local = [&at](const Vector& d) {
        return above_horizon({dot(d, at.basis.x), dot(d, at.basis.y), dot(d, at.basis.z)});
    };
    if (box.light) write(meter, *box.light, row, local(at.l));
    if (box.view) write(meter, *box.view, row, local(at.v));
}

/// The point where nothing has been chosen yet.
void place_fixed(const RadianceBox& box, RadianceMeter& meter, std::size_t row)
{
    for (std::size_t i = 0; i < box.width(); ++i) meter.column(i)[row] = box.coordinates[i].low;
}

void place_uniform_values(Random& random, const RadianceBox& box, RadianceMeter& meter,
                          std::size_t row)
{
    for (const std::size_t i : box.values) {
        const Coordinate& coordinate = box.coordinates[i];
        meter.column(i)[row] = settled(coordinate, random.between(coordinate.low, coordinate.high));
    }
}

}  // namespace

void place_usual_point(const RadianceBox& box, Directions family, std::uint64_t index,
                       RadianceMeter& meter, std::size_t row)
{
    Random random{index};
    place_fixed(box, meter, row);
    place_uniform_values(random, box, meter, row);
    place_directions(random, box, family, meter, row);
}

void place_point(const RadianceBox& box, const StoredAs& stored, std::uint64_t index,
                 RadianceMeter& meter, std::size_t row)
{
    if (index % 2 == 0) {
        place_usual_point(box, Directions::anywhere, index, meter, row);
        return;
    }
    Random random{index};
    place_fixed(box, meter, row);
    for (const std::size_t i : box.values) {
        const Coordinate& coordinate = box.coordinates[i];
        meter.column(i)[row] = settled(coordinate, hostile(random, coordinate, stored[i]));
    }
    constexpr std::array families{Directions::anywhere,       Directions::both_grazing,
                                  Directions::equal,          Directions::both_grazing,
                                  Directions::half_is_normal, Directions::near_peak,
                                  Directions::light_grazing,  Directions::view_grazing,
                                  Directions::along_normal,   Directions::nearly_opposed};
    place_directions(random, box, families[index / 2 % families.size()], meter, row);
}

Peak climb(const RadianceBox& box, const StoredAs& stored, const std::vector<float>& start,
           int rounds, std::uint64_t key)
{
    const Measure measure = [&stored](RadianceMeter& meter) -> const std::vector<double>& {
        meter.light();
        return meter.compare(stored);
    };
    return climb(box, stored, start, rounds, key, measure);
}

Peak climb(const RadianceBox& box, const StoredAs& stored, const std::vector<float>& start,
           int rounds, std::uint64_t key, const Measure& measure)
{
    constexpr std::size_t rows = 128;  // one block of the tape
    constexpr std::uint32_t coarsest = 4, finest = 24;
    constexpr double progress = 1 + 0x1p-10;
    RadianceMeter meter{box, rows};
    Random random{key};
    Peak peak{-1, start};
    // Steps reach 2^-scale of the box at least. They become finer while nothing better is found.
    std::uint32_t scale = coarsest;
    for (int round = 0; round < rounds && scale <= finest; ++round) {
        meter.set_all(peak.point);
        for (std::size_t row = 1; row < rows; ++row)
            for (bool more = true; more; more = random.below(8) < 3) {
                const auto halvings = static_cast<int>(random.below(scale));
                const double reach = std::ldexp(0.5 + 0.5 * random.unit(), -halvings);
                if (box.light && (box.values.empty() || random.below(3) == 0)) {
                    move_directions(random, box, meter, row, reach);
                } else if (!box.values.empty()) {
                    const std::size_t i =
                        box.values[random.below(static_cast<std::uint32_t>(box.values.size()))];
                    double& value = meter.column(i)[row];
                    value = moved_value(random, box.coordinates[i], stored[i],
                                        static_cast<float>(value), reach);
                }
            }
        const std::vector<double>& errors = measure(meter);
        const auto best = std::ranges::max_element(errors);
        if (*best > peak.error * progress)
            scale = std::max(coarsest, scale - 1);
        else
            ++scale;
        if (*best > peak.error)
            peak = {*best, meter.point(static_cast<std::size_t>(best - errors.begin()))};
    }
    return peak;
}

namespace {

void keep_worst(std::vector<Peak>& peaks, std::size_t count)
{
    std::ranges::stable_sort(peaks, [](const Peak& a, const Peak& b) { return a.error > b.error; });
    if (peaks.size() > count) peaks.resize(count);
}

Peak worst_row(RadianceMeter& meter, const StoredAs& stored)
{
    meter.light();
    const std::vector<double>& errors = meter.compare(stored);
    const auto worst = std::ranges::max_element(errors);
    return {*worst, meter.point(static_cast<std::size_t>(worst - errors.begin()))};
}

/// The worst of a point with one stored coordinate moved to borders: all, or of many, some of them
/// and those around.
Peak swept(const RadianceBox& box, const StoredAs& stored, const Peak& from, std::size_t index)
{
    constexpr std::size_t most = 63;
    const Steps& steps = *stored[index];
    const std::size_t borders = steps.borders.size();
    const std::size_t tried = std::min(borders, most);
    const std::size_t here = steps.step_of(from.point[index]);
    const std::size_t begin = std::min(here - std::min(here, most / 4), borders - tried);
    RadianceMeter meter{box, 2 * tried + 1};
    meter.set_all(from.point);
    for (std::size_t i = 0; i < tried; ++i) {
        const std::size_t which = i % 2 == 0 ? i * borders / tried : begin + i / 2;
        const float border = steps.borders[which];
        const Coordinate& coordinate = box.coordinates[index];
        meter.column(index)[2 * i + 1] = settled(coordinate, border);
        meter.column(index)[2 * i + 2] = settled(coordinate, std::nextafter(border, -infinity));
    }
    return worst_row(meter, stored);
}

/// A point that was bad for other codes, made as bad as can be for these: one stored coordinate
/// after the other goes to its worst border.
Peak at_its_worst(const RadianceBox& box, const StoredAs& stored, const std::vector<float>& seed)
{
    RadianceMeter meter{box, 1};
    meter.set_all(seed);
    Peak peak = worst_row(meter, stored);
    for (std::size_t i = 0; i < stored.size(); ++i)
        if (stored[i] != nullptr && !stored[i]->borders.empty()) peak = swept(box, stored, peak, i);
    return peak;
}

}  // namespace

Peak search(const RadianceBox& box, const StoredAs& stored, const Effort& effort,
            std::span<const std::vector<float>> seeds)
{
    std::vector<Peak> peaks;
    if (effort.points > 0) {
        RadianceMeter meter{box, std::max<std::size_t>(1, effort.points / effort.climbs)};
        for (std::size_t i = 0; i < effort.climbs; ++i) {
            for (std::size_t row = 0; row < meter.rows(); ++row)
                place_point(box, stored, i * meter.rows() + row, meter, row);
            peaks.push_back(worst_row(meter, stored));
        }
    }
    for (const std::vector<float>& seed : seeds) peaks.push_back(at_its_worst(box, stored, seed));
    keep_worst(peaks, effort.climbs);
    for (std::size_t i = 0; i < peaks.size(); ++i) {
        const Peak found = climb(box, stored, peaks[i].point, effort.rounds, i);
        if (found.error > peaks[i].error) peaks[i] = found;
    }
    keep_worst(peaks, 1);
    const Peak found = climb(box, stored, peaks.front().point, 2 * effort.rounds, effort.climbs);
    return found.error > peaks.front().error ? found : peaks.front();
}

}  // namespace lobe::analyze
