#include "check/constants.h"

#include "check/traverse.h"
#include "ir/graph.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <unordered_map>

namespace lobe::check {
namespace {

using syntax::BinaryOperator;

std::optional<double> apply(BinaryOperator op, double a, double b)
{
    switch (op) {
    case BinaryOperator::add: return a + b;
    case BinaryOperator::subtract: return a - b;
    case BinaryOperator::multiply: return a * b;
    case BinaryOperator::divide: return a / b;
    case BinaryOperator::power: {
        // Whole powers by multiplication, so that no platform's pow decides a range.
        if (b != std::floor(b) || std::abs(b) > 1024) return std::nullopt;
        double result = 1;
        for (int i = 0; i < static_cast<int>(std::abs(b)); ++i) result *= a;
        return b < 0 ? 1 / result : result;
    }
    case BinaryOperator::less:
    case BinaryOperator::less_equal:
    case BinaryOperator::greater:
    case BinaryOperator::greater_equal:
    case BinaryOperator::equal:
    case BinaryOperator::not_equal:
    case BinaryOperator::logical_and:
    case BinaryOperator::logical_or: return std::nullopt;
    }
    return std::nullopt;
}

std::optional<double> named(const std::string& name)
{
    if (name == "pi") return 3.141592653589793;
    if (name == "true") return 1.0;
    if (name == "false") return 0.0;
    return std::nullopt;
}

}  // namespace

std::optional<double> constant_value(const syntax::Tree& tree, syntax::ExpressionId root,
                                     Diagnostics& diagnostics)
{
    const auto refuse = [&](const Span& span, std::string what) {
        diagnostics.report({.code = Code::not_constant,
                            .message = "this has to be a constant",
                            .primary = {span, std::move(what)},
                            .notes = {"a constant is a number, `pi`, or + - * / ^ of constants"}});
        return std::nullopt;
    };

    std::unordered_map<std::uint32_t, double> values;
    for (const Visit& visit : walk(tree, root).visits) {
        const syntax::Expression& expression = tree[visit.id];
        std::optional<double> value;
        if (const auto* number = std::get_if<syntax::Number>(&expression.node)) {
            ir::Graph graph;
            value = graph.literal_of(graph.literal(number->text)).value;
        } else if (const auto* name = std::get_if<syntax::Name>(&expression.node)) {
            value = named(name->text);
            if (!value) return refuse(expression.span, fmt::format("`{}` is not one", name->text));
        } else if (const auto* unary = std::get_if<syntax::Unary>(&expression.node)) {
            if (unary->op == syntax::UnaryOperator::negate)
                value = -values.at(unary->operand.index);
        } else if (const auto* binary = std::get_if<syntax::Binary>(&expression.node)) {
            if (!binary->limit.valid())
                value = apply(binary->op, values.at(binary->left.index),
                              values.at(binary->right.index));
        } else if (std::holds_alternative<syntax::Poison>(expression.node)) {
            return std::nullopt;
        }
        if (!value) return refuse(expression.span, "only numbers and arithmetic can stand here");
        if (!std::isfinite(*value)) return refuse(expression.span, "this is not a finite number");
        values[visit.id.index] = *value;
    }
    const auto found = values.find(root.index);
    if (found == values.end()) return std::nullopt;
    return found->second == 0 ? 0.0 : found->second;
}

}  // namespace lobe::check
