#include "analyze/environment/prefilter.h"

#include "analyze/environment/sampling.h"
#include "analyze/tasks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lobe::analyze {
namespace {

/// A direction around the normal, which is z; its weight; the level of the source it looks up.
struct PrefilterSample {
    Vector l;
    double weight = 0;
    double level = 0;
};

/// The level of the source whose texels are `steradians` large on average.
double level_with(const CubeMap& source, double steradians)
{
    const double edge = source.levels.front().size;
    const double texel = 4 * std::numbers::pi / (6 * edge * edge);
    return std::max(0.5 * std::log2(steradians / texel), 0.0);
}

std::vector<PrefilterSample> samples_of(const CubeMap& source, double alpha,
                                        const PrefilterOptions& options)
{
    std::vector<PrefilterSample> out;
    double whole = 0;
    for (std::uint32_t i = 0; i < options.samples; ++i) {
        const Vector h = importance_sample_ggx(hammersley(i, options.samples), alpha);
        const Vector l = mirrored({0, 0, 1}, h);
        if (l.z <= 0) continue;
        // The density of l, D n.h / (4 v.h), where v is n.
        const double density = density_ggx(h.z, alpha) / 4;
        const double stands_for = 1 / (options.samples * density);
        out.push_back({l, l.z, options.blurs_samples ? level_with(source, stands_for) : 0});
        whole += l.z;
    }
    for (PrefilterSample& sample : out) sample.weight /= whole;
    return out;
}

/// Any frame around a direction.
Basis around(const Vector& n)
{
    // [Duff17] listing 3
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace

CubeMap prefiltered(const CubeMap& source, const PrefilterOptions& options)
{
    CubeMap out;
    for (int i = 0; i < options.levels; ++i) {
        CubeLevel level{std::max(options.size >> i, 1)};
        const double roughness = options.levels == 1 ? 0 : double(i) / (options.levels - 1);
        // A mirror looks up what a texel of its own covers.
        const double own = 4 * std::numbers::pi / (6.0 * level.size * level.size);
        const std::vector<PrefilterSample> samples =
            i == 0 ? std::vector<PrefilterSample>{{{0, 0, 1}, 1, level_with(source, own)}}
                   : samples_of(source, roughness * roughness, options);
        for_each_task(
            static_cast<std::size_t>(6 * level.size), options.jobs, [&](std::size_t task) {
                const int face = static_cast<int>(task) / level.size;
                const int row = static_cast<int>(task) % level.size;
                for (int column = 0; column < level.size; ++column) {
                    const Basis basis = around(texel_direction(level, face, row, column));
                    Radiance sum{};
                    for (const PrefilterSample& sample : samples) {
                        const Radiance value = look_up(
                            source, basis(sample.l.x, sample.l.y, sample.l.z), sample.level);
                        for (std::size_t channel = 0; channel < sum.size(); ++channel)
                            sum[channel] += sample.weight * value[channel];
                    }
                    level.set(face, row, column, sum);
                }
            });
        out.levels.push_back(std::move(level));
    }
    return out;
}

double level_of(double roughness, const CubeMap& prefiltered)
{
    return roughness * static_cast<double>(prefiltered.levels.size() - 1);
}

}  // namespace lobe::analyze
