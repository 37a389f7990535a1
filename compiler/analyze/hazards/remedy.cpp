#include "analyze/hazards/remedy.h"

#include "optimize/explain.h"
#include "optimize/guard.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {
namespace {

using ir::ExprId;
using ir::Graph;
using ir::Op;

bool is_placed(const Span& span) { return span.begin != span.end; }

bool contains(const Span& outer, const Span& inner)
{
    return outer.source == inner.source && outer.begin <= inner.begin && inner.end <= outer.end;
}

Remedy remedy(std::string_view name, std::string_view text, Remedy::Kind kind)
{
    return {std::string{name}, std::string{text}, {}, kind};
}

/// What legalizing calls holding the argument of an operation; null for other operations.
const optimize::Action* holding(Op op)
{
    switch (op) {
    case Op::square_root: return &optimize::action("held_root");
    case Op::inverse_square_root: return &optimize::action("held_inverse_root");
    case Op::log:
    case Op::log2: return &optimize::action("held_logarithm");
    case Op::arc_sine:
    case Op::arc_cosine: return &optimize::action("held_angle");
    default: return nullptr;
    }
}

/// The guard that an expression is, if it is one.
const optimize::Action* guard_of(const Graph& graph, ExprId id, const Span& span)
{
    const Op op = graph[id].op;
    const bool is_here = graph.span(id) == span;
    switch (op) {
    case Op::guarded_power: return is_here ? &optimize::action("guarded_power") : nullptr;
    case Op::guarded_smoothstep: return is_here ? &optimize::action("guarded_smoothstep") : nullptr;
    case Op::guarded_normalize: return is_here ? &optimize::action("guarded_normalize") : nullptr;
    case Op::select: {
        const auto found = optimize::find_guard(graph, id);
        const bool is_around = found && graph.span(found->quotient) == span;
        return found && (is_here || is_around) ? &optimize::action("guarded_quotient") : nullptr;
    }
    default: break;
    }
    const optimize::Action* const held = holding(op);
    if (held == nullptr || !is_here) return nullptr;
    const ExprId operand = graph.operands(id)[0];
    const bool is_bounded = graph[operand].op == Op::maximum || graph[operand].op == Op::clamp;
    return is_bounded && !is_placed(graph.span(operand)) ? held : nullptr;
}

/// The module without the guards at a place.
ir::Module without_guards_at(const ir::Module& emitted, const Span& span)
{
    // Guards of the geometry have no place: they are all there is in an entry point.
    if (!is_placed(span)) {
        ir::Module bare = emitted;
        bare.bare_geometry = true;
        return bare;
    }
    return optimize::rewrite(emitted, [&span](optimize::Rebuild& rebuild) -> optimize::Step {
        const Graph& old = rebuild.old().graph;
        if (!optimize::any_expression(
                old, [&](ExprId id) { return guard_of(old, id, span) != nullptr; }))
            return {};
        return [&rebuild, &old, &span](ExprId id) {
            if (guard_of(old, id, span) == nullptr) return rebuild.copy(id);
            const auto make = [&](Op op) {
                return rebuild.graph.apply(op, rebuild.moved_operands(id), old.span(id));
            };
            switch (old[id].op) {
            case Op::guarded_power: return make(Op::power);
            case Op::guarded_smoothstep: return make(Op::smoothstep);
            case Op::guarded_normalize: return make(Op::normalize);
            case Op::select: return rebuild.moved(optimize::find_guard(old, id)->quotient);
            default: {
                // Its operand is max(x, least) or clamp(x, -1, 1).
                const ExprId held = old.operands(id)[0];
                return rebuild.graph.apply(old[id].op, {rebuild.moved(old.operands(held)[0])},
                                           old.span(id));
            }
            }
        };
    });
}

}  // namespace

std::optional<Remedy> remedy_of(const WatchedLine& naive, ExprId expression,
                                const WatchedLine& emitted,
                                std::span<const optimize::Application> applied)
{
    const Graph& graph = emitted.function.graph;
    const Span span = naive.function.graph.span(expression);
    for (const ExprId id : graph.ids())
        if (const auto* guard = guard_of(graph, id, span))
            return remedy(guard->name, guard->replacement, Remedy::Kind::guard);
    if (!is_placed(span)) return std::nullopt;

    // The smallest expression that a rule rewrote and that this one is part of; else one within it.
    const optimize::Application* best = nullptr;
    for (const optimize::Application& application : applied) {
        const bool around = contains(application.span, span);
        if (!around && !contains(span, application.span)) continue;
        if (best == nullptr ||
            application.span.end - application.span.begin < best->span.end - best->span.begin)
            best = &application;
    }
    if (best != nullptr)
        return remedy(best->rule->name, best->rule->replacement, Remedy::Kind::rule);

    if (naive.function.graph[expression].op == Op::power) {
        const optimize::Action* products = nullptr;
        for (const ExprId id : graph.ids()) {
            if (!(graph.span(id) == span)) continue;
            const Op op = graph[id].op;
            if (op == Op::power) return std::nullopt;
            if (op == Op::square_root)
                products = &optimize::action("half_power");
            else if (op == Op::multiply && products == nullptr)
                products = &optimize::action("whole_power");
        }
        if (products != nullptr)
            return remedy(products->name, products->replacement, Remedy::Kind::products);
    }
    return std::nullopt;
}

RemedyCosts::RemedyCosts(const ir::Module& emitted, const ir::Module& as_written)
    : emitted_{emitted}, as_written_{as_written}
{
}

std::size_t RemedyCosts::subject(const std::string& name, const ir::Module& module,
                                 ir::FunctionId function)
{
    const auto [place, added] =
        known_.emplace(fmt::format("{} {}", name, function.index), subjects_.size());
    if (added) subjects_.push_back({&module, {function}, Format::float32, true});
    return place->second;
}

const ir::Module& RemedyCosts::unguarded(const Span& span)
{
    const std::string place = fmt::format("{}:{}-{}", span.source, span.begin, span.end);
    const auto known = unguarded_.find(place);
    if (known != unguarded_.end()) return known->second;
    return unguarded_.emplace(place, without_guards_at(emitted_, span)).first->second;
}

void RemedyCosts::ask(ir::FunctionId function, const Span& span, Remedy& remedy)
{
    Question question;
    question.remedy = &remedy;
    question.with = subject("emitted", emitted_, function);
    switch (remedy.kind) {
    case Remedy::Kind::products: return;
    case Remedy::Kind::rule: question.without = subject("as written", as_written_, function); break;
    case Remedy::Kind::guard:
        question.without = subject(fmt::format("{}:{}-{}", span.source, span.begin, span.end),
                                   unguarded(span), function);
        break;
    }
    questions_.push_back(question);
}

void RemedyCosts::measure(const Sources& sources, const CostOptions& options, const Store& store)
{
    const Costs costs = measure_costs(subjects_, sources, options, store);
    if (!costs.no_statistics.empty()) return;
    for (const Question& question : questions_) {
        const Cost& with = costs.costs[question.with];
        const Cost& without = costs.costs[question.without];
        if (with.families.empty() || without.families.empty()) continue;
        auto& cycles = question.remedy->cycles.emplace();
        for (std::size_t i = 0; i < all_families.size(); ++i)
            cycles[i] = issue_on(with, all_families[i]) - issue_on(without, all_families[i]);
    }
}

}  // namespace lobe::analyze
