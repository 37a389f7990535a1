#include "analyze/environment/analytic_fit.h"

#include "analyze/minimax/linear_program.h"
#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using Sample = SplitSumSurface::Sample;

/// The constants that are not linear: x0, x1, decay.
using Bend = std::array<double, 3>;

double bent(const Bend& bend, double roughness, double cos_o)
{
    const double x = bend[0] + bend[1] * roughness;
    return std::min(x * x, std::exp2(-bend[2] * cos_o)) * x;
}

/// Constants in the order of AnalyticFit, from scale_a on.
using Lines = std::array<double, 6>;

struct Solved {
    Lines lines{};
    double level = std::numeric_limits<double>::infinity();
};

std::array<double, 3> differences(const Lines& lines, double a, const Sample& at)
{
    const double scale = lines[0] * a + lines[1] + lines[2] * at.roughness - at.exact.scale;
    const double bias = lines[3] * a + lines[4] + lines[5] * at.roughness - at.exact.bias;
    return {scale, bias, scale + bias};
}

/// The best lines for given bends: a linear program over few samples, which the worst of all join
/// until none is worse than the program knows: Remez' exchange. The samples stay for the next bend.
class LineSearch {
public:
    explicit LineSearch(const std::vector<Sample>& samples) : samples_{samples}
    {
        for (std::size_t i = 0; i < samples.size(); i += samples.size() / 16 + 1)
            chosen_.push_back(i);
    }

    Solved solve(const Bend& bend)
    {
        constexpr int most_rounds = 40;
        constexpr double close = 1e-7;
        std::vector<double> a;
        for (const Sample& at : samples_) a.push_back(bent(bend, at.roughness, at.cos_o));
        for (int round = 0; round < most_rounds; ++round) {
            const auto found = program(a);
            if (!found) return {};
            Solved out;
            std::copy_n(found->begin(), out.lines.size(), out.lines.begin());
            const double known = found->back();
            // The worst sample of each kind.
            std::array<std::size_t, 3> worst{};
            std::array<double, 3> sizes{};
            for (std::size_t i = 0; i < samples_.size(); ++i) {
                const auto off = differences(out.lines, a[i], samples_[i]);
                for (std::size_t kind = 0; kind < off.size(); ++kind)
                    if (std::fabs(off[kind]) > sizes[kind]) {
                        sizes[kind] = std::fabs(off[kind]);
                        worst[kind] = i;
                    }
            }
            out.level = *std::ranges::max_element(sizes);
            if (out.level <= known + close) return out;
            for (std::size_t kind = 0; kind < worst.size(); ++kind)
                if (sizes[kind] > known + close &&
                    std::ranges::find(chosen_, worst[kind]) == chosen_.end())
                    chosen_.push_back(worst[kind]);
        }
        return {};
    }

private:
    std::optional<std::vector<double>> program(const std::vector<double>& a) const
    {
        constexpr double most = 10;
        LinearProgram program{{0, 0, 0, 0, 0, 0, 1},
                              {-most, -most, -most, -most, -most, -most, 0},
                              std::vector<double>(7, most)};
        for (const std::size_t i : chosen_) {
            const Sample& at = samples_[i];
            for (const auto& [scale, bias] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
                const double exact = scale * at.exact.scale + bias * at.exact.bias;
                for (const double sign : {1.0, -1.0}) {
                    const std::array row{sign * scale * a[i],
                                         sign * scale,
                                         sign * scale * at.roughness,
                                         sign * bias * a[i],
                                         sign * bias,
                                         sign * bias * at.roughness,
                                         -1.0};
                    program.require(row, sign * exact);
                }
            }
        }
        return program.solve();
    }

    const std::vector<Sample>& samples_;
    std::vector<std::size_t> chosen_;
};

struct Corner {
    Bend bend{};
    double level = 0;
};

Bend along(const Bend& from, const Bend& to, double t)
{
    Bend out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = from[i] + t * (to[i] - from[i]);
    return out;
}

