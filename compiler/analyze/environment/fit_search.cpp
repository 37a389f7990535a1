// The search for constants of the analytic fit: lines for given bends, and bends downhill.
#include "analyze/environment/analytic_fit.h"
#include "analyze/minimax/linear_program.h"
#include "analyze/minimax/orthogonal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace lobe::analyze {
namespace {

using Sample = SplitSumSurface::Sample;

/// The constants that are not linear: x0, x1, decay.
using Bend = std::array<double, 3>;

/// The others, in the order of AnalyticFit.
using Lines = std::array<double, 6>;

struct Solved {
    Lines lines{};
    double level = std::numeric_limits<double>::infinity();
};

std::vector<double> bent(const Bend& bend, const std::vector<Sample>& samples)
{
    std::vector<double> out;
    for (const Sample& at : samples) {
        const double x = bend[0] + bend[1] * at.roughness;
        out.push_back(std::min(x * x, std::exp2(-bend[2] * at.cos_o)) * x);
    }
    return out;
}

/// Of scale, bias and their sum.
std::array<double, 3> differences(const Lines& lines, double a, const Sample& at)
{
    const double scale = lines[0] * a + lines[1] + lines[2] * at.roughness - at.exact.scale;
    const double bias = lines[3] * a + lines[4] + lines[5] * at.roughness - at.exact.bias;
    return {scale, bias, scale + bias};
}

/// Least squares: the bias and the sum are fitted apart, since they share no constant then.
Solved least_squares(const std::vector<Sample>& samples, const Bend& bend)
{
    const std::vector<double> a = bent(bend, samples);
    const auto count = static_cast<double>(samples.size());
    Columns columns(3);
    std::array<std::vector<double>, 2> wanted;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Sample& at = samples[i];
        const double root = std::sqrt(at.weight);
        columns[0].push_back(root * a[i]);
        columns[1].push_back(root);
        columns[2].push_back(root * at.roughness);
        wanted[0].push_back(root * at.exact.bias);
        wanted[1].push_back(root * (at.exact.scale + at.exact.bias));
    }
    const Triangle triangle = orthogonalize(columns);
    std::array<std::vector<double>, 2> constants;
    for (std::size_t which = 0; which < wanted.size(); ++which) {
        for (const std::vector<double>& column : columns) {
            double product = 0;
            for (std::size_t i = 0; i < samples.size(); ++i)
                product += column[i] * wanted[which][i];
            constants[which].push_back(product / count);
        }
        triangle.solve(constants[which]);
    }
    Solved out;
    for (std::size_t i = 0; i < 3; ++i) {
        out.lines[i] = constants[1][i] - constants[0][i];
        out.lines[i + 3] = constants[0][i];
    }
    double square = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto off = differences(out.lines, a[i], samples[i]);
        square += samples[i].weight * (off[1] * off[1] + off[2] * off[2]) / 2;
    }
    out.level = std::sqrt(square);
    return out;
}

/// Least greatest difference: a linear program over few samples, which the worst of all join until
/// none is worse than the program knows: Remez' exchange. The samples stay for the next bend.
class LeastWorst {
public:
    explicit LeastWorst(const std::vector<Sample>& samples) : samples_{samples}
    {
        for (std::size_t i = 0; i < samples.size(); i += samples.size() / 16 + 1)
            chosen_.push_back(i);
    }

    Solved operator()(const Bend& bend)
    {
        constexpr int most_rounds = 40;
        constexpr double close = 1e-7;
        const std::vector<double> a = bent(bend, samples_);
        for (int round = 0; round < most_rounds; ++round) {
            const auto found = program(a);
            if (!found) return {};
            Solved out;
            std::copy_n(found->begin(), out.lines.size(), out.lines.begin());
            const double known = found->back();
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
        std::vector<double> low(7, -most);
        low.back() = 0;
        LinearProgram program{{0, 0, 0, 0, 0, 0, 1}, low, std::vector<double>(7, most)};
        for (const std::size_t i : chosen_) {
            const Sample& at = samples_[i];
            for (const auto& [scale, bias] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
                const double exact = scale * at.exact.scale + bias * at.exact.bias;
                for (const int sign : {1, -1}) {
                    const double s = sign * scale;
                    const double b = sign * bias;
                    const std::array row{s * a[i],         s,   s * at.roughness, b * a[i], b,
                                         b * at.roughness, -1.0};
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
template <class Search>
Bend downhill(Search& search, const Bend& start, double size)
{
    constexpr int most_steps = 200;
    constexpr double flat = 1e-7;
    const auto at = [&](const Bend& bend) { return Corner{bend, search(bend).level}; };
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
    return simplex.front().bend;
}

/// Four decimals.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// The lines are found for bends that are rounded already.
template <class Search>
AnalyticFit searched(Search search)
{
    Bend bend{published_fit.x0, published_fit.x1, published_fit.decay};
    // A simplex may collapse before it is done, so it is grown again around where it was.
    for (const double size : {0.3, 0.1, 0.03, 0.01}) bend = downhill(search, bend, size);
    for (double& constant : bend) constant = rounded(constant);
    Lines lines = search(bend).lines;
    for (double& constant : lines) constant = rounded(constant);
    return {bend[0], bend[1], bend[2], lines[0], lines[1], lines[2], lines[3], lines[4], lines[5]};
}

}  // namespace

AnalyticFit fitted(const SplitSumSurface& surface, FitGoal goal)
{
    const std::vector<Sample>& samples = surface.samples();
    if (goal == FitGoal::worst) return searched(LeastWorst{samples});
    return searched([&samples](const Bend& bend) { return least_squares(samples, bend); });
}

}  // namespace lobe::analyze
