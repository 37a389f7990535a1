// Every operation either cannot leave its domain or carries its guard; see legal.h.
//
// Two steps. First powers: a literal exponent that is a multiple of one half becomes products
// and a square root. They cannot be undefined, and x^5 rounds three times, where a device's
// pow(x, 5) may round like exp2(5 log2 x), five times a logarithm's 3 ulp and more ([VulkanSpec]
// "Precision and Operation of SPIR-V Instructions"). Then guards: those that the ranges prove
// needless go, and where rounding alone could leave a domain that the real numbers keep, the
// argument is held inside it. A product of powers becomes one exponential: x^a y^b is
// 2^(a log2 x + b log2 y), and x^(5a) y^(5b) is 2^(5 (a log2 x + b log2 y)).
//
// Over the real numbers nothing changes, except that an argument of log or inverse_square_root
// below the smallest normal float counts as that float: there float has nothing better to say.
#include "evaluate/run.h"
#include "optimize/explain.h"
#include "optimize/guard.h"
#include "optimize/legal.h"
#include "optimize/literal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

constexpr double smallest_normal_float = 0x1p-126;

/// x^n for n >= 1: squares, then their products from the highest down, so x^5 is (x^2)^2 * x. In
/// this order evaluate computes whole powers too: in double nothing changes by a bit.
ExprId product_chain(Graph& graph, ExprId x, int n, Span span)
{
    std::vector<ExprId> squares{x};
    while (n >> squares.size() != 0)
        squares.push_back(graph.apply(Op::multiply, {squares.back(), squares.back()}, span));
    std::optional<ExprId> result;
    for (std::size_t bit = squares.size(); bit-- > 0;) {
        if ((n >> bit & 1) == 0) continue;
        result = result ? graph.apply(Op::multiply, {*result, squares[bit]}, span) : squares[bit];
    }
    return *result;
}

/// x^(halves / 2)
ExprId spell_power(Graph& graph, ExprId x, Type type, int halves, const Interval& base, Span span)
{
    const int size = std::abs(halves);
    const auto one = [&] { return graph.literal("1", span); };
    std::optional<ExprId> result;
    if (size == 1 && halves < 0 && base.low > 0)
        return graph.apply(Op::inverse_square_root, {x}, span);
    if (size >= 2) result = product_chain(graph, x, size / 2, span);
    if (size % 2 == 1) {
        const ExprId root = graph.apply(Op::square_root, {x}, span);
        result = result ? graph.apply(Op::multiply, {*result, root}, span) : root;
    }
    if (!result) {
        const ExprId scalar = one();
        return type == Type::scalar ? scalar : graph.construct(type, {&scalar, 1}, span);
    }
    return halves < 0 ? graph.apply(Op::divide, {one(), *result}, span) : *result;
}

bool is_power(Op op) { return op == Op::power || op == Op::guarded_power; }

Step spell_powers(Rebuild& rebuild, const Notes& notes)
{
    const Function& old = rebuild.old();
    if (!any_expression(old.graph, [&](ExprId id) { return is_power(old.graph[id].op); }))
        return {};
    auto ranges = evaluate::ranges(rebuild.old_module(), old, evaluate::declared_ranges(old));
    auto uses = use_counts(old.graph, old.result);
    return [&rebuild, &old, notes, ranges = std::move(ranges), uses = std::move(uses)](ExprId id) {
        const Expr& expr = old.graph[id];
        if (!is_power(expr.op)) return rebuild.copy(id);
        const Span span = old.graph.span(id);
        const auto note = [&](std::string_view name) {
            if (uses[id] > 0) notes.add(name, rebuild.id(), span);
        };
        const auto operands = old.graph.operands(id);
        const ExprId x = rebuild.moved(operands[0]);
        if (const auto halves = spelled_halves(old.graph, operands[1], ranges[operands[0]]);
            halves && rebuild.graph[x].type == expr.type) {
            // A square is what x * x is anywhere.
            if (*halves != 4) note(*halves % 2 == 0 ? "whole_power" : "half_power");
            return spell_power(rebuild.graph, x, expr.type, *halves, ranges[operands[0]], span);
        }
        if (exact_literal(old.graph, operands[0]) == 2 &&
            old.graph[operands[1]].type == expr.type) {
            note("power_of_two");
            return rebuild.graph.apply(Op::exp2, {rebuild.moved(operands[1])}, span);
        }
        return rebuild.copy(id);
    };
}

/// Operations that may need a guard, or lose one.
bool has_domain(Op op)
{
    switch (op) {
    case Op::power:
    case Op::guarded_power:
    case Op::smoothstep:
    case Op::guarded_smoothstep:
    case Op::normalize:
    case Op::guarded_normalize:
    case Op::square_root:
    case Op::inverse_square_root:
    case Op::log:
    case Op::log2:
    case Op::arc_sine:
    case Op::arc_cosine:
    case Op::divide: return true;
    default: return false;
    }
}

