// What functions of small modules are at given points, in any kind of number.
#pragma once

#include "evaluate/run.h"
#include "ir/module.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace lobe::tests {

/// The precision at which two expressions that are equal over the reals are compared, and the
/// relative difference that is put down to it: 2^-150, which leaves 50 bits for cancellation.
constexpr int real_bits = 200;
constexpr double real_slack = 0x1p-150;

/// A column of values for every scalar input, by name. A column that a function does not read
/// may be there.
template <class Number>
using Points = std::map<std::string, std::vector<Number>>;

inline void run_tape(const evaluate::Tape& tape, evaluate::Columns<float> in,
                     evaluate::Results<float> out, std::size_t count)
{
    evaluate::run(tape, in, out, count);
}
inline void run_tape(const evaluate::Tape& tape, evaluate::Columns<double> in,
                     evaluate::Results<double> out, std::size_t count)
{
    evaluate::run(tape, in, out, count);
}
inline void run_tape(const evaluate::Tape& tape, evaluate::Columns<evaluate::Real> in,
                     evaluate::Results<evaluate::Real> out, std::size_t count)
{
    evaluate::run_real(tape, real_bits, in, out, count);
}

/// All outputs at all points, output after output.
template <class Number>
std::vector<Number> values(const ir::Module& module, const ir::Function& function,
                           const Points<Number>& points)
{
    const evaluate::Tape tape = evaluate::compile(module, function);
    const std::size_t count = points.begin()->second.size();
    std::vector<const Number*> in;
    for (const evaluate::TapeInput& input : tape.inputs) {
        INFO(function.name << " reads " << input.name);
        REQUIRE(points.contains(input.name));
        in.push_back(points.at(input.name).data());
    }
    std::vector<Number> results(count * tape.outputs.size());
    std::vector<Number*> out;
    for (std::size_t i = 0; i < tape.outputs.size(); ++i) out.push_back(&results[i * count]);
    run_tape(tape, in, out, count);
    return results;
}

template <class Number>
std::vector<Number> values(const ir::Module& module, ir::FunctionId id,
                           const Points<Number>& points)
{
    return values(module, module[id], points);
}

/// Uniform points for the arguments of a function, with the ends of every range among them.
inline Points<double> sample(const ir::Module& module, const ir::Function& function,
                             std::mt19937& random, std::size_t count)
{
    Points<double> points;
    for (const evaluate::TapeInput& input : evaluate::compile(module, function).inputs) {
        const ir::Range range = function.inputs[input.input].range;
        std::uniform_real_distribution<double> pick{range.low, range.high};
        std::uniform_int_distribution<int> kind{0, 7};
        auto& column = points[input.name];
        for (std::size_t i = 0; i < count; ++i) {
            const int chosen = kind(random);
            column.push_back(chosen == 0 ? range.low : chosen == 1 ? range.high : pick(random));
        }
    }
    return points;
}

inline Points<float> in_float(const Points<double>& points)
{
    Points<float> result;
    for (const auto& [name, column] : points)
        for (const double value : column) result[name].push_back(static_cast<float>(value));
    return result;
}

inline Points<evaluate::Real> in_real(const Points<double>& points)
{
    Points<evaluate::Real> result;
    for (const auto& [name, column] : points)
        for (const double value : column) result[name].emplace_back(value, real_bits);
    return result;
}

/// |a - b| relative to the larger, or absolutely where both are below `floor`.
inline double difference(const evaluate::Real& a, const evaluate::Real& b, double floor = 1e-30)
{
    evaluate::Real gap{real_bits};
    mpfr_sub(gap.get(), a.get(), b.get(), MPFR_RNDN);
    const double scale = std::fmax(std::fabs(a.to_double()), std::fabs(b.to_double()));
    return std::fabs(gap.to_double()) / std::fmax(scale, floor);
}

/// Equal bits, up to the sign of zero.
inline bool same_bits(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace lobe::tests
