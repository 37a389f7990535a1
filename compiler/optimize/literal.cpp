#include "optimize/literal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;

namespace {

using Exact = std::optional<double>;

/// Below this a product's rounding error may itself be lost, so nothing there counts as exact.
constexpr double smallest_trusted = 0x1p-400;
constexpr double largest_trusted = 0x1p+400;

Exact trusted(double value)
{
    if (value == 0) return 0.0;
    const double size = std::fabs(value);
    if (size >= smallest_trusted && size <= largest_trusted) return value;
    return std::nullopt;
}

Exact exact_sum(double a, double b)
{
    // [Knuth] two-sum: the rounding error of a + b is itself a double, computed here.
    const double sum = a + b;
    const double b_part = sum - a;
    const double error = (a - (sum - b_part)) + (b - b_part);
    return error == 0 ? trusted(sum) : std::nullopt;
}

Exact exact_product(double a, double b)
{
    const double product = a * b;
    return std::fma(a, b, -product) == 0 ? trusted(product) : std::nullopt;
}

Exact exact_quotient(double a, double b)
{
    if (b == 0) return std::nullopt;
    const double quotient = a / b;
    return std::fma(quotient, b, -a) == 0 ? trusted(quotient) : std::nullopt;
}

Exact exact_root(double a)
{
    if (a < 0) return std::nullopt;
    const double root = std::sqrt(a);
    return std::fma(root, root, -a) == 0 ? Exact{root} : std::nullopt;
}

Exact exact_power(double base, double exponent)
{
    constexpr double largest_exponent = 1024;
    if (exponent != std::floor(exponent) || std::fabs(exponent) > largest_exponent)
        return std::nullopt;
    Exact result = 1.0;
    for (int i = 0; i < static_cast<int>(std::fabs(exponent)) && result; ++i)
        result = exact_product(*result, base);
    if (exponent < 0 && result) return exact_quotient(1, *result);
    return result;
}

Exact exact_lerp(double a, double b, double t)
{
    const Exact span = exact_sum(b, -a);
    const Exact part = span ? exact_product(*span, t) : std::nullopt;
    return part ? exact_sum(a, *part) : std::nullopt;
}

Exact exact_smoothstep(double edge0, double edge1, double x)
{
    if (edge1 <= edge0) return x > edge0 ? 1.0 : 0.0;
    const Exact above = exact_sum(x, -edge0);
    const Exact width = exact_sum(edge1, -edge0);
    const Exact part = above && width ? exact_quotient(*above, *width) : std::nullopt;
    if (!part) return std::nullopt;
    const double t = std::clamp(*part, 0.0, 1.0);
    const Exact square = exact_product(t, t);
    const Exact twice = exact_product(-2, t);
    const Exact rest = twice ? exact_sum(3, *twice) : std::nullopt;
    return square && rest ? exact_product(*square, *rest) : std::nullopt;
}

double sign_of(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }

}  // namespace

std::optional<double> exact_value(const Literal& literal)
{
    if (literal.text == "pi" || !std::isfinite(literal.value)) return std::nullopt;
    if (literal.text == "0") return 0.0;
    if (!trusted(literal.value) || literal.value == 0) return std::nullopt;
    if (const auto rounding = rounding_of(literal))
        return *rounding == 0 ? Exact{literal.value} : std::nullopt;
    // Every digit of the double. 2^-400 has its last one at the 400th place.
    if (canonical_number(fmt::format("{:.460f}", literal.value)) != literal.text)
        return std::nullopt;
    return literal.value;
}

ExprId spread_of(const Graph& graph, ExprId id)
{
    if (graph[id].op != Op::construct) return id;
    const auto parts = graph.operands(id);
    const bool alike = std::ranges::all_of(parts, [&](ExprId part) { return part == parts[0]; });
    return alike ? parts[0] : id;
}

std::optional<double> exact_literal(const Graph& graph, ExprId id)
{
    const ExprId scalar = spread_of(graph, id);
    if (graph[scalar].op != Op::literal) return std::nullopt;
    return exact_value(graph.literal_of(scalar));
}

std::optional<double> fold_exactly(Op op, std::span<const double> operands)
{
    const auto operand = [&](std::size_t i) { return operands[i]; };
    switch (op) {
    case Op::negate: return -operand(0) + 0.0;
    case Op::absolute: return std::fabs(operand(0));
    case Op::sign: return sign_of(operand(0));
    case Op::floor: return std::floor(operand(0));
    case Op::square_root: return exact_root(operand(0));
    case Op::inverse_square_root: {
        const Exact root = exact_root(operand(0));
        return root ? exact_quotient(1, *root) : std::nullopt;
    }
    case Op::exp2: return exact_power(2, operand(0));
    case Op::log2: {
        int exponent = 0;
        const bool power_of_two = operand(0) > 0 && std::frexp(operand(0), &exponent) == 0.5;
        return power_of_two ? Exact{exponent - 1.0} : std::nullopt;
    }
    case Op::saturate: return std::clamp(operand(0), 0.0, 1.0);
    case Op::add: return exact_sum(operand(0), operand(1));
    case Op::subtract: return exact_sum(operand(0), -operand(1));
    case Op::multiply: return exact_product(operand(0), operand(1));
    case Op::divide: return exact_quotient(operand(0), operand(1));
    case Op::power:
    case Op::guarded_power: return exact_power(operand(0), operand(1));
    case Op::minimum: return std::min(operand(0), operand(1));
    case Op::maximum: return std::max(operand(0), operand(1));
    case Op::step: return operand(1) >= operand(0) ? 1.0 : 0.0;
    case Op::lerp: return exact_lerp(operand(0), operand(1), operand(2));
    case Op::clamp: return std::min(std::max(operand(0), operand(1)), operand(2));
    case Op::smoothstep:
    case Op::guarded_smoothstep: return exact_smoothstep(operand(0), operand(1), operand(2));
    case Op::exp: return operand(0) == 0 ? Exact{1.0} : std::nullopt;
    case Op::log: return operand(0) == 1 ? Exact{0.0} : std::nullopt;
    case Op::cosine: return operand(0) == 0 ? Exact{1.0} : std::nullopt;
    case Op::arc_cosine: return operand(0) == 1 ? Exact{0.0} : std::nullopt;
    case Op::sine:
    case Op::tangent:
    case Op::arc_sine:
    case Op::arc_tangent: return operand(0) == 0 ? Exact{0.0} : std::nullopt;
    // Not componentwise, without a number for a result, or without operands.
    case Op::literal:
    case Op::input:
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::not_equal:
    case Op::logical_and:
    case Op::logical_or:
    case Op::logical_not:
    case Op::select:
    case Op::dot:
    case Op::length:
    case Op::cross:
    case Op::normalize:
    case Op::guarded_normalize:
    case Op::component:
    case Op::construct:
    case Op::call: return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace lobe::optimize
