// Where functions are tested: float32 points over the declared inputs, a quarter of them hostile.
//
// A pure function of the inputs' declarations: the same points on every machine and compiler.
// Hostile points are where shaders have broken: ends of ranges and their neighbors, zero and
// denormals, coinciding and opposing directions, grazing angles, the very peak of a highlight.
#pragma once

#include "evaluate/run.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

/// How the directions of a point were chosen.
enum class Directions : std::uint8_t {
    anywhere,          ///< uniform, seven of eight above the horizon
    equal,             ///< l = v
    opposed,           ///< l = -v
    nearly_opposed,    ///< up to 1 rad away from l = -v, by orders of magnitude
    half_is_normal,    ///< v mirrors l: h = n, exactly where n is an axis
    near_peak,         ///< h within alpha of n
    along_normal,      ///< l = n, v anywhere
    all_along_normal,  ///< l = v = n
    light_grazing,     ///< n.l = 0, 1e-4, or the least floats above 0
    view_grazing,
    both_grazing,
    light_below,
    view_below,
    both_below,
};

/// How the other inputs of a point were chosen.
enum class Values : std::uint8_t {
    anywhere,     ///< half uniform in the range, half crowding towards its ends
    at_ends,      ///< each at one of its ends
    inside_ends,  ///< each one float inside an end
    at_zero,      ///< each 0 where its range allows it, else at the end nearest to 0
    denormal,     ///< each subnormal where its range allows it
    small,        ///< each 1e-4 and less above its lower end
    neutral,      ///< parameters at their defaults, arguments 1 or 0
    upper_ends,   ///< parameters at their upper ends: a falloff of 1 is an exponent of 0
    one_hostile,  ///< one of the above for one input, the others anywhere
    at_borders,  ///< close to the border of two codes: half of the points of what packs and unpacks
};

struct Case {
    Directions directions = Directions::anywhere;
    Values values = Values::anywhere;

    bool hostile() const
    {
        return directions != Directions::anywhere || values != Values::anywhere;
    }
};

/// `l = -v; values at their ends`, as reports say it; `anywhere` for a plain point.
std::string describe(const Case& which);

struct Points {
    std::vector<std::string> names;           ///< of the columns: `l.x`, `roughness`, `f0.r`
    std::vector<std::vector<float>> columns;  ///< one per scalar of the inputs, in their order
    std::vector<Case> cases;                  ///< one per point

    std::size_t size() const { return cases.size(); }
};

/// The inputs of a point as people read them: `roughness = 0.5, l = (0, 0, 1)`; digits enough to
/// read back exactly. `entry` is what the points are of.
std::string describe_inputs(const ir::Function& entry, const Points& points, std::size_t point);

/// As a harness reads them: the scalars of point 0, of point 1, …
std::vector<float> interleaved(const Points& points);

/// `count` points for a function over vectors (see ir::entry_point); every fourth is hostile. Where
/// values become codes, every second one is close to the border of two codes.
/// Values lie within the declared ranges, whose ends are rounded inwards to the grid of the
/// precision. Directions are unit vectors rounded to that grid. An unbounded range takes every
/// order of magnitude from 2^-24 to 2^24, and the largest finite values as its ends.
Points points(const ir::Module& module, const ir::Function& entry, std::size_t count,
              evaluate::Precision precision = evaluate::Precision::float32);

}  // namespace lobe::analyze
