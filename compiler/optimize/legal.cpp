#include "optimize/legal.h"

#include "evaluate/run.h"
#include "optimize/guard.h"
#include "optimize/literal.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

class Checker {
public:
    Checker(const Module& module, const Function& function)
        : function_{function}, graph_{function.graph}, ranges_{evaluate::ranges(
                                                           module, function,
                                                           evaluate::declared_ranges(function))},
          uses_{use_counts(graph_, function.result)}, is_guarded_{guarded_divisions(function)}
    {
    }

    std::optional<std::string> run() const
    {
        for (const ExprId id : graph_.ids())
            if (uses_[id] > 0)
                if (auto broken = check(id))
                    return fmt::format("{}: %{} {}", function_.name, id.index, *broken);
        return std::nullopt;
    }

private:
    std::optional<std::string> check(ExprId id) const
    {
        const auto operands = graph_.operands(id);
        const auto range = [&](std::size_t i) -> const Interval& { return ranges_[operands[i]]; };
        const auto outside = [&](std::size_t i) {
            return fmt::format("{}: operand {} is in [{}, {}]", name(graph_[id].op), i,
                               range(i).low, range(i).high);
        };
        switch (graph_[id].op) {
        case Op::power:
            if (!is_safe_power(range(0), range(1))) return outside(0);
            [[fallthrough]];
        case Op::guarded_power:
            if (spelled_halves(graph_, operands[1], range(0)))
                return fmt::format("{} has an exponent that products spell", name(graph_[id].op));
            return std::nullopt;
        case Op::smoothstep:
            if (range(0).high < range(1).low) return std::nullopt;
            return outside(1);
        case Op::normalize:
            if (is_not_zero(function_, operands[0], range(0))) return std::nullopt;
            return outside(0);
        case Op::divide:
            if (range(1).low > 0 || range(1).high < 0 || is_guarded_[id]) return std::nullopt;
            return outside(1);
        case Op::square_root:
            if (range(0).low >= 0) return std::nullopt;
            return outside(0);
        case Op::inverse_square_root:
        case Op::log:
        case Op::log2:
            if (range(0).low > 0) return std::nullopt;
            return outside(0);
        case Op::arc_sine:
        case Op::arc_cosine:
            if (range(0).low >= -1 && range(0).high <= 1) return std::nullopt;
            return outside(0);
        // Total: defined for every operand, or not an operation on numbers.
        case Op::literal:
        case Op::input:
        case Op::negate:
        case Op::absolute:
        case Op::sign:
        case Op::floor:
        case Op::exp2:
        case Op::exp:
        case Op::sine:
        case Op::cosine:
        case Op::tangent:
        case Op::arc_tangent:
        case Op::saturate:
        case Op::add:
        case Op::subtract:
        case Op::multiply:
        case Op::minimum:
        case Op::maximum:
        case Op::step:
        case Op::lerp:
        case Op::clamp:
        case Op::guarded_smoothstep:
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
        case Op::guarded_normalize:
        case Op::component:
        case Op::construct:
        case Op::call: return std::nullopt;
        }
        return std::nullopt;
    }

    const Function& function_;
    const Graph& graph_;
    Facts<Expr, Interval> ranges_;
    Facts<Expr, int> uses_;
    Facts<Expr, bool> is_guarded_;
};

}  // namespace

std::optional<std::string> illegal(const Module& module)
{
    for (const FunctionId id : module.reachable(all_roots(module)))
        if (auto broken = Checker{module, module[id]}.run()) return broken;
    return std::nullopt;
}

std::optional<int> spelled_halves(const Graph& graph, ExprId exponent, const Interval& base)
{
    // Twelve products at most; past that a power is cheaper and as accurate. A base that may be
    // negative has no other spelling.
    constexpr double largest = 64;
    constexpr double largest_of_negative = 4096;
    const auto value = exact_literal(graph, exponent);
    if (!value) return std::nullopt;
    const double halves = 2 * *value;
    const bool whole = std::floor(*value) == *value;
    if (halves != std::floor(halves) || (!whole && base.low < 0)) return std::nullopt;
    if (std::fabs(*value) > (base.low < 0 ? largest_of_negative : largest)) return std::nullopt;
    return static_cast<int>(halves);
}

bool is_safe_power(const Interval& base, const Interval& exponent)
{
    return base.low > 0 || (base.low >= 0 && exponent.low > 0);
}

bool is_not_zero(const Function& function, ExprId vector, const Interval& hull)
{
    if (hull.low > 0 || hull.high < 0) return true;
    const Expr& expr = function.graph[vector];
    return expr.op == Op::input && function.inputs[expr.aux].quantity == Quantity::direction &&
           !(function.inputs[expr.aux].origin == Origin::geometry &&
             function.inputs[expr.aux].which == static_cast<std::uint32_t>(GeometryField::h));
}

}  // namespace lobe::optimize
