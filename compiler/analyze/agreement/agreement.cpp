#include "analyze/agreement/agreement.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

/// How far a result is from its interval, in widths of the float grid; for choosing an example.
double distance(float value, float low, float high)
{
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    const double gap = value < low ? double{low} - value : double{value} - high;
    return gap / std::max(std::abs(double{value < low ? low : high}), 0x1p-126);
}

bool accepts(const Allowed& allowed, std::size_t point, float value)
{
    return allowed.undefined[point] ||
           (allowed.low[point] <= value && value <= allowed.high[point]);
}

/// One unit in the last place of the larger of two values. Of the larger: an error then never
/// counts more than all the bits that a float has, however small the exact value is.
double unit_in_last_place(double a, double b, evaluate::Precision precision)
{
    const bool half = precision == evaluate::Precision::float16;
    const double least_normal = half ? 0x1p-14 : 0x1p-126;
    const int digits = half ? 11 : 24;
    const double magnitude = std::max({std::abs(a), std::abs(b), least_normal});
    return std::ldexp(1.0, std::ilogb(magnitude) - digits + 1);
}

Witness witness(const Reference& reference, std::size_t point, int component, float result)
{
    const Allowed& allowed = reference.outputs[static_cast<std::size_t>(component)];
    Witness out;
    out.point = point;
    out.component = component;
    out.result = result;
    out.exact = confirm(reference, point)[static_cast<std::size_t>(component)];
    out.low = allowed.low[point];
    out.high = allowed.high[point];
    out.inputs = describe_inputs(reference, point);
    out.kind = describe(reference.points.cases[point]);
    return out;
}

/// The running maximum of one measure of error.
struct Maximum {
    double size = 0;
    std::size_t point = 0;
    int component = -1;
    float result = 0;

    void add(double error, std::size_t at, int k, float value)
    {
        if (!(error > size)) return;
        *this = {error, at, k, value};
    }

    /// The error at the point, measured anew against the confirmed value.
    template <class Measure>
    WorstError confirmed(const Reference& reference, const Measure& measure) const
    {
        if (component < 0) return {};
        WorstError out;
        out.at = witness(reference, point, component, result);
        out.size = measure(out.at->result, out.at->exact);
        return out;
    }
};

}  // namespace

std::string_view name(Route route) { return route == Route::direct ? "direct" : "optimized"; }

evaluate::Precision table_of(emit::Precision precision)
{
    return precision == emit::Precision::float16 ? evaluate::Precision::float16
                                                 : evaluate::Precision::float32;
}

Agreement compare(const Reference& reference, std::span<const float> results)
{
    const std::size_t outputs = reference.outputs.size();
    const std::size_t count = reference.points.size();
    assert(results.size() == outputs * count);
    const evaluate::Precision precision = reference.precision;
    const double least_normal = precision == evaluate::Precision::float16 ? 0x1p-14 : 0x1p-126;
    const auto absolute = [](double value, double exact) { return std::abs(value - exact); };
    const auto relative = [](double value, double exact) {
        return std::abs(value - exact) / std::abs(exact);
    };
    const auto ulp = [precision](double value, double exact) {
        return std::abs(value - exact) / unit_in_last_place(value, exact, precision);
    };

    Agreement out;
    out.points = count;
    out.undefined = reference.undefined;
    Maximum worst_absolute, worst_relative, worst_ulp, farthest;
    std::vector<double> all_ulp;
    all_ulp.reserve(outputs * count);
    for (std::size_t point = 0; point < count; ++point) {
        bool outside = false, not_a_number = false, infinite = false;
        for (std::size_t k = 0; k < outputs; ++k) {
            const Allowed& allowed = reference.outputs[k];
            if (allowed.undefined[point]) continue;
            const float value = results[point * outputs + k];
            const auto component = static_cast<int>(k);
            not_a_number |= std::isnan(value);
            infinite |= std::isinf(value);
            if (!accepts(allowed, point, value)) {
                outside = true;
                farthest.add(distance(value, allowed.low[point], allowed.high[point]), point,
                             component, value);
            }
            const double exact = allowed.exact[point];
            if (!std::isfinite(value) || !std::isfinite(exact)) continue;
            worst_absolute.add(absolute(value, exact), point, component, value);
            all_ulp.push_back(ulp(value, exact));
            worst_ulp.add(all_ulp.back(), point, component, value);
            if (std::abs(exact) >= least_normal)
                worst_relative.add(relative(value, exact), point, component, value);
        }
        out.outside += outside;
        out.not_a_number += not_a_number;
        out.infinite += infinite;
    }
    if (out.outside > 0)
        out.example = witness(reference, farthest.point, farthest.component, farthest.result);
    out.absolute = worst_absolute.confirmed(reference, absolute);
    out.relative = worst_relative.confirmed(reference, relative);
    out.ulp = worst_ulp.confirmed(reference, ulp);
    if (!all_ulp.empty()) {
        const auto rank = all_ulp.begin() + static_cast<std::ptrdiff_t>(all_ulp.size() * 99 / 100);
        std::ranges::nth_element(all_ulp, rank);
        out.ulp_of_99_percent = *rank;
    }
    return out;
}

std::size_t count_outside(const Reference& reference, std::span<const float> results)
{
    const std::size_t outputs = reference.outputs.size();
    std::size_t outside = 0;
    for (std::size_t point = 0; point < reference.points.size(); ++point)
        for (std::size_t k = 0; k < outputs; ++k)
            if (!accepts(reference.outputs[k], point, results[point * outputs + k])) {
                ++outside;
                break;
            }
    return outside;
}

std::optional<std::string> execute(device::Device& device, const Reference& reference,
                                   const emit::Harness& harness,
                                   std::span<const std::uint32_t> spirv,
                                   std::vector<float>& results)
{
    assert(static_cast<std::size_t>(harness.inputs) == reference.points.columns.size());
    assert(static_cast<std::size_t>(harness.outputs) == reference.outputs.size());
    return execute(device, reference.input, reference.points.size(), harness, spirv, results);
}

std::optional<std::string> execute(device::Device& device, std::span<const float> points,
                                   std::size_t count, const emit::Harness& harness,
                                   std::span<const std::uint32_t> spirv,
                                   std::vector<float>& results)
{
    assert(static_cast<std::size_t>(harness.inputs) * count == points.size());
    // NaN where nothing is written: a shader that skips points is caught.
    results.assign(count * static_cast<std::size_t>(harness.outputs),
                   std::numeric_limits<float>::quiet_NaN());
    return device.run(spirv, harness.entry, points, results, static_cast<std::uint32_t>(count));
}

}  // namespace lobe::analyze
