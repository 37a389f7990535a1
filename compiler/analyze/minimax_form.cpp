#include "analyze/minimax_form.h"

#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lobe::analyze {
namespace {

using ir::ExprId;
using ir::Op;

/// How tightly a text binds: what needs parentheses where.
enum class Binding : std::uint8_t {
    sum,
    product,
    operand
};

/// An expression, and how it is written.
struct Spelled {
    ExprId id;
    std::string text;
    Binding binding = Binding::operand;
};

std::string in(const Spelled& spelled, Binding least)
{
    return spelled.binding >= least ? spelled.text : "(" + spelled.text + ")";
}

/// Writes a form: every operation once into the graph and once into the text. Read back, the text
/// is the graph again, operation by operation.
class Writer {
public:
    explicit Writer(ir::Graph& graph) : graph_{graph} {}

    Spelled input(const ir::Function& function, std::uint32_t index)
    {
        const ir::Input& input = function.inputs[index];
        const std::string_view of = input.origin == ir::Origin::geometry  ? "g."
                                    : input.origin == ir::Origin::surface ? "s."
                                                                          : "";
        return {graph_.input(index, input.type), fmt::format("{}{}", of, input.name)};
    }

    /// The shortest text of a float; a double that is none needs the digits of a double.
    Spelled number(double value)
    {
        const auto nearest = static_cast<float>(value);
        const std::string text =
            ir::canonical_number(static_cast<double>(nearest) == value ? fmt::format("{}", nearest)
                                                                       : fmt::format("{}", value));
        return {graph_.literal(text), text, value < 0 ? Binding::sum : Binding::operand};
    }

    Spelled add(const Spelled& a, const Spelled& b) { return sum(Op::add, a, " + ", b); }
    Spelled subtract(const Spelled& a, const Spelled& b) { return sum(Op::subtract, a, " - ", b); }
    Spelled multiply(const Spelled& a, const Spelled& b)
    {
        return product(Op::multiply, a, " * ", b);
    }
    Spelled divide(const Spelled& a, const Spelled& b) { return product(Op::divide, a, " / ", b); }

    /// Held where intervals do not show that it is.
    Spelled held(const Spelled& x, evaluate::Interval known, ir::Range range)
    {
        const bool low = known.low < range.low;
        const bool high = known.high > range.high;
        if (!low && !high) return x;
        if (range == ir::Range{0, 1}) return call(Op::saturate, "saturate", {x});
        if (!high) return call(Op::maximum, "max", {x, number(range.low)});
        if (!low) return call(Op::minimum, "min", {x, number(range.high)});
        return call(Op::clamp, "clamp", {x, number(range.low), number(range.high)});
    }

    /// c0 + x * (c1 + x * (c2 + ...)); what is absent is 0.
    std::optional<Spelled> horner(const Spelled& x,
                                  const std::vector<std::optional<Spelled>>& coefficients)
    {
        std::optional<Spelled> result;
        for (std::size_t i = coefficients.size(); i-- > 0;) {
            if (result) result = multiply(x, *result);
            if (!coefficients[i]) continue;
            result = result ? add(*coefficients[i], *result) : coefficients[i];
        }
        return result;
    }

private:
    Spelled sum(Op op, const Spelled& a, std::string_view sign, const Spelled& b)
    {
        return {graph_.apply(op, {a.id, b.id}),
                fmt::format("{}{}{}", a.text, sign, in(b, Binding::product)), Binding::sum};
    }
    Spelled product(Op op, const Spelled& a, std::string_view sign, const Spelled& b)
    {
        return {graph_.apply(op, {a.id, b.id}),
                fmt::format("{}{}{}", in(a, Binding::product), sign, in(b, Binding::operand)),
                Binding::product};
    }
    Spelled call(Op op, std::string_view name, const std::vector<Spelled>& operands)
    {
        std::vector<ExprId> ids;
        std::string list;
        for (const Spelled& spelled : operands) {
            ids.push_back(spelled.id);
            list += (list.empty() ? "" : ", ") + spelled.text;
        }
        return {graph_.apply(op, ids), fmt::format("{}({})", name, list)};
    }

