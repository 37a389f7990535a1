// How far results are from what they should be, in the units people judge by.
//
// Relative where it is bright, absolute where it is dark: the difference over the exact value or,
// if that is smaller, over a floor. For radiance the floor is an 18 % grey card lit alike (0.18 /
// pi n.l, see radiance.h); for a term it is 0.18. And in 8-bit codes as a display shows it: clamped
// to [0, 1], encoded by the sRGB curve (IEC 61966-2-1), times 255; not rounded.
//
// The greatest error is of all points, wherever errors are: grazing directions, the ends of ranges,
// borders where the exact value itself jumps. What is usual is said over points that a picture has:
// values uniform in their ranges, and directions uniform above the horizon for half of them, around
// the highlight (h within alpha of n) for the other half.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lobe::analyze {

/// What an 18 % grey card reflects.
inline constexpr double grey_albedo = 0.18;

struct Deviation {
    double scaled = 0;            ///< greatest; 0.02 is 2 %
    double often = 0;             ///< 99 of 100 usual points have less of the same
    double typical = 0;           ///< median of the same
    double absolute = 0;          ///< greatest
    double root_mean_square = 0;  ///< of the absolute difference
    double codes = 0;             ///< greatest difference on a display, in 8-bit codes
    std::size_t points = 0;
    std::size_t not_finite =
        0;           ///< points where the result is NaN or infinite and the exact is not
    std::string at;  ///< inputs of the greatest scaled one: `roughness = 0.5, l = (0, 0, 1)`
};

/// 0 .. 255 for a linear value.
double display_code(double linear);
/// The linear value in [0, 1] with this code.
double linear_of_code(double code);

}  // namespace lobe::analyze
