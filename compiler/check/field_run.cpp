#include "check/field_run.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace lobe::check {
namespace {

template <class Number>
std::vector<Number> run(const evaluate::Tape& tape, const std::vector<Number>& points)
{
    std::vector<Number> results(points.size());
    const std::array<const Number*, 1> inputs{points.data()};
    const std::array<Number*, 1> outputs{results.data()};
    if constexpr (std::is_same_v<Number, Acceptance>)
        evaluate::run_acceptance(tape, evaluate::Precision::float32, inputs, outputs,
                                 points.size());
    else
        evaluate::run(tape, evaluate::Columns<Number>{inputs}, evaluate::Results<Number>{outputs},
                      points.size());
    return results;
}

template <class Number>
Number run_one(const evaluate::Tape& tape, const Number& value)
{
    return run(tape, std::vector<Number>{value})[0];
}

}  // namespace

FieldRun::FieldRun(const ir::Module& module, const ir::Field& field)
    : last_(field.last_code()), encode_(evaluate::compile(module, module[field.encode])),
      decode_(evaluate::compile(module, module[field.decode]))
{
    const auto count = static_cast<std::size_t>(field.last_code()) + 1;
    std::vector<float> codes(count);
    std::vector<double> wide(count);
    std::vector<Acceptance> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        codes[i] = static_cast<float>(i);
        wide[i] = static_cast<double>(i);
        points[i] = point(wide[i]);
    }
    floats = run(decode_, codes);
    reals = run(decode_, wide);
    accepted = run(decode_, points);
    encoded = run(encode_, accepted);
    top = code_of(field.range.high);
    bottom = code_of(field.range.low);
}

std::size_t FieldRun::code_of(double value) const
{
    return static_cast<std::size_t>(run_one(encode_, value));
}

Acceptance FieldRun::stored_and_read(double value) const
{
    const Acceptance code = run_one(encode_, point(value));
    Acceptance result = accepted[static_cast<std::size_t>(std::clamp(code.low, 0.0, last_))];
    for (double i = code.low + 1; i <= std::min(code.high, last_); ++i) {
        const Acceptance& other = accepted[static_cast<std::size_t>(i)];
        result = {std::min(result.low, other.low), std::max(result.high, other.high),
                  result.undefined || other.undefined};
    }
    result.undefined = result.undefined || code.undefined;
    return result;
}

bool FieldRun::keeps(double value) const
{
    return stored_and_read(value) == point(static_cast<float>(value));
}

double value_of(const ir::Module& module, ir::FunctionId function, double x)
{
    return run_one(evaluate::compile(module, module[function]), x);
}

}  // namespace lobe::check
