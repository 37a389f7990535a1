#include "check/analysis.h"

#include <algorithm>
#include <cmath>

namespace lobe::check {

Analysis::Analysis(Flat flat) : function_(std::move(flat.function))
{
    function_.result = flat.roots.back();
    traced_ = evaluate::compile_traced({}, function_);
    traced_.tape.outputs.clear();
    traced_.tape.output_names.clear();
    for (const ir::ExprId root : flat.roots) {
        const auto& slots = traced_.slots_of[root.index];
        components_.push_back(slots.size());
        traced_.tape.outputs.insert(traced_.tape.outputs.end(), slots.begin(), slots.end());
        traced_.tape.output_names.resize(traced_.tape.outputs.size());
    }

    std::vector<bool> live(function_.graph.size());
    for (const ir::ExprId root : flat.roots) live[root.index] = true;
    std::vector<bool> read(function_.inputs.size());
    for (std::size_t i = function_.graph.size(); i-- > 0;) {
        const ir::ExprId id{i};
        if (!live[i]) continue;
        if (function_.graph[id].op == ir::Op::input) read[function_.graph[id].aux] = true;
        for (const ir::ExprId operand : function_.graph.operands(id)) live[operand.index] = true;
    }
    for (const evaluate::TapeInput& input : inputs()) used_.push_back(read[input.input]);
}

Box Analysis::declared() const
{
    Box box;
    for (const evaluate::TapeInput& input : inputs()) {
        const ir::Range& range = function_.inputs[input.input].range;
        box.push_back({range.low, range.high});
    }
    return box;
}

template <class Number>
void Analysis::run(const std::vector<Number>& point, std::vector<Number>& flat_results,
                   std::vector<std::vector<Number>>& results)
{
    flat_results.resize(traced_.tape.outputs.size());
    std::vector<const Number*> columns;
    for (const Number& value : point) columns.push_back(&value);
    std::vector<Number*> outputs;
    for (Number& value : flat_results) outputs.push_back(&value);
    evaluate::run(traced_.tape, evaluate::Columns<Number>{columns},
                  evaluate::Results<Number>{outputs}, 1);
    results.clear();
    std::size_t next = 0;
    for (const std::size_t count : components_) {
        results.emplace_back(flat_results.begin() + static_cast<std::ptrdiff_t>(next),
                             flat_results.begin() + static_cast<std::ptrdiff_t>(next + count));
        next += count;
    }
}

const std::vector<std::vector<Interval>>& Analysis::ranges(const Box& box)
{
    run(box, flat_ranges_, ranges_);
    return ranges_;
}

const std::vector<std::vector<double>>& Analysis::values(const std::vector<double>& point)
{
    run(point, flat_values_, values_);
    return values_;
}

Interval Analysis::extremes(std::size_t root, const std::vector<std::vector<double>>& points)
{
    std::vector<std::vector<double>> inputs_by_column(inputs().size());
    for (const auto& point : points)
        for (std::size_t i = 0; i < point.size(); ++i) inputs_by_column[i].push_back(point[i]);
    std::vector<const double*> columns;
    for (const auto& column : inputs_by_column) columns.push_back(column.data());
    std::vector<std::vector<double>> results(traced_.tape.outputs.size(),
                                             std::vector<double>(points.size()));
    std::vector<double*> outputs;
    for (auto& column : results) outputs.push_back(column.data());
    evaluate::run(traced_.tape, evaluate::Columns<double>{columns},
                  evaluate::Results<double>{outputs}, points.size());

    std::size_t first = 0;
    for (std::size_t i = 0; i < root; ++i) first += components_[i];
    Interval result{HUGE_VAL, -HUGE_VAL};
    for (std::size_t k = first; k < first + components_[root]; ++k)
        for (const double value : results[k]) {
            result.low = std::min(result.low, value);
            result.high = std::max(result.high, value);
        }
    return result;
}

namespace {

bool inside(double low, double high, const Requirement& wanted, double slack)
{
    if (!(low <= high)) return false;  // NaN
    if (wanted.nonzero && low <= 0 && high >= 0) return false;
    if (wanted.low_open && low <= wanted.low) return false;
    if (wanted.high_open && high >= wanted.high) return false;
    const auto room = [slack](double end) { return std::isinf(end) ? 0 : slack * std::abs(end); };
    // An end at 0 has the other one's size.
    const double span = std::max(room(wanted.low), room(wanted.high));
    return low >= wanted.low - span && high <= wanted.high + span;
}

}  // namespace

bool satisfies(const std::vector<Interval>& ranges, const Requirement& requirement, double slack)
{
    return std::ranges::all_of(ranges, [&](const Interval& range) {
        return inside(range.low, range.high, requirement, slack);
    });
}

bool satisfies(const std::vector<double>& values, const Requirement& requirement, double slack)
{
    return std::ranges::all_of(
        values, [&](double value) { return inside(value, value, requirement, slack); });
}

Interval hull(const std::vector<Interval>& ranges)
{
    Interval result = ranges.front();
    for (const Interval& range : ranges) {
        result.low = std::min(result.low, range.low);
        result.high = std::max(result.high, range.high);
    }
    return result;
}

}  // namespace lobe::check
