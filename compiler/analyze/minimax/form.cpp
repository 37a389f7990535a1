#include "analyze/minimax/form.h"

#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lobe::analyze {
namespace {

using ir::ExprId;
using ir::Op;

/// Writes ratios into a graph, in some inputs of its function.
class Writer {
public:
    Writer(const ir::Module& module, ir::Function& function,
           const std::vector<std::uint32_t>& inputs)
        : module_{module}, function_{function}, graph_{function.graph}
    {
        for (const std::uint32_t input : inputs) {
            axes_.push_back(axis_of(function.inputs[input].range));
            const ExprId x = graph_.input(input, ir::Type::scalar);
            const double center = axes_.back().center;
            variables_.push_back(center == 0 ? x
                                             : graph_.apply(Op::subtract, {x, literal(center)}));
        }
    }

    ExprId write(const Shape& shape, const Ratio& ratio, ir::Range range)
    {
        const ExprId top = polynomial(shape.numerator, ratio.numerator);
        if (shape.denominator.empty()) return held(top, range);
        std::vector<Powers> powers{{0, 0}};
        std::vector<double> coefficients{1};
        powers.insert(powers.end(), shape.denominator.begin(), shape.denominator.end());
        coefficients.insert(coefficients.end(), ratio.denominator.begin(), ratio.denominator.end());
        const ExprId bottom =
            held(polynomial(powers, coefficients), {least_denominator / 2, HUGE_VAL});
        return held(graph_.apply(Op::divide, {top, bottom}), range);
    }

private:
    /// The shortest text of a float; a double that is none needs the digits of a double.
    ExprId literal(double value)
    {
        const auto nearest = static_cast<float>(value);
        return graph_.literal(ir::canonical_number(static_cast<double>(nearest) == value
                                                       ? fmt::format("{}", nearest)
                                                       : fmt::format("{}", value)));
    }

    ExprId held(ExprId x, ir::Range range)
    {
        function_.result = x;
        const evaluate::Interval known =
            evaluate::ranges(module_, function_, evaluate::declared_ranges(function_))[x];
        const bool low = known.low < range.low;
        const bool high = known.high > range.high;
        if (!low && !high) return x;
        if (range == ir::Range{0, 1}) return graph_.apply(Op::saturate, {x});
        if (!high) return graph_.apply(Op::maximum, {x, literal(range.low)});
        if (!low) return graph_.apply(Op::minimum, {x, literal(range.high)});
        return graph_.apply(Op::clamp, {x, literal(range.low), literal(range.high)});
    }

    using Coefficients = std::vector<std::optional<ExprId>>;

    /// c0 + x * (c1 + x * (c2 + ...)); what is absent is 0.
    std::optional<ExprId> horner(ExprId x, const Coefficients& coefficients)
    {
        std::optional<ExprId> result;
        for (std::size_t i = coefficients.size(); i-- > 0;) {
            if (result)
                result =
                    graph_.is_literal(*result, 1) ? x : graph_.apply(Op::multiply, {x, *result});
            if (!coefficients[i]) continue;
            result = result ? graph_.apply(Op::add, {*coefficients[i], *result}) : coefficients[i];
        }
        return result;
    }

    /// Nested: Horner's scheme in the second variable over polynomials in the first.
    ExprId polynomial(const std::vector<Powers>& powers, const std::vector<double>& coefficients)
    {
        std::vector<Coefficients> rows;
        for (std::size_t i = 0; i < powers.size(); ++i) {
            const auto x = static_cast<std::size_t>(powers[i].x);
            const auto y = static_cast<std::size_t>(powers[i].y);
            double coefficient = coefficients[i] / std::pow(axes_.front().scale, powers[i].x) /
                                 std::pow(axes_.back().scale, powers[i].y);
            if (coefficient == 0) continue;
            if (rows.size() <= y) rows.resize(y + 1);
            if (rows[y].size() <= x) rows[y].resize(x + 1);
            rows[y][x] = literal(coefficient);
        }
        Coefficients outer;
        for (const Coefficients& row : rows) outer.push_back(horner(variables_.front(), row));
        const auto result = horner(variables_.back(), outer);
        return result ? *result : literal(0);
    }

