#include "analyze/residual/reach.h"

#include "optimize/decimal.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace lobe::analyze {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

bool is_float(double value) { return static_cast<double>(static_cast<float>(value)) == value; }

/// A float below (or above) what a shader makes of an end. Factor, product and sum are rounded to
/// float and `end` is too, each by at most half a unit in the last place: two units, which are
/// four where a power of 2 lies between.
double outward(double end, float toward)
{
    float moved = static_cast<float>(end);
    for (int unit = 0; unit < 4; ++unit) moved = std::nextafter(moved, toward);
    return static_cast<double>(moved);
}

struct Component {
    ir::Range exact;
    bool is_exact = true;  ///< the ends are floats that a float multiplication gives exactly
};

Component component_of(const ir::Range& factor, const ir::Range& texel, double offset)
{
    Component out;
    out.exact = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const double f : {factor.low, factor.high})
        for (const double t : {texel.low, texel.high}) {
            const double end = f * t + offset;
            out.exact.low = std::min(out.exact.low, end);
            out.exact.high = std::max(out.exact.high, end);
            out.is_exact = out.is_exact && is_float(f) && is_float(t) && is_float(end);
        }
    return out;
}

}  // namespace

ir::Range rounded_by_hosts(const ir::Range& range)
{
    return {is_float(range.low) ? range.low : outward(range.low, -infinity),
            is_float(range.high) ? range.high : outward(range.high, infinity)};
}

ir::Range in_digits(const ir::Range& range) { return optimize::in_digits(range); }

ir::Range hull(const ir::Range& a, const ir::Range& b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

ir::Range product_in_floats(const ir::Range& a, const ir::Range& b)
{
    const ir::Range exact = component_of(a, b, 0).exact;
    if (exact.low == exact.high) return exact;
    return {outward(exact.low, -infinity), outward(exact.high, infinity)};
}

Reach reach(const scene::Scene& scene, const scene::Value& value)
{
    Reach out;
    out.is_binary = true;
    for (std::size_t k = 0; k < value.low.size(); ++k) {
        const ir::Range factor{value.low[k], value.high[k]};
        const double offset = k < value.offset.size() ? value.offset[k] : 0;
        ir::Range texel{1, 1};
        bool is_mask = false;
        if (value.texture && k < value.channels.size()) {
            const scene::Image& image = scene.images[value.texture->image];
            const auto channel = static_cast<std::size_t>(value.channels[k]);
            const bool decoded = value.is_srgb && channel < image.linear.size();
            const scene::ChannelFacts& facts =
                decoded ? image.linear[channel] : image.channels[channel];
            texel = {static_cast<double>(facts.low), static_cast<double>(facts.high)};
            is_mask = facts.only_ends && !value.texture->is_filtered;
        }
        const Component component = component_of(factor, texel, offset);
        const ir::Range& exact = component.exact;
        out.is_finite = out.is_finite && std::isfinite(exact.low) && std::isfinite(exact.high);
        out.components.push_back(exact);
        const bool is_constant = exact.low == exact.high;
        out.in_floats.push_back(
            is_constant || component.is_exact
                ? exact
                : ir::Range{outward(exact.low, -infinity), outward(exact.high, infinity)});
        const bool is_end = is_constant && (exact.low == 0 || exact.low == 1);
        const bool is_unscaled = factor.low == 1 && factor.high == 1 && offset == 0;
        out.is_binary = out.is_binary && (is_end || (is_mask && is_unscaled));
    }
    return out;
}

}  // namespace lobe::analyze
