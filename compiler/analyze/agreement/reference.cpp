#include "analyze/agreement/reference.h"

#include "analyze/heads.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

/// Points go through in chunks, so that acceptance intervals (24 bytes a value) never fill memory.
constexpr std::size_t chunk_size = 4096;

float least_float_from(double low)
{
    const auto nearest = static_cast<float>(low);
    if (static_cast<double>(nearest) >= low) return nearest;
    return std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// Inputs of points first .. first + size - 1, each made a `Number`.
template <class Number, class Make>
std::vector<std::vector<Number>> slice(const Points& points, std::size_t first, std::size_t size,
                                       const Make& make)
{
    std::vector<std::vector<Number>> columns;
    for (const auto& column : points.columns) {
        auto& out = columns.emplace_back();
        out.reserve(size);
        for (std::size_t i = 0; i < size; ++i) out.push_back(make(column[first + i]));
    }
    return columns;
}

}  // namespace

Reference reference(const ir::Module& module, ir::FunctionId function,
                    evaluate::Precision precision, std::size_t count)
{
    Reference out;
    out.entry = ir::entry_point(module, function);
    out.tape = evaluate::compile(module, out.entry);
    out.precision = precision;
    out.points = points(module, out.entry, count, precision);
    assert(out.tape.inputs.size() == out.points.columns.size());

    out.input = interleaved(out.points);

    const std::size_t outputs = out.tape.outputs.size();
    out.outputs.resize(outputs);
    for (Allowed& allowed : out.outputs) {
        allowed.low.resize(count);
        allowed.high.resize(count);
        allowed.undefined.resize(count);
        allowed.exact.resize(count);
    }

    std::vector<std::vector<evaluate::Acceptance>> accepted(
        outputs, std::vector<evaluate::Acceptance>(chunk_size));
    std::vector<std::vector<double>> exact(outputs, std::vector<double>(chunk_size));
    std::chrono::steady_clock::duration spent{};
    for (std::size_t first = 0; first < count; first += chunk_size) {
        const std::size_t size = std::min(chunk_size, count - first);
        const auto intervals = slice<evaluate::Acceptance>(out.points, first, size, [](float x) {
            return evaluate::Acceptance{x, x, false};
        });
        const auto start = std::chrono::steady_clock::now();
        evaluate::run_acceptance(out.tape, precision, heads(intervals), heads(accepted), size);
        spent += std::chrono::steady_clock::now() - start;

        const auto doubles =
            slice<double>(out.points, first, size, [](float x) { return static_cast<double>(x); });
        evaluate::run(out.tape, evaluate::Columns<double>{heads(doubles)},
                      evaluate::Results<double>{heads(exact)}, size);

        for (std::size_t k = 0; k < outputs; ++k)
            for (std::size_t i = 0; i < size; ++i) {
                const evaluate::Acceptance& value = accepted[k][i];
                Allowed& allowed = out.outputs[k];
                allowed.low[first + i] = least_float_from(value.low);
                allowed.high[first + i] = -least_float_from(-value.high);
                allowed.undefined[first + i] = value.undefined;
                allowed.exact[first + i] = exact[k][i];
            }
    }
    out.seconds = std::chrono::duration<double>(spent).count();

    for (std::size_t point = 0; point < count; ++point)
        out.undefined += std::ranges::any_of(
            out.outputs, [point](const Allowed& allowed) { return allowed.undefined[point]; });
    return out;
}

std::vector<double> confirm(const Reference& reference, std::size_t point)
{
    constexpr int bits = 113;
    const auto inputs = slice<evaluate::Real>(reference.points, point, 1, [](float x) {
        return evaluate::Real{x, bits};
    });
    std::vector<std::vector<evaluate::Real>> results(
        reference.outputs.size(), std::vector<evaluate::Real>(1, evaluate::Real{bits}));
    evaluate::run_real(reference.tape, bits, heads(inputs), heads(results), 1);
    std::vector<double> values;
    for (const auto& result : results) values.push_back(result.front().to_double());
    return values;
}

std::string describe_inputs(const Reference& reference, std::size_t point)
{
    return describe_inputs(reference.entry, reference.points, point);
}

}  // namespace lobe::analyze
