#include "analyze/hazards_remedy.h"

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

/// The guard that an expression is, if it is one.
std::optional<Remedy> guard_of(const Graph& graph, ExprId id, const Span& span)
{
    switch (graph[id].op) {
    case Op::guarded_power:
        if (graph.span(id) == span)
            return Remedy{"guarded power", "y == 0 ? 1 : x <= 0 ? 0 : pow(x, y)", {}};
        break;
    case Op::guarded_smoothstep:
        if (graph.span(id) == span)
            return Remedy{
                "guarded smoothstep", "b <= a ? (x > a ? 1 : 0) : smoothstep(a, b, x)", {}};
        break;
    case Op::guarded_normalize:
        if (graph.span(id) == span)
            return Remedy{"guarded normalize", "v . v > 0 ? normalize(v) : 0", {}};
        break;
    case Op::select:
        if (const auto guard = optimize::find_guard(graph, id);
            guard && (graph.span(guard->quotient) == span || graph.span(id) == span))
            return Remedy{"named limit", "|b| < 2^-64 ? c : a / b", {}};
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
                return Remedy{"held in its domain",
                              held == Op::clamp ? "clamp(x, -1, 1)" : "max(x, least)",
                              {}};
        }
        break;
    default: break;
    }
    return std::nullopt;
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
        return Remedy{std::string{best->rule->name}, std::string{best->rule->replacement}, {}};

    if (naive.function.graph[expression].op == Op::power) {
        bool products = false;
        for (const ExprId id : graph.ids()) {
            if (!(graph.span(id) == span)) continue;
            if (graph[id].op == Op::power) return std::nullopt;
            products |= graph[id].op == Op::multiply || graph[id].op == Op::square_root;
        }
        if (products) return Remedy{"products", "x^5 is (x^2)^2 x", {}};
    }
    return std::nullopt;
}

ir::Module without_guards_at(const ir::Module& emitted, const Span& span)
{
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

}  // namespace lobe::analyze
