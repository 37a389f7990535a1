// What a conforming device may return, operation by operation: the rows of the precision table.
//
// In: sets of operands, whose ends are numbers of the format. Out: the set of results, with ends
// that are numbers of the format again, or infinite.
#pragma once

#include "evaluate/acceptance.h"
#include "evaluate/bounds.h"

#include <algorithm>
#include <array>

namespace lobe::evaluate {

constexpr Acceptance zero{0, 0, false};
constexpr Acceptance one{1, 1, false};
inline Interval bounds(const Acceptance& x) { return {x.low, x.high}; }
inline bool reaches_infinity(const Acceptance& x)
{
    return x.low == -infinity || x.high == infinity;
}
inline bool reaches(const Acceptance& x, double value) { return x.low <= value && value <= x.high; }

inline Acceptance hull(const Acceptance& a, const Acceptance& b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high), a.undefined || b.undefined};
}

/// One precision's arithmetic. Every member returns what a device may return for one operation.
class Device {
public:
    explicit Device(const Rules& rules) : rules_{rules} {}

    Acceptance flushed(Acceptance x) const;
    Acceptance admitted(const Acceptance& x) const { return rounded({x.low, x.high}, x.undefined); }
    Acceptance add(const Acceptance& a, const Acceptance& b) const;
    Acceptance subtract(const Acceptance& a, const Acceptance& b) const;
    Acceptance multiply(const Acceptance& a, const Acceptance& b) const;
    Acceptance square(const Acceptance& x) const;
    Acceptance divide(const Acceptance& a, const Acceptance& b) const;
    Acceptance inverse_square_root(const Acceptance& x) const;
    Acceptance square_root(const Acceptance& x) const;
    Acceptance exponential(const Acceptance& x, double (*function)(double)) const;
    Interval logarithm_reads(const Acceptance& x) const;
    Acceptance logarithm(const Acceptance& x, double (*function)(double)) const;
    Acceptance power(const Acceptance& x, const Acceptance& y) const;
    Acceptance wave(const Acceptance& x, Interval exact) const;
    Acceptance tangent(const Acceptance& x) const;
    Acceptance atan2(const Acceptance& y, const Acceptance& x) const;
    Acceptance arc_sine(const Acceptance& x) const;
    Acceptance arc_cosine(const Acceptance& x) const;
    Acceptance arc_tangent(const Acceptance& x) const;
    Acceptance normalized(const Acceptance& x, const Acceptance& squares) const;
    Acceptance lerp(const Acceptance& a, const Acceptance& b, const Acceptance& t) const;
    Acceptance smoothstep(const Acceptance& edge0, const Acceptance& edge1,
                          const Acceptance& x) const;
    Acceptance sum3(const Acceptance& a, const Acceptance& b, const Acceptance& c) const;
    Acceptance sum4(const std::array<Acceptance, 4>& terms) const;

private:
    double round_up(double x) const;
    double round_down(double x) const { return -round_up(-x); }
    double unit(double x) const;
    Acceptance rounded(Interval exact, bool undefined) const;
    Acceptance within(double low, double high, bool undefined) const;
    Acceptance within_units(Interval exact, double low_units, double high_units,
                            bool undefined) const;
    double epsilon() const { return rules_.epsilon; }
    /// A component is no longer than its vector, but for three roundings or two functions.
    double longest() const { return 1 + 8 * epsilon(); }

    const Rules& rules_;
};

}  // namespace lobe::evaluate
