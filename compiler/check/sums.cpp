// `sum i in a .. b { … }`: its terms one after the other, each lowered with a number for the index,
// and added up from the first to the last. Nothing of the sum is left in the graph.
#include "check/constants.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <cmath>

namespace lobe::check {

using ir::Op;
using syntax::ExpressionId;

namespace {

/// Expressions that the sums of one body may come to. What is longer, no shader compiler takes.
constexpr std::size_t most_unrolled = std::size_t{1} << 16;

/// Whole numbers up to here are literals that every number of an evaluator holds.
constexpr double greatest_index = 0x1p24;

}  // namespace

/// What a sum's terms hide while they are lowered.
struct Lowering::Around {
    std::unordered_map<std::uint32_t, Value> values;
    Walk walk;
    std::size_t guard = 0;
    std::vector<Fact> given;
    bool in_choice = false;
    std::string term;
    std::map<std::string, Local, std::less<>> locals;
    Diagnostics* diagnostics = nullptr;
};

std::optional<double> Lowering::sum_end(ExpressionId end)
{
    const auto value = constant_value(file_.tree, end, *diagnostics_);
    if (!value) return std::nullopt;
    if (*value == std::floor(*value) && std::abs(*value) <= greatest_index) return value;
    diagnostics_->report(
        {.code = Code::not_constant,
         .message = "a sum runs over whole numbers",
         .primary = {span_of(end), fmt::format("this is {}", describe(*value))},
         .helps = {"compute what is between them from the index: `(i + 0.5) / 8`"}});
    return std::nullopt;
}

Value Lowering::lower_sum(const syntax::Sum& sum, const Span& span)
{
    const auto first = sum_end(sum.first);
    const auto last = sum_end(sum.last);
    if (!first || !last) return {};
    if (*last < *first) {
        diagnostics_->report(
            {.code = Code::empty_range,
             .message = "this sum has no terms",
             .primary = {join(span_of(sum.first), span_of(sum.last)),
                         fmt::format("{} is above {}", describe(*first), describe(*last))},
             .helps = {"put the smaller end first; both ends belong to the sum"}});
        return {};
    }

    // What holds where the sum stands holds in its terms.
    std::vector<Fact> given = facts();
    Around around{
        std::move(values_), std::move(walk_), guard_, std::move(given_), in_choice_, term_, locals_,
        diagnostics_};
    given_ = std::move(given);
    in_choice_ = in_choice_ || guard_ != 0;
    guard_ = 0;

    // What is wrong with a term is wrong with all of them, and said once.
    Diagnostics repeated;
    Value total;
    for (double index = *first; index <= *last; ++index) {
        term_ = fmt::format("{}{}{} = {}", around.term, around.term.empty() ? "" : ", ",
                            sum.index.text, index);
        total = add_term(total, lower_term(sum, index), span);
        if (index == *first) report_unused_in(sum);
        for (auto& [name, local] : around.locals) local.used = local.used || locals_.at(name).used;
        locals_ = around.locals;
        diagnostics_ = &repeated;
        if (!total.good) break;
    }
    values_ = std::move(around.values);
    walk_ = std::move(around.walk);
    guard_ = around.guard;
    given_ = std::move(around.given);
    in_choice_ = around.in_choice;
    term_ = std::move(around.term);
    diagnostics_ = around.diagnostics;
    if (unrolled_ > most_unrolled && term_.empty()) {
        diagnostics_->report(
            {.code = Code::sum_too_long,
             .message = "this sum is too long",
             .primary = {span, fmt::format("more than {} operations once it is written out",
                                           most_unrolled)},
             .notes = {"a shader has no loop over it: every term is computed where it stands"}});
        unrolled_ = 0;
    }
    return total;
}

/// The body for one index; its last value's operands can still be asked for.
Value Lowering::lower_term(const syntax::Sum& sum, double index)
{
    const Span at = sum.index.span;
    const Value number = good(integer_type, graph().literal(index, at));
    enter_local(sum.index, {number, at, true, false}, "index");
    add_lets(sum.body.lets);
    Value value = lower(sum.body.value);
    if (unrolled_ > most_unrolled || !value.good) return {};
    const auto type = join_operands({sum.body.value}, "`sum`", span_of(sum.body.value));
    if (!type) return {};
    value.type = *type;
    return value;
}

/// The sum so far and one more term; the first one has none before it.
Value Lowering::add_term(const Value& total, const Value& term, const Span& span)
{
    if (!term.good || !total.expr.valid()) return term;
    // Whole numbers may become others: `2^-i` is whole for i = 0 alone.
    const ValueType type = total.type == integer_type ? term.type : total.type;
    return good(type, graph().apply(Op::add, {total.expr, term.expr}, span));
}

void Lowering::report_unused_in(const syntax::Sum& sum)
{
    const auto report = [&](const syntax::Identifier& name, std::string help) {
        const auto found = locals_.find(name.text);
        if (found == locals_.end() || found->second.used) return;
        diagnostics_->report({.code = Code::unused_name,
                              .message = fmt::format("`{}` is not used", name.text),
                              .primary = {name.span, ""},
                              .helps = {std::move(help)}});
    };
    report(sum.index, "every term is the same: multiply by how many there are");
    for (const syntax::Let& let : sum.body.lets)
        report(let.name, "remove it, or use it in the value");
}

}  // namespace lobe::check