/// True for a power that a bare `pow` computes, whatever its operands.
bool is_safe(Op op, const Interval& base, const Interval& exponent)
{
    // The guard makes of 0^y the least normal float to the y: below half the least float that is
    // nothing.
    constexpr double vanishing = 150.0 / 126;
    const bool was_bare = op == Op::power && is_safe_power(base, exponent);
    return was_bare || base.low > 0 || exponent.low >= vanishing;
}

/// Products of powers, once whole and half powers are products, and what they consist of.
struct PowerProducts {
    PowerProducts(const Graph& graph, const Facts<Expr, int>& uses,
                  const Facts<Expr, Interval>& ranges)
        : is_product(graph.size()), is_part(graph.size())
    {
        Facts<Expr, bool> fits(graph.size());  // a power or a product of some, with one user
        for (const ExprId id : graph.ids()) {
            const auto operands = graph.operands(id);
            if (is_power(graph[id].op)) {
                // A logarithm of 0 is to be guarded, a power that is 0 there is not.
                const Interval& base = ranges[operands[0]];
                const bool free = base.low < smallest_normal_float &&
                                  is_safe(graph[id].op, base, ranges[operands[1]]);
                fits[id] = uses[id] == 1 && !free;
            } else if (graph[id].op == Op::multiply && fits[operands[0]] && fits[operands[1]]) {
                is_product[id] = uses[id] > 0;
                fits[id] = uses[id] == 1;
                for (const ExprId operand : operands) is_part[operand] = true;
            }
        }
    }

    Facts<Expr, bool> is_product;
    Facts<Expr, bool> is_part;
};

/// What is known of a function before its guards are placed.
struct Known {
    Facts<Expr, Interval> ranges;
    Facts<Expr, Interval> reals;  ///< over the real numbers
    Facts<Expr, bool> guarded_divisions;
    Facts<Expr, int> uses;
    PowerProducts powers;
};

/// One expression and the ranges of its operands.
class Guard {
public:
    Guard(Rebuild& rebuild, const Known& known, const Notes& notes, ExprId id)
        : rebuild_{rebuild}, known_{known}, notes_{notes}, id_{id}, old_{rebuild.old().graph}
    {
    }

    ExprId guarded()
    {
        if (known_.powers.is_part[id_]) return copy();  // and dead: the product reads what it did
        switch (old_[id_].op) {
        case Op::multiply: return known_.powers.is_product[id_] ? joined_powers() : copy();
        case Op::power:
        case Op::guarded_power: return power();
        case Op::smoothstep:
        case Op::guarded_smoothstep: {
            const bool apart = range(0).high < range(1).low;
            note(apart ? "smoothstep_without_guard" : "guarded_smoothstep");
            return make(apart ? Op::smoothstep : Op::guarded_smoothstep);
        }
        case Op::normalize:
        case Op::guarded_normalize: {
            const bool not_zero = is_not_zero(rebuild_.old(), old_.operands(id_)[0], range(0));
            note(not_zero ? "normalize_without_guard" : "guarded_normalize");
            return make(not_zero ? Op::normalize : Op::guarded_normalize);
        }
        case Op::divide: return divide();
        case Op::square_root:
            if (range(0).low >= 0) return copy();
            note("held_root");
            return make(Op::square_root, at_least(0));
        case Op::inverse_square_root:
        case Op::log:
        case Op::log2:
            if (range(0).low > 0) return copy();
            note(old_[id_].op == Op::inverse_square_root ? "held_inverse_root" : "held_logarithm");
            return make(old_[id_].op, at_least(smallest_normal_float));
        case Op::arc_sine:
        case Op::arc_cosine:
            if (range(0).low >= -1 && range(0).high <= 1) return copy();
            note("held_angle");
            return make(old_[id_].op, graph().apply(Op::clamp, {operand(0), graph().literal("-1"),
                                                                graph().literal("1")}));
        default: return copy();
        }
    }

private:
    Graph& graph() { return rebuild_.graph; }
    void note(std::string_view name) const
    {
        if (known_.uses[id_] > 0) notes_.add(name, rebuild_.id(), old_.span(id_));
    }
    const Interval& range(std::size_t i) const { return known_.ranges[old_.operands(id_)[i]]; }
    ExprId operand(std::size_t i) const { return rebuild_.moved(old_.operands(id_)[i]); }
    ExprId copy() { return rebuild_.copy(id_); }
    ExprId make(Op op) { return graph().apply(op, rebuild_.moved_operands(id_), old_.span(id_)); }
    ExprId make(Op op, ExprId x) { return graph().apply(op, {x}, old_.span(id_)); }
    ExprId at_least(double low)
    {
        return graph().apply(Op::maximum, {operand(0), graph().literal(low)});
    }

