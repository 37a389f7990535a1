#include "analyze/proof/subject.h"

#include "analyze/grid.h"
#include "analyze/heads.h"
#include "analyze/scalar.h"
#include "evaluate/rounding_bounds.h"
#include "evaluate/waist.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

using evaluate::Interval;
using evaluate::Precision;

template <class Number>
std::vector<std::vector<Number>> columns(const Subject& subject, const std::vector<Point>& points)
{
    std::vector<std::vector<Number>> result(subject.tape.inputs.size(),
                                            std::vector<Number>(points.size()));
    for (std::size_t i = 0; i < subject.steps.inputs.size(); ++i) {
        auto& column = result[subject.steps.inputs[i]];
        for (std::size_t p = 0; p < points.size(); ++p)
            column[p] = static_cast<Number>(points[p][i]);
    }
    return result;
}

template <class Number>
std::vector<Number> run_points(const Subject& subject, const std::vector<Point>& points,
                               const auto& run)
{
    const auto in = columns<Number>(subject, points);
    std::vector<std::vector<Number>> out(subject.tape.outputs.size(),
                                         std::vector<Number>(points.size()));
    run(evaluate::Columns<Number>{heads(in)}, evaluate::Results<Number>{heads(out)});
    return std::move(out[subject.output]);
}

/// By their names: `to_light.x`, `to_light.y`, `to_light.z`.
std::vector<std::array<std::size_t, 3>> vectors_of(const std::vector<std::string>& names)
{
    std::vector<std::array<std::size_t, 3>> result;
    for (std::size_t x = 0; x < names.size(); ++x) {
        if (!names[x].ends_with(".x")) continue;
        const std::string stem = names[x].substr(0, names[x].size() - 1);
        const auto y = std::ranges::find(names, stem + 'y');
        const auto z = std::ranges::find(names, stem + 'z');
        if (y == names.end() || z == names.end()) continue;
        result.push_back({x, static_cast<std::size_t>(y - names.begin()),
                          static_cast<std::size_t>(z - names.begin())});
    }
    return result;
}

}  // namespace

float on_grid(double value, const Interval& side, Precision precision)
{
    return to_grid(std::clamp(value, side.low, side.high), precision);
}

std::vector<Subject> subjects(const ir::Module& module, const ir::Function& function,
                              Precision precision)
{
    const Grid& grid = grid_of(precision);
    const evaluate::Tape tape = evaluate::compile(module, function);
    const std::vector<Scalar> scalars = scalars_of(module, function, grid);
    std::vector<Subject> result;
    std::vector<std::string> keys;
    for (std::size_t output = 0; output < tape.outputs.size(); ++output) {
        Subject subject;
        subject.steps = rounding_tape(tape, output, evaluate::Detail::steps);
        std::string key = dump(subject.steps);
        for (const std::uint32_t scalar : subject.steps.inputs) {
            subject.box.push_back({scalars[scalar].low, scalars[scalar].high});
            subject.names.push_back(tape.inputs[scalar].name);
            subject.whole.push_back(scalars[scalar].whole);
            key += fmt::format("{} {};", subject.box.back().low, subject.box.back().high);
        }
        subject.vectors = vectors_of(subject.names);
        if (std::ranges::find(keys, key) != keys.end()) continue;
        keys.push_back(std::move(key));
        subject.tape = tape;
        subject.output = output;
        subject.precision = precision;
        subject.operations = rounding_tape(tape, output, evaluate::Detail::operations);
        subject.floor = precision == Precision::float32 ? 0x1p-32 : grid.least_normal;
        result.push_back(std::move(subject));
    }
    return result;
}

std::vector<Subject> from_waists(const Subject& subject, evaluate::Machine machine, bool jumps)
{
    evaluate::RoundingBounds whole{subject.steps, evaluate::rounding(machine, subject.precision),
                                   subject.floor};
    whole.error(subject.box);
    std::vector<Subject> result;
    for (const std::vector<std::uint32_t>& waist : evaluate::waists(subject.steps)) {
        Subject from;
        for (const std::uint32_t node : waist) {
            const evaluate::Rounded& value = whole.values()[node];
            from.given.push_back(value);
            if (!jumps) from.given.back().jump = 0;
            from.box.push_back(value.exact);
        }
        const bool bounded = std::ranges::all_of(from.given, [](const evaluate::Rounded& value) {
            return std::isfinite(value.exact.low) && std::isfinite(value.exact.high) &&
                   std::isfinite(value.absolute);
        });
        if (!bounded) continue;
        from.precision = subject.precision;
        from.floor = subject.floor;
        from.steps = behind(subject.steps, waist);
        result.push_back(std::move(from));
    }
    return result;
}

std::size_t boxes_within(std::size_t budget, const Subject& subject)
{
    constexpr std::size_t usual = 128;
    const std::size_t operations = std::max(subject.steps.nodes.size(), usual);
    return std::max<std::size_t>(budget * usual / operations, 1);
}

void evaluate_points(const Subject& subject, const std::vector<Point>& points,
                     std::vector<Observed>& results)
{
    results.resize(points.size());
    if (points.empty()) return;
    const auto exact = run_points<double>(subject, points, [&](auto in, auto out) {
        evaluate::run(subject.tape, in, out, points.size());
    });
    if (subject.precision == Precision::float32) {
        const auto computed = run_points<float>(subject, points, [&](auto in, auto out) {
            evaluate::run(subject.tape, in, out, points.size());
        });
        for (std::size_t i = 0; i < points.size(); ++i) results[i] = {computed[i], exact[i]};
        return;
    }
    const auto half = [&](evaluate::HalfMode mode) {
        return run_points<float>(subject, points, [&](auto in, auto out) {
            evaluate::run_half(subject.tape, mode, in, out, points.size());
        });
    };
    const auto kept = half(evaluate::HalfMode::keep_denormals);
    const auto flushed = half(evaluate::HalfMode::flush_denormals);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool worse = !(std::abs(flushed[i] - exact[i]) <= std::abs(kept[i] - exact[i]));
        results[i] = {worse ? flushed[i] : kept[i], exact[i]};
    }
}

Observed confirm_point(const Subject& subject, const Point& point)
{
    constexpr int bits = 160;
    std::vector<Observed> result;
    evaluate_points(subject, {point}, result);
    std::vector<evaluate::Real> in(subject.tape.inputs.size(), evaluate::Real{0, bits});
    for (std::size_t i = 0; i < point.size(); ++i)
        in[subject.steps.inputs[i]] = evaluate::Real{point[i], bits};
    std::vector<evaluate::Real> out(subject.tape.outputs.size(), evaluate::Real{bits});
    std::vector<const evaluate::Real*> from;
    std::vector<evaluate::Real*> to;
    for (const auto& value : in) from.push_back(&value);
    for (auto& value : out) to.push_back(&value);
    evaluate::run_real(subject.tape, bits, from, to, 1);
    // The difference is taken in 160 bits, then told in double.
    evaluate::Real difference{bits};
    const evaluate::Real computed{result[0].computed, bits};
    mpfr_sub(difference.get(), computed.get(), out[subject.output].get(), MPFR_RNDN);
    return {result[0].computed, result[0].computed - difference.to_double()};
}

std::string describe(const Subject& subject, const Point& point)
{
    std::string text;
    for (std::size_t i = 0; i < point.size(); ++i)
        text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", subject.names[i], point[i]);
    return text;
}

}  // namespace lobe::analyze