/// [Nelder65], from a simplex around `start`.
Corner downhill(LineSearch& search, const Bend& start, double size)
{
    constexpr int most_steps = 200;
    constexpr double flat = 1e-7;
    const auto at = [&](const Bend& bend) { return Corner{bend, search.solve(bend).level}; };
    std::vector<Corner> simplex{at(start)};
    for (std::size_t i = 0; i < start.size(); ++i) {
        Bend bend = start;
        bend[i] *= 1 + size;
        simplex.push_back(at(bend));
    }
    const auto by_level = [](const Corner& a, const Corner& b) { return a.level < b.level; };
    for (int step = 0; step < most_steps; ++step) {
        std::ranges::stable_sort(simplex, by_level);
        if (simplex.back().level - simplex.front().level < flat) break;
        Bend middle{};
        for (std::size_t i = 0; i < start.size(); ++i) {
            for (std::size_t k = 0; k < start.size(); ++k) middle[i] += simplex[k].bend[i];
            middle[i] /= static_cast<double>(start.size());
        }
        Corner& worst = simplex.back();
        const Corner mirror = at(along(middle, worst.bend, -1));
        if (mirror.level < simplex.front().level) {
            const Corner further = at(along(middle, worst.bend, -2));
            worst = further.level < mirror.level ? further : mirror;
        } else if (mirror.level < simplex[start.size() - 1].level) {
            worst = mirror;
        } else {
            const Corner inside =
                at(along(middle, worst.bend, mirror.level < worst.level ? -0.5 : 0.5));
            if (inside.level < std::min(worst.level, mirror.level))
                worst = inside;
            else
                for (std::size_t i = 1; i < simplex.size(); ++i)
                    simplex[i] = at(along(simplex.front().bend, simplex[i].bend, 0.5));
        }
    }
    std::ranges::stable_sort(simplex, by_level);
    return simplex.front();
}

double rounded(double value, int digits)
{
    const double unit = std::pow(10, digits);
    return std::round(value * unit) / unit;
}

std::string signed_term(double value, std::string_view times)
{
    return fmt::format(" {} {}{}", value < 0 ? '-' : '+', std::fabs(value), times);
}

}  // namespace

ScaleAndBias value_of(const AnalyticFit& fit, double roughness, double cos_o)
{
    const double a = bent({fit.x0, fit.x1, fit.decay}, roughness, cos_o);
    return {fit.scale_a * a + fit.scale_0 + fit.scale_1 * roughness,
            fit.bias_a * a + fit.bias_0 + fit.bias_1 * roughness};
}

SplitSumSurface::SplitSumSurface(const Visibility& visibility, std::size_t across, std::size_t down,
                                 unsigned jobs)
{
    const auto share = [](std::size_t i, std::size_t count) {
        const double t = static_cast<double>(i) / static_cast<double>(count - 1);
        return t * t;
    };
    for (std::size_t row = 0; row < down; ++row)
        for (std::size_t column = 0; column < across; ++column)
            samples_.push_back(
                {std::lerp(1.0 / 64, 1.0, share(row, down)), share(column, across), {}});
    for_each_task(samples_.size(), jobs, [&](std::size_t i) {
        Sample& at = samples_[i];
        at.exact = split_sum(visibility, at.roughness, at.cos_o);
    });
}

FitError SplitSumSurface::error_of(const AnalyticFit& fit) const
{
    constexpr double usual_f0 = 0.04;
    FitError out;
    double squares = 0;
    for (const Sample& at : samples_) {
        const ScaleAndBias fitted = value_of(fit, at.roughness, at.cos_o);
        const double scale = fitted.scale - at.exact.scale;
        const double bias = fitted.bias - at.exact.bias;
        out.scale = std::max(out.scale, std::fabs(scale));
        out.bias = std::max(out.bias, std::fabs(bias));
        out.reflected = std::max({out.reflected, std::fabs(bias), std::fabs(scale + bias)});
        squares += (usual_f0 * scale + bias) * (usual_f0 * scale + bias);
    }
    out.root_mean_square = std::sqrt(squares / static_cast<double>(samples_.size()));
    return out;
}

AnalyticFit fitted(const SplitSumSurface& surface, int digits)
{
    LineSearch search{surface.samples()};
    Bend bend{published_fit.x0, published_fit.x1, published_fit.decay};
    // A simplex may collapse before it is done, so it is grown again around where it was.
    for (const double size : {0.3, 0.1, 0.03, 0.01}) bend = downhill(search, bend, size).bend;
    for (double& constant : bend) constant = rounded(constant, digits);
    const Lines lines = search.solve(bend).lines;
    const auto line = [&](std::size_t i) { return rounded(lines[i], digits); };
    return {bend[0], bend[1], bend[2], line(0), line(1), line(2), line(3), line(4), line(5)};
}

std::string body_of(const AnalyticFit& fit)
{
    return fmt::format("  let x = {}{}\n"
                       "  let a = min(x^2, 2^({} * cos_o)) * x\n"
                       "  float2({} * a{}{}, {} * a{}{})\n",
                       fit.x0, signed_term(fit.x1, " * roughness"), -fit.decay, fit.scale_a,
                       signed_term(fit.scale_0, ""), signed_term(fit.scale_1, " * roughness"),
                       fit.bias_a, signed_term(fit.bias_0, ""),
                       signed_term(fit.bias_1, " * roughness"));
}

}  // namespace lobe::analyze
