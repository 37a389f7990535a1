// Calls: standard functions, constructors, terms.
#include "check/docs.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {

using ir::ExprId;
using ir::Op;
using ir::Quantity;
using syntax::ExpressionId;

std::string describe_signature(const Callable& callable, const Sources& sources)
{
    std::string arguments;
    for (const syntax::ParameterClause& clause : callable.term->parameters) {
        if (!arguments.empty()) arguments += ", ";
        arguments += clause.name.text + ": " + one_line(sources.text(clause.type.span));
    }
    return fmt::format("{}({})", callable.name, arguments);
}

Value Lowering::convert(Value from, const ValueType& to, const Span& span, std::string_view what,
                        const std::optional<Label>& declared)
{
    if (!from.good) return {};
    switch (fit(from.type, to)) {
    case Fit::exact: return good(to, from.expr);
    case Fit::spread: return good(to, graph().construct(to.type, {&from.expr, 1}, span));
    case Fit::none: break;
    }
    const bool mixes = (from.type == color_type && to == direction_type) ||
                       (from.type == direction_type && to == color_type);
    Diagnostic diagnostic{
        .code = mixes ? Code::mixed_color_direction : Code::type_mismatch,
        .message = fmt::format("{} is {}, and this is {}", what, describe(to), describe(from.type)),
        .primary = {span, ""}};
    if (declared) diagnostic.secondary = {*declared};
    if (mixes)
        diagnostic.notes = {"a color is an amount of light per channel, a direction a place on "
                            "the sphere: neither stands for the other"};
    else if (is_number(from.type) && is_vector(to))
        diagnostic.helps = {fmt::format("spread the number: `{}(...)`", spell(to))};
    else if (from.type == vector_type(3) && to == direction_type)
        diagnostic.helps = {"make it a direction: `normalize(...)`"};
    else if (from.type == vector_type(3) && to == color_type)
        diagnostic.helps = {"say that it is a color: `color(...)`"};
    else if (is_vector(from.type) && is_number(to))
        diagnostic.helps = {from.type == color_type
                                ? "take one channel (`.r`) or its `luminance(...)`"
                                : "take one component (`.x`) or its `length(...)`"};
    diagnostics_->report(std::move(diagnostic));
    return {};
}

bool Lowering::check_count(std::size_t given, std::size_t wanted, const Call& call,
                           const Span& span, std::string_view signature,
                           const std::optional<Label>& declared)
{
    if (given == wanted) return true;
    Diagnostic diagnostic{
        .code = Code::wrong_argument_count,
        .message = fmt::format("`{}` takes {} argument{}, not {}", call.callee.text, wanted,
                               wanted == 1 ? "" : "s", given),
        .primary = {span, given < wanted ? fmt::format("{} {} missing", wanted - given,
                                                       wanted - given == 1 ? "is" : "are")
                                         : fmt::format("{} too many", given - wanted)},
        .notes = {fmt::format("it is `{}`", signature)}};
    if (declared) diagnostic.secondary = {*declared};
    diagnostics_->report(std::move(diagnostic));
    return false;
}

Value Lowering::lower_call(const Call& call, const Span& span)
{
    const std::string& name = call.callee.text;
    const auto not_callable = [&](std::string_view what, const Span& declared) {
        diagnostics_->report({.code = Code::not_callable,
                              .message = fmt::format("`{}` is {}, not a function", name, what),
                              .primary = {call.callee.span, "called here"},
                              .secondary = {{declared, "declared here"}}});
        return Value{};
    };
    if (const auto found = locals_.find(name); found != locals_.end()) {
        found->second.used = true;
        return not_callable(found->second.is_let ? "a local value" : "an argument",
                            found->second.span);
    }
    if (const auto found = file_.names.find(name); found != file_.names.end()) {
        Declared& declared = found->second;
        declared.used = true;
        switch (declared.kind) {
        case NameKind::callable:
            return lower_term_call(program_.callables[declared.index], call, span);
        case NameKind::parameter: return not_callable("a parameter", declared.span);
        case NameKind::model:
        case NameKind::light:
        case NameKind::output:
        case NameKind::gbuffer:
        case NameKind::code: return not_callable(describe(declared.kind), declared.span);
        case NameKind::lost: return {};
        }
    }
    if (const Builtin* builtin = find_builtin(name)) return lower_builtin(*builtin, call, span);
    report_unknown_callee(call);
    return {};
}