    const ir::Module& module_;
    ir::Function& function_;
    ir::Graph& graph_;
    std::vector<Axis> axes_;
    std::vector<ExprId> variables_;
};

/// What the result needs of the old graph, up to what is replaced.
std::vector<bool> needed(const ir::Function& function, const std::vector<Replacement>& replacements)
{
    std::vector<bool> result(function.graph.size(), false);
    result[function.result.index] = true;
    for (std::size_t i = function.graph.size(); i-- > 0;) {
        const ExprId id{i};
        if (!result[i] ||
            std::ranges::find(replacements, id, &Replacement::root) != replacements.end())
            continue;
        for (const ExprId operand : function.graph.operands(id)) result[operand.index] = true;
    }
    return result;
}

std::vector<Powers> of_degree(std::size_t inputs, int degree)
{
    std::vector<Powers> result;
    for (int total = 0; total <= degree; ++total)
        for (int y = 0; y <= (inputs == 1 ? 0 : total); ++y) result.push_back({total - y, y});
    return result;
}

NamedShape polynomial(std::size_t inputs, int degree)
{
    return {fmt::format("minimax_{}", degree), {of_degree(inputs, degree), {}}};
}

NamedShape tensor(int degree)
{
    Shape shape;
    for (int y = 0; y <= degree; ++y)
        for (int x = 0; x <= degree; ++x) shape.numerator.push_back({x, y});
    return {fmt::format("minimax_{}x{}", degree, degree), shape};
}

NamedShape ratio(std::size_t inputs, int top, int bottom)
{
    Shape shape{of_degree(inputs, top), of_degree(inputs, bottom)};
    shape.denominator.erase(shape.denominator.begin());  // the constant, which is 1
    return {fmt::format("minimax_{}_{}", top, bottom), shape};
}

}  // namespace

Axis axis_of(ir::Range range)
{
    Axis axis;
    const double width = range.high - range.low;
    // Far from 0, powers of the input itself would cancel each other.
    if (std::fmin(std::fabs(range.low), std::fabs(range.high)) > width &&
        range.low * range.high > 0)
        axis.center = static_cast<double>(static_cast<float>(range.low + width / 2));
    const double reach =
        std::fmax(std::fabs(range.low - axis.center), std::fabs(range.high - axis.center));
    while (axis.scale < reach) axis.scale *= 2;
    while (axis.scale / 2 >= reach) axis.scale /= 2;
    return axis;
}

std::vector<NamedShape> shapes(std::size_t inputs, int max_degree)
{
    std::vector<NamedShape> result;
    for (int degree = 2; degree <= max_degree; ++degree)
        result.push_back(polynomial(inputs, degree));
    if (inputs == 2)
        for (int degree = 2; 2 * degree <= max_degree; ++degree) result.push_back(tensor(degree));
    for (const auto& [top, bottom] :
         {std::pair{1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 2}, {2, 3}, {3, 3}})
        if (top + bottom <= max_degree) result.push_back(ratio(inputs, top, bottom));
    return result;
}

ir::Function replaced(const ir::Module& module, const ir::Function& function,
                      const std::vector<Replacement>& replacements)
{
    ir::Function result = ir::without_body(function);
    result.inputs = function.inputs;
    const std::vector<bool> wanted = needed(function, replacements);
    Facts<ir::Expr, ExprId> moved(function.graph.size());
    for (const ExprId id : function.graph.ids()) {
        if (!wanted[id.index]) continue;
        const auto found = std::ranges::find(replacements, id, &Replacement::root);
        if (found != replacements.end()) {
            Writer writer{module, result, found->inputs};
            moved[id] = writer.write(found->shape, found->ratio, found->range);
            continue;
        }
        std::vector<ExprId> operands;
        for (const ExprId operand : function.graph.operands(id)) operands.push_back(moved[operand]);
        moved[id] = result.graph.copy(function.graph, id, operands);
    }
    result.result = moved[function.result];
    return result;
}

}  // namespace lobe::analyze
