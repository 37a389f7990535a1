#include "analyze/hazards/remedy.h"

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

Remedy guard(std::string name, std::string text)
{
    return {std::move(name), std::move(text), {}, Remedy::Kind::guard};
}

/// The guard that an expression is, if it is one.
std::optional<Remedy> guard_of(const Graph& graph, ExprId id, const Span& span)
{
    switch (graph[id].op) {
    case Op::guarded_power:
        if (graph.span(id) == span)
            return guard("guarded power", "y == 0 ? 1 : x <= 0 ? 0 : pow(x, y)");
        break;
    case Op::guarded_smoothstep:
        if (graph.span(id) == span)
            return guard("guarded smoothstep", "b <= a ? (x > a ? 1 : 0) : smoothstep(a, b, x)");
        break;
    case Op::guarded_normalize:
        if (graph.span(id) == span)
            return guard("guarded normalize", "v . v > 0 ? normalize(v) : 0");
        break;
    case Op::select:
        if (const auto found = optimize::find_guard(graph, id);
            found && (graph.span(found->quotient) == span || graph.span(id) == span))
            return guard("named limit", "|b| < 2^-64 ? c : a / b");
        break;
    case Op::square_root:
    case Op::inverse_square_root:
    case Op::log:
    case Op::log2:
    case Op::arc_sine:
    case Op::arc_cosine:
        if (graph.span(id) == span) {
            const ExprId operand = graph.operands(id)[0];
            const Op held = graph[operand].op;
            if ((held == Op::maximum || held == Op::clamp) && !is_placed(graph.span(operand)))
                return guard("held in its domain",
                             held == Op::clamp ? "clamp(x, -1, 1)" : "max(x, least)");
        }
        break;
    default: break;
    }
    return std::nullopt;
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
                old, [&](ExprId id) { return guard_of(old, id, span).has_value(); }))
            return {};
        return [&rebuild, &old, &span](ExprId id) {
            if (!guard_of(old, id, span)) return rebuild.copy(id);
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
        if (auto guard = guard_of(graph, id, span)) return guard;
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
        return Remedy{std::string{best->rule->name},
                      std::string{best->rule->replacement},
                      {},
                      Remedy::Kind::rule};

    if (naive.function.graph[expression].op == Op::power) {
        bool products = false;
        for (const ExprId id : graph.ids()) {
            if (!(graph.span(id) == span)) continue;
            if (graph[id].op == Op::power) return std::nullopt;
            products |= graph[id].op == Op::multiply || graph[id].op == Op::square_root;
        }
        if (products) return Remedy{"products", "x^5 is (x^2)^2 x", {}, Remedy::Kind::products};
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
