// Limits along one line, with MPFR.
//
// For a difference D(d) of two sides, Aitken's extrapolation of three of its values at distances of
// constant ratio is exact for J + C r^k: it finds J where there is a jump and 0 for every power of
// the distance. What is left of the last value tells the two cases apart: all of it, or nothing.
#include "analyze/corners/continuity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::Real;

constexpr int bits = 256;    // distances of 2^-96, and as much again for their squares
constexpr int nearest = 96;  // beyond 2^-64, which `else` counts as 0
constexpr int farthest = 2;

/// Three distances that are extrapolated: 2^-last, and that many halvings before it, twice. A ramp
/// that a guard puts in place of a jump (a length below 2^-64 counts as that) is seen from afar as
/// the jump that it stands for, and from nearest as what it is.
struct Window {
    int last = 0;
    int steps = 0;
};
constexpr std::array windows{Window{nearest, 12}, Window{56, 8}};

/// Below this part of the scale a difference is rounding: 2^-256, with much to spare.
constexpr double rounding = 0x1p-200;

class Line {
public:
    Line(const evaluate::Tape& tape, const Crossing& crossing) : tape_(tape), crossing_(crossing)
    {
        inputs_.assign(crossing.at.size(), Real{bits});
    }

    /// The results at a signed distance.
    std::vector<Real> operator()(double distance)
    {
        std::vector<const Real*> heads;
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            mpfr_set_d(inputs_[i].get(), crossing_.direction[i], MPFR_RNDN);
            mpfr_mul_d(inputs_[i].get(), inputs_[i].get(), distance, MPFR_RNDN);
            mpfr_add_d(inputs_[i].get(), inputs_[i].get(), crossing_.at[i], MPFR_RNDN);
            heads.push_back(&inputs_[i]);
        }
        std::vector<Real> results(tape_.outputs.size(), Real{bits});
        std::vector<Real*> outputs;
        for (Real& result : results) outputs.push_back(&result);
        evaluate::run_real(tape_, bits, heads, outputs, 1);
        for (const Real& result : results)
            if (const double size = std::abs(result.to_double()); std::isfinite(size))
                scale_ = std::max(scale_, size);
        return results;
    }

    double scale() const { return scale_; }

private:
    const evaluate::Tape& tape_;
    const Crossing& crossing_;
    std::vector<Real> inputs_;
    double scale_ = 0;
};

/// The greatest difference of a component. What is no number differs without bound.
double difference(const std::vector<Real>& a, const std::vector<Real>& b)
{
    double greatest = 0;
    Real gap{bits};
    for (std::size_t i = 0; i < a.size(); ++i) {
        mpfr_sub(gap.get(), a[i].get(), b[i].get(), MPFR_RNDN);
        const double size = std::abs(gap.to_double());
        greatest =
            std::isnan(size) ? std::numeric_limits<double>::infinity() : std::max(greatest, size);
    }
    return greatest;
}

/// The limit of a sequence of differences at distances of constant ratio: 0 where it falls.
double limit_of(double first, double second, double third, double scale)
{
    if (!std::isfinite(third)) return third;
    if (third <= scale * rounding) return 0;
    if (third > second && second > first) return third;  // it grows, whatever the limit is
    const double bend = (third - second) - (second - first);
    if (bend == 0) return third;
    const double limit = third - (third - second) * (third - second) / bend;
    return std::abs(limit) > third / 2 ? std::abs(limit) : 0;
}

/// How two ways to the boundary differ in the limit. Distance 0 is the boundary itself.
double jump_between(Line& line, const Window& window, double one, double other)
{
    std::array<double, 3> differences{};
    for (int i = 0; i < 3; ++i) {
        const double distance = std::ldexp(1.0, -(window.last - (2 - i) * window.steps));
        differences[static_cast<std::size_t>(i)] =
            difference(line(one * distance), line(other * distance));
    }
    return limit_of(differences[0], differences[1], differences[2], line.scale());
}

struct Switch {
    double jump = 0;
    double distance = 0;
};

/// Where the result jumps on the way, if it does: between the two distances with the greatest of
/// those changes that do not fall from one halving to the next.
Switch find_switch(Line& line, double side)
{
    std::vector<Real> far = line(std::ldexp(side, -farthest));
    double before = std::numeric_limits<double>::infinity();
    double greatest = 0;
    int at = 0;
    for (int k = farthest; k < nearest; ++k) {
        std::vector<Real> near = line(std::ldexp(side, -k - 1));
        const double change = difference(far, near);
        if (change >= before && change > greatest) {
            greatest = change;
            at = k;
        }
        before = change;
        far = std::move(near);
    }
    if (greatest <= line.scale() * rounding || !std::isfinite(greatest)) return {};

    // Halved until the doubles are neighbors. A continuous change falls with the width.
    double high = std::ldexp(1.0, -at);
    double low = high / 2;
    std::vector<Real> at_high = line(side * high), at_low = line(side * low);
    double halfway = 0;
    double change = greatest;
    for (int i = 0; i < 52; ++i) {
        const double middle = low + (high - low) / 2;
        if (middle == low || middle == high) break;
        std::vector<Real> at_middle = line(side * middle);
        const double above = difference(at_high, at_middle);
        const double below = difference(at_middle, at_low);
        if (above >= below) {
            low = middle;
            at_low = std::move(at_middle);
        } else {
            high = middle;
            at_high = std::move(at_middle);
        }
        change = std::max(above, below);
        if (i == 25) halfway = change;
    }
    if (change <= halfway / 2 || change <= line.scale() * rounding) return {};
    return {change, side * high};
}

}  // namespace

Limits limits(const evaluate::Tape& tape, const Crossing& crossing)
{
    Line line{tape, crossing};
    Limits out;
    const auto take = [&](double jump, double distance, double within) {
        // What is seen from nearby needs more to outdo it than the roundings of an extrapolation.
        if (jump > out.jump * (1 + 0x1p-20)) out = {jump, out.scale, distance, within};
    };
    for (const Window& window : windows) {
        const double within = window.last == nearest ? 0 : std::ldexp(1.0, -window.last);
        if (crossing.after) take(jump_between(line, window, 1, 0), 0, within);
        if (crossing.before) take(jump_between(line, window, -1, 0), 0, within);
        if (crossing.after && crossing.before) take(jump_between(line, window, 1, -1), 0, within);
    }
    for (const double side : {1.0, -1.0})
        if (side > 0 ? crossing.after : crossing.before) {
            const Switch found = find_switch(line, side);
            take(found.jump, found.distance, 0);
        }
    out.scale = line.scale();
    return out;
}

}  // namespace lobe::analyze
