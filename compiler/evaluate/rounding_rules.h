// The rules of rounding.h, by kinds of operation. Internal to evaluate.
#pragma once

#include "evaluate/bounds.h"
#include "evaluate/intervals.h"
#include "evaluate/rounding.h"

#include <algorithm>
#include <cmath>

namespace lobe::evaluate {

constexpr Interval everything{-infinity, infinity};
constexpr Slope no_slope{everything, everything, everything, everything};

/// The greatest and the least distance from 0.
inline double size(Interval x) { return std::max(std::abs(x.low), std::abs(x.high)); }
inline double least_size(Interval x) { return x.low > 0 ? x.low : (x.high < 0 ? -x.high : 0); }
inline bool is_bounded(Interval x) { return x.low > -infinity && x.high < infinity; }
inline Interval around(double center, double radius)
{
    return {add_down(center, -radius), add_up(center, radius)};
}
/// An error bound made of a few double operations, outward.
inline double outward(double bound) { return bound * (1 + 0x1p-48); }
/// Zero times an infinite bound is zero.
inline double times(double a, double b) { return a == 0 || b == 0 ? 0 : outward(a * b); }

/// Everything the values of an operand may be on the way from exact to computed.
Interval between(const Rounded& x);

/// What one operation's own rounding adds to the exact result of its computed operands.
struct Own {
    double absolute = 0;
    double relative = 0;  ///< |error| <= relative |result| + underflow
    double underflow = 0;
    bool rounds = true;  ///< correctly: the computed value is a monotone function of the exact one
};

class Rules {
public:
    Rules(const Rounding& rounding, TapeOp op, std::span<const Rounded> operands)
        : rounding_{rounding}, op_{op}, in_{operands}
    {
    }
    Step step();

private:
    // rounding.cpp
    const Rounded& a() const { return in_[0]; }
    const Rounded& b() const { return in_[1]; }
    const Rounded& c() const { return in_[2]; }
    Interval of_exact() const;
    Interval of_computed() const;
    Own exactly() const { return {}; }
    Own correctly(Interval through, bool underflows) const;
    Own within(Interval through, double relative, double absolute, bool underflows) const;
    Step combine(Interval exact, Interval through, const Own& own, bool chooses = false);
    double fold(const Rounded& x);
    Step decision(Interval exact, Interval computed) const;

    // rounding_arithmetic.cpp
    Step sum(double sign);
    Step long_sum();
    Step multiply();
    Step divide();
    Step square();
    Step choose_extreme();
    Step select();
    Step lerp();
    Step hermite();

    // rounding_functions.cpp
    Step normalized();
    Step square_root();
    Step inverse_square_root();
    Step exponential(double scale);
    Step logarithm(double scale);
    Step power();
    Own powers(Interval exponent, Interval through) const;
    Own raised(Interval exponent, Interval through, double per_exponent, double fixed) const;
    Step wave();
    Step arc();

    const Rounding& rounding_;
    TapeOp op_;
    std::span<const Rounded> in_;
    std::array<Slope, 4> slopes_{no_slope, no_slope, no_slope, no_slope};
    std::array<bool, 4> folded_{};  ///< the operand's underflow is in `extra_relative_`
    double extra_relative_ = 0;
    double extra_jump_ = 0;
};

/// The error of rounding a number of this size or less.
double rounding_error(const Rounding& rounding, double size);
/// The interval of what numbers in `x` round to.
Interval rounded(const Rounding& rounding, Interval x);

}  // namespace lobe::evaluate