void Lowering::report_unknown_callee(const Call& call)
{
    const std::string& name = call.callee.text;
    if (file_.broken || name.empty()) return;
    if (is_standard_name(name)) {
        diagnostics_->report({.code = Code::not_callable,
                              .message = fmt::format("`{}` is not a function", name),
                              .primary = {call.callee.span, "called here"}});
        return;
    }
    std::vector<std::string> candidates = builtin_names();
    for (const std::string& known : names_of(file_.names, NameKind::callable))
        candidates.push_back(known);
    Diagnostic diagnostic{.code = Code::unknown_name,
                          .message = fmt::format("no term or function is called `{}`", name),
                          .primary = {call.callee.span, ""}};
    const auto ours = translated(name);
    if (ours && find_builtin(*ours)) {
        diagnostic.message += fmt::format("; here it is `{}`", *ours);
        diagnostic.fix =
            Fix{call.callee.span, std::string{*ours}, fmt::format("write `{}`", *ours)};
    } else {
        diagnostic.message += did_you_mean(name, candidates);
        diagnostic.fix = rename_fix(name, call.callee.span, candidates);
    }
    diagnostics_->report(std::move(diagnostic));
}

// ---- standard functions

Value Lowering::lower_builtin(const Builtin& builtin, const Call& call, const Span& span)
{
    if (builtin.arity >= 0 &&
        !check_count(call.arguments.size(), static_cast<std::size_t>(builtin.arity), call, span,
                     builtin.signature, std::nullopt))
        return {};
    for (const ExpressionId argument : call.arguments)
        if (!value(argument).good) return {};
    switch (builtin.rule) {
    case Rule::each: return lower_each(builtin, call, span);
    case Rule::power: return lower_power(call.arguments[0], call.arguments[1], span);
    case Rule::dot:
    case Rule::cross:
    case Rule::normalize:
    case Rule::length:
    case Rule::luminance: return lower_vector_function(builtin, call, span);
    case Rule::construct:
    case Rule::make_direction: return lower_construct(builtin, call, span);
    }
    return {};
}

Value Lowering::lower_each(const Builtin& builtin, const Call& call, const Span& span)
{
    auto type = join_operands(call.arguments, fmt::format("`{}`", builtin.name), span);
    if (!type) return {};
    const bool keeps_whole = builtin.op == Op::absolute || builtin.op == Op::sign ||
                             builtin.op == Op::minimum || builtin.op == Op::maximum ||
                             builtin.op == Op::clamp || builtin.op == Op::floor;
    if (*type == integer_type && !keeps_whole) type = number_type;
    std::vector<ExprId> operands;
    for (const ExpressionId argument : call.arguments) operands.push_back(value(argument).expr);
    if (builtin.domain) {
        const Domain& domain = *builtin.domain;
        oblige({.kind = Obligation::Kind::domain,
                .any_of = {{operands[0],
                            {domain.low, domain.high, domain.low_open, domain.high_open, false}}},
                .whole = span,
                .subject = span_of(call.arguments[0]),
                .function = std::string{builtin.name}});
    }
    return good(*type, graph().apply(builtin.op, operands, span));
}

Value Lowering::lower_vector_function(const Builtin& builtin, const Call& call, const Span& span)
{
    const auto wants = [&](ExpressionId id, std::string_view what) {
        return report_operand(id, fmt::format("`{}` takes {}, and this is {}", builtin.name, what,
                                              describe(value(id).type)));
    };
    for (const ExpressionId id : call.arguments) {
        const ValueType& type = value(id).type;
        const bool color = type.quantity == Quantity::color;
        if (builtin.rule == Rule::luminance) {
            if (!color || !is_vector(type)) return wants(id, "a color");
            continue;
        }
        if (!is_vector(type)) return wants(id, "a vector");
        if (builtin.rule == Rule::dot) continue;
        if (color) return wants(id, "a vector or a direction");
        if (builtin.rule != Rule::length && type.type != ir::Type::vec3)
            return wants(id, "a float3 or a direction");
    }

    std::vector<ExprId> operands;
    for (const ExpressionId argument : call.arguments) operands.push_back(value(argument).expr);
    if (builtin.rule == Rule::luminance) {
        // Weights of linear Rec. 709 primaries.
        std::vector<ExprId> weights;
        for (const std::string_view weight : {"0.2126", "0.7152", "0.0722"})
            weights.push_back(graph().literal(weight, span));
        operands.push_back(graph().construct(ir::Type::vec3, weights, span));
    }
    const ExprId result = [&] {
        if (builtin.rule != Rule::dot) return ExprId{};
        if (!join_operands(call.arguments, "`dot`", span)) return ExprId{};
        return graph().apply(Op::dot, operands, span);
    }();
    switch (builtin.rule) {
    case Rule::dot: {
        if (!result.valid()) return {};
        const bool unit = value(call.arguments[0]).type == direction_type &&
                          value(call.arguments[1]).type == direction_type;
        if (!unit) return good(number_type, result);
        // The cosine between unit vectors, which rounding may push past 1.
        return good(number_type,
                    graph().apply(Op::clamp,
                                  {result, graph().literal("-1", span), graph().literal("1", span)},
                                  span));
    }
    case Rule::cross: return good(vector_type(3), graph().apply(Op::cross, operands, span));
    case Rule::normalize:
        return good(direction_type, graph().apply(Op::guarded_normalize, operands, span));
    case Rule::length:
    case Rule::luminance:
    case Rule::each:
    case Rule::power:
    case Rule::construct:
    case Rule::make_direction: break;
    }
    return good(number_type, graph().apply(builtin.op, operands, span));
}

