// Operators: arithmetic, powers, comparisons, conditions.
#include "check/constants.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <cmath>

namespace lobe::check {

using ir::ExprId;
using ir::Op;
using syntax::BinaryOperator;
using syntax::ExpressionId;

Value Lowering::report_operand(ExpressionId operand, std::string message)
{
    diagnostics_->report({.code = Code::type_mismatch,
                          .message = std::move(message),
                          .primary = {span_of(operand), ""}});
    return {};
}

std::optional<ValueType> Lowering::join_operands(const std::vector<ExpressionId>& operands,
                                                 std::string_view what, const Span& at_span)
{
    for (const ExpressionId id : operands)
        if (!value(id).good) return std::nullopt;
    ValueType type = value(operands[0]).type;
    // One operand alone has to be a value that arithmetic knows, too.
    Joined joined = join(number_type, type);
    std::size_t clash = 0;
    for (std::size_t i = 1; i < operands.size() && joined.type; ++i) {
        clash = i;
        joined = join(type, value(operands[i]).type);
        if (joined.type) type = *joined.type;
    }
    if (joined.type) {
        // A function of one direction is no direction, nor is a sum of one number and one.
        if (operands.size() == 1 && type == direction_type) return vector_type(3);
        return type;
    }

    const ExpressionId second = operands[clash];
    Diagnostic diagnostic{.code = Code::type_mismatch, .message = "", .primary = {at_span, ""}};
    const std::string kinds =
        fmt::format("{} and {}", describe(type), describe(value(second).type));
    if (clash > 0)
        diagnostic.secondary = {
            {span_of(operands[0]), fmt::format("this is {}", describe(type))},
            {span_of(second), fmt::format("this is {}", describe(value(second).type))}};
    switch (joined.clash) {
    case Clash::boolean:
    case Clash::structure: {
        const ExpressionId culprit = [&] {
            for (const ExpressionId id : operands)
                if (!join(number_type, value(id).type).type) return id;
            return second;
        }();
        diagnostic.primary.span = span_of(culprit);
        diagnostic.secondary.clear();
        diagnostic.message =
            fmt::format("{} takes numbers, and this is {}", what, describe(value(culprit).type));
        if (joined.clash == Clash::structure) diagnostic.helps = {"name one of its fields"};
        break;
    }
    case Clash::color_direction:
        diagnostic.code = Code::mixed_color_direction;
        diagnostic.message = fmt::format("{} mixes a color and a direction", what);
        diagnostic.notes = {"a color is an amount of light per channel, a direction a place on "
                            "the sphere: their sum or product means neither"};
        break;
    case Clash::color_vector:
        diagnostic.message = fmt::format("{} cannot join {}", what, kinds);
        diagnostic.helps = {"say that the float3 is a color: `color(...)`"};
        break;
    case Clash::sizes: diagnostic.message = fmt::format("{} cannot join {}", what, kinds); break;
    }
    diagnostics_->report(std::move(diagnostic));
    return std::nullopt;
}

Value Lowering::lower_unary(const syntax::Unary& unary, const Span& span)
{
    const Value operand = value(unary.operand);
    if (!operand.good) return {};
    if (unary.op == syntax::UnaryOperator::logical_not) {
        if (operand.type != boolean_type)
            return report_operand(unary.operand, fmt::format("`not` takes a condition, and this "
                                                             "is {}",
                                                             describe(operand.type)));
        return good(boolean_type, graph().apply(Op::logical_not, {operand.expr}, span));
    }
    if (!join(number_type, operand.type).type) {
        join_operands({unary.operand}, "`-`", span);
        return {};
    }
    // A negative number is a literal of its own; the other end of a direction is a direction.
    if (graph()[operand.expr].op == Op::literal) {
        const std::string text = graph().literal_of(operand.expr).text;
        if (text != "pi" && text[0] != '-')
            return good(operand.type, graph().literal(fmt::format("-{}", text), span));
    }
    return good(operand.type, graph().apply(Op::negate, {operand.expr}, span));
}

Value Lowering::lower_binary(const Binary& binary, const Span& span)
{
    switch (binary.op) {
    case BinaryOperator::less:
    case BinaryOperator::less_equal:
    case BinaryOperator::greater:
    case BinaryOperator::greater_equal:
    case BinaryOperator::equal:
    case BinaryOperator::not_equal: return lower_comparison(binary, span);
    case BinaryOperator::logical_and:
    case BinaryOperator::logical_or: return lower_logic(binary, span);
    case BinaryOperator::power: return lower_power(binary.left, binary.right, span);
    case BinaryOperator::add:
    case BinaryOperator::subtract:
    case BinaryOperator::multiply:
    case BinaryOperator::divide: break;
    }

    const std::string sign = fmt::format("`{}`", sources_.text(binary.op_span));
    const auto type = join_operands({binary.left, binary.right}, sign, span);
    if (!type) return {};
    if (binary.op == BinaryOperator::divide) return lower_division(binary, *type, span);
    const Op op = binary.op == BinaryOperator::add        ? Op::add
                  : binary.op == BinaryOperator::subtract ? Op::subtract
                                                          : Op::multiply;
    return good(*type,
                graph().apply(op, {value(binary.left).expr, value(binary.right).expr}, span));
}

Value Lowering::lower_division(const Binary& binary, const ValueType& joined, const Span& span)
{
    // Whole numbers divide like all numbers: 1 / 2 is a half.
    const ValueType type = joined == integer_type ? number_type : joined;
    const ExprId dividend = value(binary.left).expr;
    const ExprId divisor = value(binary.right).expr;
    if (!binary.limit.valid()) {
        Obligation obligation{
            .kind = Obligation::Kind::divisor,
            .any_of = {{divisor, {.nonzero = true}}},
            .whole = span,
            .subject = span_of(binary.right),
        };
        oblige(std::move(obligation));
        return good(type, graph().apply(Op::divide, {dividend, divisor}, span));
    }

    if (!value(binary.limit).good) return {};
    const Fit fits = fit(value(binary.limit).type, type);
    const bool spreads = is_number(value(binary.limit).type) && is_vector(type);
    if (fits == Fit::none && !spreads) {
        report_operand(binary.limit,
                       fmt::format("the limit of a division that gives {} cannot be {}",
                                   describe(type), describe(value(binary.limit).type)));
        return {};
    }
    draft_.limits.push_back({divisor, facts(), span_of(binary.limit), span_of(binary.right)});
    const ExprId limit = value(binary.limit).expr;
    const ExprId least = graph().literal(ir::least_divisor, span);
    const auto guarded = [&](ExprId a, ExprId b, ExprId otherwise) {
        // The range of b drops the abs where it may.
        const ExprId size = graph().apply(Op::absolute, {b}, span);
        const ExprId divides = graph().apply(Op::less_equal, {least, size}, span);
        const ExprId quotient = graph().apply(Op::divide, {a, b}, span);
        return graph().apply(Op::select, {divides, quotient, otherwise}, span);
    };
    if (graph()[divisor].type == ir::Type::scalar)
        return good(type, guarded(dividend, divisor, limit));
    // A choice is made by one condition, so each component makes its own.
    std::vector<ExprId> components;
    for (int i = 0; i < ir::components(type.type); ++i) {
        const auto component = [&](ExprId of) {
            return graph()[of].type == ir::Type::scalar ? of : graph().component(of, i, span);
        };
        components.push_back(guarded(component(dividend), component(divisor), component(limit)));
    }
    return good(type, graph().construct(type.type, components, span));
}

std::optional<double> Lowering::whole_literal(ExprId expr)
{
    if (graph()[expr].op != Op::literal) return std::nullopt;
    const ir::Literal& literal = graph().literal_of(expr);
    if (literal.text == "pi" || literal.text.find_first_of(".e") != std::string::npos)
        return std::nullopt;
    return literal.value;
}

Value Lowering::lower_power(ExpressionId base_id, ExpressionId exponent_id, const Span& span)
{
    const auto joined = join_operands({base_id, exponent_id}, "`^`", span);
    if (!joined) return {};
    const Value base = value(base_id);
    const Value exponent = value(exponent_id);
    const auto require = [&](Obligation::Kind kind, std::vector<Claim> any_of, ExpressionId at) {
        oblige({.kind = kind, .any_of = std::move(any_of), .whole = span, .subject = span_of(at)});
    };

    if (const auto whole = whole_literal(exponent.expr)) {
        // x^2 of a whole number is whole; x^-1 is not.
        const ValueType type = *whole < 0 && *joined == integer_type ? number_type : *joined;
        if (*whole < 0)
            require(Obligation::Kind::power_zero, {{base.expr, {.nonzero = true}}}, base_id);
        return good(type, graph().apply(Op::power, {base.expr, exponent.expr}, span));
    }
    const ValueType type = *joined == integer_type ? number_type : *joined;
    require(Obligation::Kind::power_base, {{base.expr, {.low = 0}}}, base_id);
    require(Obligation::Kind::power_zero,
            {{base.expr, {.low = 0, .low_open = true}}, {exponent.expr, {.low = 0}}}, exponent_id);
    // 0^(5/2) is 0 everywhere; only an exponent that varies needs care.
    Diagnostics said;
    const auto constant = constant_value(file_.tree, exponent_id, said);
    const Op op = constant && *constant > 0 ? Op::power : Op::guarded_power;
    return good(type, graph().apply(op, {base.expr, exponent.expr}, span));
}

Value Lowering::lower_comparison(const Binary& binary, const Span& span)
{
    const Value left = value(binary.left);
    const Value right = value(binary.right);
    if (!left.good || !right.good) return {};
    const bool equality =
        binary.op == BinaryOperator::equal || binary.op == BinaryOperator::not_equal;
    const std::string sign = fmt::format("`{}`", sources_.text(binary.op_span));
    const bool conditions = left.type == boolean_type && right.type == boolean_type;
    ValueType type = number_type;
    if (!(equality && conditions)) {
        const auto joined = join_operands({binary.left, binary.right}, sign, span);
        if (!joined) return {};
        type = *joined;
    }
    if (is_vector(type) && !equality)
        return report_operand(
            is_vector(left.type) ? binary.left : binary.right,
            fmt::format("{} has no order; compare one of its components", describe(type)));

    const auto compare = [&](ExprId a, ExprId b) {
        switch (binary.op) {
        case BinaryOperator::less: return graph().apply(Op::less, {a, b}, span);
        case BinaryOperator::less_equal: return graph().apply(Op::less_equal, {a, b}, span);
        case BinaryOperator::greater: return graph().apply(Op::less, {b, a}, span);
        case BinaryOperator::greater_equal: return graph().apply(Op::less_equal, {b, a}, span);
        case BinaryOperator::equal: return graph().apply(Op::equal, {a, b}, span);
        case BinaryOperator::not_equal:
        case BinaryOperator::add:
        case BinaryOperator::subtract:
        case BinaryOperator::multiply:
        case BinaryOperator::divide:
        case BinaryOperator::power:
        case BinaryOperator::logical_and:
        case BinaryOperator::logical_or: break;
        }
        return graph().apply(Op::not_equal, {a, b}, span);
    };
    if (!is_vector(type)) return good(boolean_type, compare(left.expr, right.expr));

    // Vectors are equal where all components are, and differ where any does.
    const Op both = binary.op == BinaryOperator::equal ? Op::logical_and : Op::logical_or;
    ExprId result;
    for (int i = 0; i < ir::components(type.type); ++i) {
        const auto component = [&](ExprId of) {
            return graph()[of].type == ir::Type::scalar ? of : graph().component(of, i, span);
        };
        const ExprId one = compare(component(left.expr), component(right.expr));
        result = result.valid() ? graph().apply(both, {result, one}, span) : one;
    }
    return good(boolean_type, result);
}

Value Lowering::lower_logic(const Binary& binary, const Span& span)
{
    const Value left = value(binary.left);
    const Value right = value(binary.right);
    bool fits = left.good && right.good;
    for (const ExpressionId id : {binary.left, binary.right})
        if (value(id).good && value(id).type != boolean_type) {
            report_operand(id,
                           fmt::format("`{}` takes conditions, and this is {}",
                                       sources_.text(binary.op_span), describe(value(id).type)));
            fits = false;
        }
    if (!fits) return {};
    const Op op = binary.op == BinaryOperator::logical_and ? Op::logical_and : Op::logical_or;
    return good(boolean_type, graph().apply(op, {left.expr, right.expr}, span));
}

}  // namespace lobe::check
