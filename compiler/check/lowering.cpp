#include "check/lowering.h"

#include "check/docs.h"

#include <fmt/format.h>

namespace lobe::check {

using ir::ExprId;
using ir::Op;
using ir::Quantity;
using syntax::ExpressionId;

Lowering::Lowering(Program& program, std::size_t file, const Sources& sources, Draft& draft,
                   Diagnostics& diagnostics)
    : program_(program), file_(*program.files[file]), sources_(sources), draft_(draft),
      diagnostics_(&diagnostics)
{
}

std::string Lowering::text_of(ExpressionId id) const
{
    return one_line(sources_.text(span_of(id)));
}

void Lowering::oblige(Obligation obligation)
{
    obligation.given = facts();
    obligation.in_choice = in_choice_ || guard_ != 0;
    obligation.term = term_;
    draft_.obligations.push_back(std::move(obligation));
}

// ---- locals

bool Lowering::enter_local(const syntax::Identifier& name, const Local& local,
                           std::string_view what)
{
    if (name.text.empty()) return false;
    if (is_standard_name(name.text)) {
        diagnostics_->report(
            {.code = Code::shadowed_builtin,
             .message = fmt::format("the {} `{}` would hide the standard name", what, name.text),
             .primary = {name.span, ""},
             .helps = {"give it another name"}});
        return false;
    }
    std::optional<Span> first;
    if (const auto found = locals_.find(name.text); found != locals_.end())
        first = found->second.span;
    else if (const auto outer = file_.names.find(name.text);
             outer != file_.names.end() && outer->second.kind != NameKind::lost)
        first = outer->second.span;
    if (first)
        diagnostics_->report(
            {.code = Code::duplicate_name,
             .message = fmt::format("the {} `{}` has a name that is taken", what, name.text),
             .primary = {name.span, ""},
             .secondary = {{*first, "already declared here"}},
             .notes = {"no name hides another, so that a formula reads the same everywhere"}});
    locals_[name.text] = local;
    return !first;
}

void Lowering::add_arguments(const Signature& signature)
{
    std::size_t position = 0;
    for (const Argument& argument : signature.arguments) {
        Local local{{!argument.broken, argument.type.type, {}}, argument.span, false, false};
        if (argument.broken)
            local.value = {};
        else if (argument.type.type.structure == Structure::none)
            local.value.expr = draft_.add_argument(argument, position);
        else
            draft_.set_structure_position(argument.type.type.structure, position);
        // Two arguments of one name were reported with the signature.
        if (!locals_.contains(argument.name))
            enter_local({argument.name, argument.span}, local, "argument");
        ++position;
    }
}

void Lowering::add_lets(const std::vector<syntax::Let>& lets)
{
    for (const syntax::Let& let : lets) {
        Local local{lower(let.value), let.name.span, true, false};
        if (local.value.good && local.value.type.structure != Structure::none) {
            diagnostics_->report(
                {.code = Code::misplaced_type,
                 .message = fmt::format("a {} is not a value that a name can stand for",
                                        spell(local.value.type)),
                 .primary = {span_of(let.value), ""},
                 .helps = {"name one of its fields instead"}});
            local.value.good = false;
        }
        if (local.value.good) graph().set_name(local.value.expr, let.name.text);
        enter_local(let.name, local, "local");
    }
}

void Lowering::report_unused_lets()
{
    for (const auto& [name, local] : locals_)
        if (local.is_let && !local.used)
            diagnostics_->report({.code = Code::unused_name,
                                  .message = fmt::format("`{}` is not used", name),
                                  .primary = {local.span, ""},
                                  .helps = {"remove it, or use it in the value"}});
}

// ---- expressions

Value Lowering::lower(ExpressionId root)
{
    if (!root.valid()) return {};
    values_.clear();
    walk_ = walk(file_.tree, root);
    if (!term_.empty()) unrolled_ += walk_.visits.size();
    for (std::size_t i = 0; i < walk_.visits.size(); ++i) {
        const Visit visit = walk_.visits[i];
        guard_ = visit.guard;
        values_[visit.id.index] = lower_node(at(visit.id));
    }
    return values_.at(root.index);
}

Value Lowering::lower_node(const syntax::Expression& expression)
{
    const Span span = expression.span;
    if (const auto* number = std::get_if<syntax::Number>(&expression.node)) {
        const bool whole = number->text.find_first_of(".eE") == std::string::npos;
        return good(whole ? integer_type : number_type, graph().literal(number->text, span));
    }
    if (const auto* name = std::get_if<syntax::Name>(&expression.node))
        return lower_name(*name, span);
    if (const auto* member = std::get_if<syntax::Member>(&expression.node))
        return lower_member(*member, span);
    if (const auto* unary = std::get_if<syntax::Unary>(&expression.node))
        return lower_unary(*unary, span);
    if (const auto* binary = std::get_if<syntax::Binary>(&expression.node))
        return lower_binary(*binary, span);
    if (const auto* call = std::get_if<syntax::Call>(&expression.node))
        return lower_call(*call, span);
    if (const auto* conditional = std::get_if<syntax::Conditional>(&expression.node))
        return lower_conditional(*conditional, span);
    if (const auto* sum = std::get_if<syntax::Sum>(&expression.node)) return lower_sum(*sum, span);
    return {};
}

Value Lowering::lower_name(const syntax::Name& name, const Span& span)
{
    if (const auto found = locals_.find(name.text); found != locals_.end()) {
        found->second.used = true;
        return found->second.value;
    }
    if (const auto found = file_.names.find(name.text); found != file_.names.end())
        return lower_declared(name.text, found->second, span);
    if (name.text == "pi") return good(number_type, graph().literal("pi", span));
    if (is_builtin_constant(name.text)) {
        // The graph has no literal condition; a comparison of two literals is one.
        const ExprId zero = graph().literal("0", span);
        const ExprId other = graph().literal(name.text == "true" ? "0" : "1", span);
        return good(boolean_type, graph().apply(Op::equal, {zero, other}, span));
    }
    report_unknown_name(name.text, span);
    return {};
}

Value Lowering::lower_declared(const std::string& name, Declared& declared, const Span& span)
{
    declared.used = true;
    switch (declared.kind) {
    case NameKind::parameter: {
        if (program_.parameter_broken[declared.index]) return {};
        const ir::Parameter& parameter = program_.parameters[declared.index];
        return good({parameter.quantity, parameter.type, Structure::none},
                    draft_.parameter(parameter, static_cast<std::uint32_t>(declared.index), span));
    }
    case NameKind::callable: {
        const Callable& callable = program_.callables[declared.index];
        diagnostics_->report(
            {.code = Code::term_as_value,
             .message = fmt::format("`{}` is a term, not a value", name),
             .primary = {span, "named without its arguments"},
             .secondary = {{callable.span, "declared here"}},
             .helps = {fmt::format("call it: `{}`", describe_signature(callable, sources_))}});
        return {};
    }
    case NameKind::model:
    case NameKind::light:
    case NameKind::output:
    case NameKind::gbuffer:
    case NameKind::code: {
        Diagnostic diagnostic{
            .code = Code::term_as_value,
            .message = fmt::format("`{}` is {}, not a value", name, describe(declared.kind)),
            .primary = {span, ""},
            .secondary = {{declared.span, "declared here"}}};
        if (declared.kind == NameKind::output || declared.kind == NameKind::code)
            diagnostic.helps = {"move its formula into a term that both can call"};
        diagnostics_->report(std::move(diagnostic));
        return {};
    }
    case NameKind::lost: return {};
    }
    return {};
}

void Lowering::report_unknown_name(const std::string& name, const Span& span)
{
    if (file_.broken) return;  // its declaration may be what could not be read
    Diagnostic diagnostic{.code = Code::unknown_name,
                          .message = fmt::format("nothing here is called `{}`", name),
                          .primary = {span, ""}};
    if (const Builtin* builtin = find_builtin(name)) {
        diagnostic.code = Code::term_as_value;
        diagnostic.message = fmt::format("`{}` is a function, not a value", name);
        diagnostic.helps = {fmt::format("call it: `{}`", builtin->signature)};
        diagnostics_->report(std::move(diagnostic));
        return;
    }
    diagnostic.fix = field_fix(name, span, diagnostic.helps);
    if (!diagnostic.fix && diagnostic.helps.empty()) {
        std::vector<std::string> candidates = constant_names();
        for (const auto& [known, local] : locals_) candidates.push_back(known);
        for (const std::string& known : names_of(file_.names, NameKind::parameter))
            candidates.push_back(known);
        diagnostic.message += did_you_mean(name, candidates);
        diagnostic.fix = rename_fix(name, span, candidates);
    }
    diagnostics_->report(std::move(diagnostic));
}

// ---- choices

Value Lowering::lower_conditional(const syntax::Conditional& conditional, const Span& span)
{
    const Value condition = value(conditional.condition);
    const Value then_value = value(conditional.then_value);
    const Value else_value = value(conditional.else_value);
    if (condition.good && condition.type != boolean_type) {
        report_operand(conditional.condition, fmt::format("`if` asks a condition, and this is {}",
                                                          describe(condition.type)));
        return {};
    }
    if (!condition.good || !then_value.good || !else_value.good) return {};
    ValueType type = then_value.type;
    if (then_value.type != else_value.type || type.structure != Structure::none) {
        const auto joined =
            join_operands({conditional.then_value, conditional.else_value}, "`if`", span);
        if (!joined) return {};
        type = *joined;
    }
    return good(
        type, graph().apply(Op::select, {condition.expr, then_value.expr, else_value.expr}, span));
}

void Lowering::collect_facts(ExpressionId condition, bool holds, std::vector<Fact>& result) const
{
    struct Open {
        ExpressionId id;
        bool holds;
    };
    std::vector<Open> open{{condition, holds}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const syntax::Expression& expression = at(next.id);
        if (const auto* unary = std::get_if<syntax::Unary>(&expression.node)) {
            if (unary->op == syntax::UnaryOperator::logical_not)
                open.push_back({unary->operand, !next.holds});
            continue;
        }
        const auto* binary = std::get_if<syntax::Binary>(&expression.node);
        if (!binary) continue;
        // `a and b` holds for both; `a or b` fails for both.
        if ((binary->op == syntax::BinaryOperator::logical_and && next.holds) ||
            (binary->op == syntax::BinaryOperator::logical_or && !next.holds)) {
            open.push_back({binary->right, next.holds});
            open.push_back({binary->left, next.holds});
            continue;
        }
        const Value& left = value(binary->left);
        const Value& right = value(binary->right);
        if (!left.good || !right.good || !is_number(left.type) || !is_number(right.type)) continue;
        const auto less = [&](const Value& a, const Value& b) {
            // Where a < b fails, b <= a holds.
            result.push_back(next.holds ? Fact{Relation::less, a.expr, b.expr}
                                        : Fact{Relation::less_equal, b.expr, a.expr});
        };
        const auto less_equal = [&](const Value& a, const Value& b) {
            result.push_back(next.holds ? Fact{Relation::less_equal, a.expr, b.expr}
                                        : Fact{Relation::less, b.expr, a.expr});
        };
        const auto equal = [&](bool same) {
            result.push_back({same ? Relation::equal : Relation::not_equal, left.expr, right.expr});
        };
        switch (binary->op) {
        case syntax::BinaryOperator::less: less(left, right); break;
        case syntax::BinaryOperator::greater: less(right, left); break;
        case syntax::BinaryOperator::less_equal: less_equal(left, right); break;
        case syntax::BinaryOperator::greater_equal: less_equal(right, left); break;
        case syntax::BinaryOperator::equal: equal(next.holds); break;
        case syntax::BinaryOperator::not_equal: equal(!next.holds); break;
        case syntax::BinaryOperator::add:
        case syntax::BinaryOperator::subtract:
        case syntax::BinaryOperator::multiply:
        case syntax::BinaryOperator::divide:
        case syntax::BinaryOperator::power:
        case syntax::BinaryOperator::logical_and:
        case syntax::BinaryOperator::logical_or: break;
        }
    }
}

std::vector<Fact> Lowering::facts() const
{
    std::vector<Fact> result = given_;
    for (std::size_t guard = guard_; guard != 0; guard = walk_.guards[guard].outer)
        collect_facts(walk_.guards[guard].condition, walk_.guards[guard].holds, result);
    return result;
}

}  // namespace lobe::check