Value Lowering::lower_construct(const Builtin& builtin, const Call& call, const Span& span)
{
    const bool direction = builtin.rule == Rule::make_direction;
    const ValueType type = direction                  ? direction_type
                           : builtin.name == "float2" ? vector_type(2)
                           : builtin.name == "float3" ? vector_type(3)
                           : builtin.name == "float4" ? vector_type(4)
                                                      : color_type;
    const int wanted = ir::components(type.type);
    std::vector<ExprId> scalars;
    for (const ExpressionId id : call.arguments) {
        const Value argument = value(id);
        if (!is_number(argument.type) && !is_vector(argument.type))
            return report_operand(id, fmt::format("`{}` takes numbers, and this is {}",
                                                  builtin.name, describe(argument.type)));
        if ((argument.type == color_type && direction) ||
            (argument.type == direction_type && type == color_type)) {
            return convert(argument, type, span_of(id),
                           fmt::format("what `{}` takes", builtin.name), std::nullopt);
        }
        if (is_number(argument.type))
            scalars.push_back(argument.expr);
        else
            for (int i = 0; i < ir::components(argument.type.type); ++i)
                scalars.push_back(graph().component(argument.expr, i, span_of(id)));
    }
    const bool spreads = scalars.size() == 1 && !direction;
    if (!spreads && !check_count(scalars.size(), static_cast<std::size_t>(wanted), call, span,
                                 builtin.signature, std::nullopt))
        return {};
    // A vector that is taken apart and put together again is itself.
    const bool whole = call.arguments.size() == 1 && !spreads;
    const ExprId vector =
        whole ? value(call.arguments[0]).expr : graph().construct(type.type, scalars, span);
    if (!direction) return good(type, vector);
    return good(type, graph().apply(Op::guarded_normalize, {vector}, span));
}

// ---- terms

Value Lowering::lower_term_call(const Callable& callable, const Call& call, const Span& span)
{
    const Signature& signature = callable.signature;
    if (signature.broken) return {};
    if (!check_count(call.arguments.size(), signature.arguments.size(), call, span,
                     describe_signature(callable, sources_), Label{callable.span, "declared here"}))
        return {};

    std::vector<ExprId> passed;  // per declared argument; invalid for structures
    bool fits = true;
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
        const Argument& argument = signature.arguments[i];
        const ExpressionId id = call.arguments[i];
        const Value converted = convert(value(id), argument.type.type, span_of(id),
                                        fmt::format("`{}` of `{}`", argument.name, callable.name),
                                        Label{argument.type.span, "asked for here"});
        fits = fits && converted.good;
        passed.push_back(converted.expr);
        const ir::Range& range = argument.type.range;
        const bool bounds = converted.good && argument.type.type.structure == Structure::none &&
                            argument.type.type != direction_type &&
                            argument.type.type != boolean_type;
        if (bounds)
            oblige({.kind = Obligation::Kind::argument,
                    .any_of = {{value(id).expr, {.low = range.low, .high = range.high}}},
                    .whole = span,
                    .subject = span_of(id),
                    .declared = argument.type.span,
                    .function = callable.name,
                    .name = argument.name});
    }
    if (!fits || !callable.function) return {};

    const ir::Function& callee = program_.functions[callable.function->index];
    std::vector<ExprId> operands;
    for (const ir::Input& input : callee.inputs) {
        switch (input.origin) {
        case ir::Origin::argument: operands.push_back(passed[input.which]); break;
        case ir::Origin::geometry:
            operands.push_back(draft_.geometry(static_cast<ir::GeometryField>(input.which), span));
            break;
        case ir::Origin::surface:
            operands.push_back(draft_.surface(static_cast<ir::SurfaceField>(input.which), span));
            break;
        case ir::Origin::emitter:
            operands.push_back(draft_.emitter(static_cast<ir::EmitterField>(input.which), span));
            break;
        case ir::Origin::parameter:
            operands.push_back(
                draft_.parameter(program_.parameters[input.which], input.which, span));
            break;
        }
    }
    return good({callee.quantity, callee.type(), Structure::none},
                graph().call(*callable.function, callee.type(), operands, span));
}

}  // namespace lobe::check