    /// The checker proved that the divisor is not 0 over the real numbers, or a choice guards it.
    /// What is left is a sum that rounding may bring to 0, or below.
    ExprId divide()
    {
        const Interval& divisor = range(1);
        if (known_.guarded_divisions[id_]) {
            note("guarded_quotient");
            return copy();
        }
        if (divisor.low > 0 || divisor.high < 0) return copy();
        const Interval& exact = known_.reals[old_.operands(id_)[1]];
        // Of either sign: the author's own condition keeps it from 0, and holding would change it.
        if (exact.low < 0 && exact.high > 0) return copy();
        note("held_divisor");
        const bool negative = exact.high <= 0 && exact.low < 0;
        const ExprId least =
            graph().literal(negative ? -smallest_normal_float : smallest_normal_float);
        const Op held = negative ? Op::minimum : Op::maximum;
        return graph().apply(Op::divide, {operand(0), graph().apply(held, {operand(1), least})},
                             old_.span(id_));
    }

    struct Power {
        ExprId id;
        std::optional<double> scale;  ///< of an exponent `scale * rest`, or just `scale`
        ExprId rest;
    };

    void collect_powers(ExprId id, std::vector<Power>& into) const
    {
        const auto operands = old_.operands(id);
        if (old_[id].op == Op::multiply) {
            for (const ExprId operand : operands) collect_powers(operand, into);
            return;
        }
        Power power{id, std::nullopt, operands[1]};
        if (old_[operands[1]].op == Op::multiply) {
            const auto factors = old_.operands(operands[1]);
            power.scale = exact_literal(old_, factors[0]);
            if (power.scale) power.rest = factors[1];
        }
        into.push_back(power);
    }

    ExprId joined_powers()
    {
        note("joined_powers");
        const Span span = old_.span(id_);
        std::vector<Power> powers;
        collect_powers(id_, powers);
        const auto scale = powers[0].scale;
        const bool alike = scale && std::ranges::all_of(powers, [&](const Power& power) {
                               return power.scale == scale;
                           });
        std::optional<ExprId> exponent;
        for (const Power& power : powers) {
            const ExprId base = old_.operands(power.id)[0];
            ExprId x = rebuild_.moved(base);
            if (known_.ranges[base].low < smallest_normal_float)
                x = graph().apply(Op::maximum, {x, graph().literal(smallest_normal_float)});
            const ExprId logarithm = graph().apply(Op::log2, {x}, old_.span(power.id));
            const ExprId times = alike ? power.rest : old_.operands(power.id)[1];
            const ExprId term =
                graph().apply(Op::multiply, {rebuild_.moved(times), logarithm}, span);
            exponent = exponent ? graph().apply(Op::add, {*exponent, term}, span) : term;
        }
        if (alike)
            exponent = graph().apply(Op::multiply, {graph().literal(*scale), *exponent}, span);
        return make(Op::exp2, *exponent);
    }

    ExprId power()
    {
        Interval base = range(0);
        ExprId x = operand(0);
        if (base.low < 0) {
            // Not negative over the real numbers, or the checker had refused it.
            x = at_least(0);
            note("held_base");
            base = {0, std::fmax(base.high, 0)};
        }
        const bool safe = is_safe(old_[id_].op, base, range(1));
        const Op op = safe ? Op::power : Op::guarded_power;
        note(safe ? "power_without_guard" : "guarded_power");
        return graph().apply(op, {x, operand(1)}, old_.span(id_));
    }

    Rebuild& rebuild_;
    const Known& known_;
    const Notes& notes_;
    ExprId id_;
    const Graph& old_;
};

Step place_guards(Rebuild& rebuild, const Notes& notes)
{
    const Function& old = rebuild.old();
    if (!any_expression(old.graph, [&](ExprId id) { return has_domain(old.graph[id].op); }))
        return {};
    const auto inputs = evaluate::declared_ranges(old);
    const auto uses = use_counts(old.graph, old.result);
    auto ranges = evaluate::ranges(rebuild.old_module(), old, inputs);
    PowerProducts powers{old.graph, uses, ranges};
    Known known{std::move(ranges),
                evaluate::ranges(rebuild.old_module(), old, inputs, evaluate::Arithmetic::reals),
                guarded_divisions(old), uses, std::move(powers)};
    return [&rebuild, notes, known = std::move(known)](ExprId id) {
        return Guard{rebuild, known, notes, id}.guarded();
    };
}

}  // namespace

Module legalize(const Module& module, const Notes& notes)
{
    const Module spelled =
        rewrite(module, [&](Rebuild& rebuild) { return spell_powers(rebuild, notes); });
    return rewrite(spelled, [&](Rebuild& rebuild) { return place_guards(rebuild, notes); });
}

Module legalize(const Module& module) { return legalize(module, {}); }

}  // namespace lobe::optimize
