// Where the worst errors are: points over the box, then steps uphill.
//
// Everything is a function of its arguments: random numbers come from keys, so that the same
// searches find the same points on any number of threads.
#pragma once

#include "analyze/packing/radiance_meter.h"
#include "analyze/points.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lobe::analyze {

/// Fills row `row` with point number `index` of the box. Even points are anywhere: directions
/// uniform above the horizon, values uniform in their ranges. Odd ones are where errors are:
/// grazing, mirror, retro and highlight directions, values at their ends and at borders of
/// `stored`, from both sides.
void place_point(const RadianceBox& box, const StoredAs& stored, std::uint64_t index,
                 RadianceMeter& meter, std::size_t row);

/// The same with values uniform in their ranges and directions as asked for.
void place_usual_point(const RadianceBox& box, Directions family, std::uint64_t index,
                       RadianceMeter& meter, std::size_t row);

struct Peak {
    double error = -1;
    std::vector<float> point;
};

/// From a point uphill: up to `rounds` times the best of 127 neighbors, near and far, and nearer
/// while there is nothing better. Directions stay unit and above the horizon, values in the box.
Peak climb(const RadianceBox& box, const StoredAs& stored, const std::vector<float>& start,
           int rounds, std::uint64_t key);

/// The errors of the points that a meter holds, however they are measured.
using Measure = std::function<const std::vector<double>&(RadianceMeter&)>;
Peak climb(const RadianceBox& box, const StoredAs& stored, const std::vector<float>& start,
           int rounds, std::uint64_t key, const Measure& measure);

struct Effort {
    std::size_t points = 0;
    std::size_t climbs = 0;
    int rounds = 0;  ///< of each climb; the best is climbed on twice as far
};

/// The worst that is found from points of the box and from `seeds`, points that were bad for other
/// codes: those are moved to borders of these first.
Peak search(const RadianceBox& box, const StoredAs& stored, const Effort& effort,
            std::span<const std::vector<float>> seeds);

}  // namespace lobe::analyze
