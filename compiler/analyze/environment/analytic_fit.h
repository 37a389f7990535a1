// Scale and bias of an environment's reflectance as a formula short enough for any shader:
// Lazarov's shape, with constants for the visibility that is in use.
//
//   x     = x0 + x1 roughness
//   a     = min(x^2, 2^(-decay cos_o)) x
//   scale = scale_a a + scale_0 + scale_1 roughness
//   bias  = bias_a  a + bias_0  + bias_1  roughness
//
// The published constants ([Lazarov13], [Karis14]) add a line in roughness to a; it is in the lines
// of scale and bias here, which says the same with two constants less.
#pragma once

#include "analyze/environment/split_sum.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lobe::analyze {

struct AnalyticFit {
    double x0 = 1, x1 = -1;
    double decay = 9.28;
    double scale_a = -1.04, scale_0 = 0.9958, scale_1 = -0.5434;
    double bias_a = 1.04, bias_0 = 0.0042, bias_1 = -0.0066;
};

/// What engines ship.
inline constexpr AnalyticFit published_fit{};

ScaleAndBias value_of(const AnalyticFit& fit, double roughness, double cos_o);

/// Greatest absolute differences from the integrals, over the whole box. `reflected` is of
/// f0 scale + bias for the worst f0 in [0, 1]: it is worst at f0 = 0, the bias, or at 1.
struct FitError {
    double scale = 0;
    double bias = 0;
    double reflected = 0;
    double root_mean_square = 0;  ///< of the bias and of scale + bias together; cos_o and roughness
                                  ///< uniform
};

/// The integrals on a lattice that is denser where cos_o and roughness are small.
class SplitSumSurface {
public:
    SplitSumSurface(const Visibility& visibility, std::size_t across, std::size_t down,
                    unsigned jobs);

    FitError error_of(const AnalyticFit& fit) const;

    struct Sample {
        double roughness = 0;
        double cos_o = 0;
        double weight = 0;  ///< share of the box that it stands for; all add to 1
        ScaleAndBias exact;
    };
    const std::vector<Sample>& samples() const { return samples_; }

private:
    std::vector<Sample> samples_;
};

/// What is least of FitError: `root_mean_square`, or the greatest of the other three.
enum class FitGoal : std::uint8_t {
    mean,
    worst
};

/// The constants that reach a goal, rounded to four decimals. Deterministic. The lines are found by
/// least squares or by linear programs; x0, x1 and decay, which are not linear, by Nelder and
/// Mead's search around them. [Nelder65]
AnalyticFit fitted(const SplitSumSurface& surface, FitGoal goal);

/// As a body for a model file: lets, then a float2 of scale and bias.
std::string body_of(const AnalyticFit& fit);

}  // namespace lobe::analyze
