#include "analyze/agreement/gain.h"

#include "analyze/points.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cmath>

namespace lobe::analyze {

namespace {

/// All outputs at all points, output after output.
template <class Number>
std::vector<Number> results(const evaluate::Tape& tape, const Points& points)
{
    std::vector<std::vector<Number>> columns;
    for (const std::vector<float>& column : points.columns)
        columns.emplace_back(column.begin(), column.end());
    std::vector<const Number*> in;
    for (const std::vector<Number>& column : columns) in.push_back(column.data());
    std::vector<Number> values(points.size() * tape.outputs.size());
    std::vector<Number*> out;
    for (std::size_t i = 0; i < tape.outputs.size(); ++i) out.push_back(&values[i * points.size()]);
    evaluate::run(tape, evaluate::Columns<Number>{in}, evaluate::Results<Number>{out},
                  points.size());
    return values;
}

/// The least number that this share of them does not exceed; 0 of none.
double quantile(std::vector<double> numbers, double share)
{
    if (numbers.empty()) return 0;
    const auto place = numbers.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1));
    std::ranges::nth_element(numbers, place);
    return *place;
}

}  // namespace

FloatError float_error(const ir::Module& module, ir::FunctionId function, std::size_t count)
{
    const ir::Function entry = ir::entry_point(module, function);
    const evaluate::Tape tape = evaluate::compile(module, entry);
    const Points at = points(module, entry, count);
    const std::vector<float> computed = results<float>(tape, at);
    const std::vector<double> exact = results<double>(tape, at);

    FloatError error;
    error.results = computed.size();
    std::vector<double> sizes;
    for (const double value : exact)
        if (std::isfinite(value) && value != 0) sizes.push_back(std::fabs(value));
    const double dark = 0x1p-13 * quantile(std::move(sizes), 0.5);
    std::vector<double> errors;
    for (std::size_t i = 0; i < computed.size(); ++i) {
        if (!std::isfinite(computed[i])) ++error.not_finite;
        if (!std::isfinite(computed[i]) || !std::isfinite(exact[i])) continue;
        const double scale = std::fmax(std::fabs(exact[i]), dark);
        const double off = std::fabs(static_cast<double>(computed[i]) - exact[i]);
        errors.push_back(off == 0 ? 0 : off / scale);
    }
    error.typical = quantile(errors, 0.5);
    error.worst_of_99 = quantile(std::move(errors), 0.99);
    return error;
}

}  // namespace lobe::analyze