    ir::Graph& graph_;
};

/// A polynomial of the shape, with coefficients in units of the inputs.
class Polynomials {
public:
    Polynomials(Writer& writer, const ir::Function& function) : writer_{writer}
    {
        for (std::uint32_t i = 0; i < function.inputs.size(); ++i) {
            axes_.push_back(axis_of(function.inputs[i].range));
            const Spelled input = writer.input(function, i);
            const double center = axes_.back().center;
            variables_.push_back(center == 0 ? input
                                             : writer.subtract(input, writer.number(center)));
        }
    }

    /// Nested: Horner's scheme in the second variable over polynomials in the first.
    Spelled write(const std::vector<Powers>& powers, const std::vector<double>& coefficients)
    {
        std::vector<std::vector<std::optional<Spelled>>> rows;
        for (std::size_t i = 0; i < powers.size(); ++i) {
            const auto x = static_cast<std::size_t>(powers[i].x);
            const auto y = static_cast<std::size_t>(powers[i].y);
            double coefficient = coefficients[i] / std::pow(axes_[0].scale, powers[i].x);
            if (y > 0) coefficient /= std::pow(axes_[1].scale, powers[i].y);
            if (coefficient == 0) continue;
            if (rows.size() <= y) rows.resize(y + 1);
            if (rows[y].size() <= x) rows[y].resize(x + 1);
            rows[y][x] = writer_.number(coefficient);
        }
        std::vector<std::optional<Spelled>> outer;
        for (const auto& row : rows) outer.push_back(writer_.horner(variables_[0], row));
        const auto result = writer_.horner(variables_.back(), outer);
        return result ? *result : writer_.number(0);
    }

private:
    Writer& writer_;
    std::vector<Axis> axes_;
    std::vector<Spelled> variables_;
};

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
        if (inputs == 1 || degree <= 4) result.push_back(polynomial(inputs, degree));
    if (inputs == 2)
        for (int degree = 2; degree <= std::min(3, max_degree / 2); ++degree)
            result.push_back(tensor(degree));
    for (const auto& [top, bottom] : {std::pair{1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 2}})
        if (top + bottom <= max_degree && (inputs == 1 || top < 3))
            result.push_back(ratio(inputs, top, bottom));
    return result;
}

ir::Function minimax_form(const ir::Module& module, ir::FunctionId term, const NamedShape& shape,
                          const Ratio& ratio)
{
    const ir::Function& of = module[term];
    ir::Function form = ir::without_body(of);
    form.name = of.name + "_" + shape.name;
    form.kind = ir::Function::Kind::form;
    form.form_of = term;
    form.form_name = shape.name;
    form.declared_range.reset();
    form.citations.clear();
    form.inputs = of.inputs;

    const auto range_of = [&](const Spelled& x) {
        form.result = x.id;
        return evaluate::ranges(module, form, evaluate::declared_ranges(form))[x.id];
    };
    Writer writer{form.graph};
    Polynomials polynomials{writer, form};
    Spelled value = polynomials.write(shape.shape.numerator, ratio.numerator);
    if (!shape.shape.denominator.empty()) {
        std::vector<Powers> powers{{0, 0}};
        std::vector<double> coefficients{1};
        powers.insert(powers.end(), shape.shape.denominator.begin(), shape.shape.denominator.end());
        coefficients.insert(coefficients.end(), ratio.denominator.begin(), ratio.denominator.end());
        const Spelled bottom = polynomials.write(powers, coefficients);
        value = writer.divide(
            value, writer.held(bottom, range_of(bottom), {least_denominator / 2, HUGE_VAL}));
    }
    value = writer.held(value, range_of(value), of.range);
    form.formula = value.text;
    const evaluate::Interval known = range_of(value);
    form.range = {std::fmax(known.low, of.range.low), std::fmin(known.high, of.range.high)};
    return form;
}

}  // namespace lobe::analyze
