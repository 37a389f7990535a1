#include "analyze/environment/analytic_fit.h"

#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

std::string added(double value, std::string_view times)
{
    return fmt::format(" {} {}{}", value < 0 ? '-' : '+', std::fabs(value), times);
}

}  // namespace

ScaleAndBias value_of(const AnalyticFit& fit, double roughness, double cos_o)
{
    const double x = fit.x0 + fit.x1 * roughness;
    const double a = std::min(x * x, std::exp2(-fit.decay * cos_o)) * x;
    return {fit.scale_a * a + fit.scale_0 + fit.scale_1 * roughness,
            fit.bias_a * a + fit.bias_0 + fit.bias_1 * roughness};
}

SplitSumSurface::SplitSumSurface(const Visibility& visibility, std::size_t across, std::size_t down,
                                 unsigned jobs)
{
    // Places are squares of even steps, so what they stand for grows along each axis.
    const auto step = [](std::size_t i, std::size_t count) {
        return static_cast<double>(i) / static_cast<double>(count - 1);
    };
    double whole = 0;
    for (std::size_t row = 0; row < down; ++row)
        for (std::size_t column = 0; column < across; ++column) {
            const double y = step(row, down);
            const double x = step(column, across);
            samples_.push_back({std::lerp(1.0 / 64, 1.0, y * y), x * x, x * y, {}});
            whole += x * y;
        }
    for (Sample& at : samples_) at.weight /= whole;
    for_each_task(samples_.size(), jobs, [&](std::size_t i) {
        Sample& at = samples_[i];
        at.exact = split_sum(visibility, at.roughness, at.cos_o);
    });
}

FitError SplitSumSurface::error_of(const AnalyticFit& fit) const
{
    FitError out;
    double square = 0;
    for (const Sample& at : samples_) {
        const ScaleAndBias fitted = value_of(fit, at.roughness, at.cos_o);
        const double scale = fitted.scale - at.exact.scale;
        const double bias = fitted.bias - at.exact.bias;
        out.scale = std::max(out.scale, std::fabs(scale));
        out.bias = std::max(out.bias, std::fabs(bias));
        out.reflected = std::max({out.reflected, std::fabs(bias), std::fabs(scale + bias)});
        square += at.weight * (bias * bias + (scale + bias) * (scale + bias)) / 2;
    }
    out.root_mean_square = std::sqrt(square);
    return out;
}

std::string body_of(const AnalyticFit& fit)
{
    return fmt::format("  let x = {}{}\n"
                       "  let a = min(x^2, 2^({} * cos_o)) * x\n"
                       "  float2({} * a{}{}, {} * a{}{})\n",
                       fit.x0, added(fit.x1, " * roughness"), -fit.decay, fit.scale_a,
                       added(fit.scale_0, ""), added(fit.scale_1, " * roughness"), fit.bias_a,
                       added(fit.bias_0, ""), added(fit.bias_1, " * roughness"));
}

}  // namespace lobe::analyze
