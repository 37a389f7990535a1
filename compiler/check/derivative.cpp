#include "check/derivative.h"

#include <array>
#include <limits>
#include <string>

namespace lobe::check {
namespace {

using ir::ExprId;
using ir::Graph;
using ir::Op;
using ir::Type;

/// One forward sweep for one scalar input. An invalid id stands for 0.
class Sweep {
public:
    Sweep(Graph& graph, std::uint32_t rising, std::uint32_t any, ScalarInput with)
        : graph_(graph), with_(with)
    {
        rising_ = graph_.input(rising, Type::scalar);
        any_ = graph_.input(any, Type::scalar);
    }

    ExprId run(ExprId subject)
    {
        slopes_.resize(subject.index + 1);
        for (std::size_t i = 0; i <= subject.index; ++i) {
            const ExprId id{i};
            ExprId slope = slope_of(id);
            const Type type = graph_[id].type;
            if (slope.valid() && graph_[slope].type != type && type != Type::boolean)
                slope = graph_.construct(type, {&slope, 1});
            slopes_[i] = slope;
        }
        return slopes_[subject.index].valid() ? slopes_[subject.index] : graph_.literal("0");
    }

private:
    ExprId apply(Op op, std::initializer_list<ExprId> operands)
    {
        return graph_.apply(op, operands);
    }
    ExprId literal(std::string_view text) { return graph_.literal(text); }
    ExprId plus(ExprId a, ExprId b)
    {
        if (!a.valid()) return b;
        return b.valid() ? apply(Op::add, {a, b}) : a;
    }
    ExprId minus(ExprId a) { return a.valid() ? apply(Op::negate, {a}) : a; }
    ExprId minus(ExprId a, ExprId b)
    {
        if (!b.valid()) return a;
        return a.valid() ? apply(Op::subtract, {a, b}) : minus(b);
    }
    ExprId times(ExprId factor, ExprId slope)
    {
        return slope.valid() ? apply(Op::multiply, {factor, slope}) : slope;
    }
    /// The slope of a function that only rises, by an unknown amount.
    ExprId rising(ExprId slope) { return times(rising_, slope); }
    ExprId or_zero(ExprId slope) { return slope.valid() ? slope : literal("0"); }

    /// Blends the slopes of two operands by which of them is chosen; both where that is open.
    ExprId blend(ExprId a, ExprId b, ExprId where_b)
    {
        if (!a.valid() && !b.valid()) return {};
        return apply(Op::lerp, {or_zero(a), or_zero(b), where_b});
    }
    ExprId of_minimum(ExprId a, ExprId b, ExprId slope_a, ExprId slope_b)
    {
        return blend(slope_b, slope_a, apply(Op::step, {a, b}));
    }
    ExprId of_maximum(ExprId a, ExprId b, ExprId slope_a, ExprId slope_b)
    {
        return blend(slope_b, slope_a, apply(Op::step, {b, a}));
    }

    ExprId of_power(ExprId x, ExprId y, ExprId dx, ExprId dy)
    {
        if (graph_[y].op == Op::literal) {
            const double exponent = graph_.literal_of(y).value;
            if (exponent == 0) return {};
            if (exponent == 1) return dx;
            const bool whole = graph_.literal_of(y).text.find_first_of(".epi") == std::string::npos;
            if (whole && dx.valid()) {
                const ExprId less = graph_.literal(exponent - 1);
                return times(apply(Op::multiply, {y, apply(Op::power, {x, less})}), dx);
            }
        }
        // Rises with x where y > 0; rises with y where x > 1. By how much depends on both.
        const ExprId by_base = rising(times(y, dx));
        const ExprId by_exponent = rising(times(apply(Op::subtract, {x, literal("1")}), dy));
        return plus(by_base, by_exponent);
    }

    ExprId of_select(ExprId condition, ExprId dx, ExprId then_slope, ExprId else_slope)
    {
        ExprId slope;
        if (then_slope.valid() || else_slope.valid())
            slope = apply(Op::select, {condition, or_zero(then_slope), or_zero(else_slope)});
        if (!dx.valid()) return slope;
        // Where the box leaves the condition open the value may jump: t (1 - t) of a t in [0, 1] is
        // not 0 there, and is 0 where t is exactly 0 or 1.
        const ExprId t = apply(Op::select, {condition, literal("1"), literal("0")});
        const ExprId open = apply(Op::multiply, {t, apply(Op::subtract, {literal("1"), t})});
        return plus(slope, apply(Op::multiply, {any_, open}));
    }

    ExprId slope_of(ExprId id)
    {
        const ir::Expr expr = graph_[id];
        std::array<ExprId, 3> x{};
        std::array<ExprId, 3> d{};
        const auto operands = graph_.operands(id);
        std::vector<ExprId> all(operands.begin(), operands.end());
        bool depends = expr.op == Op::input;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i < 3) x[i] = all[i];
            if (i < 3) d[i] = slopes_[all[i].index];
            depends = depends || slopes_[all[i].index].valid();
        }
        if (!depends) return {};

        switch (expr.op) {
        case Op::literal: return {};
        case Op::input: return seed(expr);
        case Op::negate: return minus(d[0]);
        case Op::absolute: return times(apply(Op::sign, {x[0]}), d[0]);
        case Op::sign:
        case Op::floor:
        case Op::tangent:
        case Op::arc_sine: return rising(d[0]);
        case Op::arc_cosine: return minus(rising(d[0]));
        case Op::square_root:
            return times(
                apply(Op::multiply, {literal("0.5"), apply(Op::inverse_square_root, {x[0]})}),
                d[0]);
        case Op::inverse_square_root: return minus(rising(d[0]));
        case Op::exp: return times(id, d[0]);
        case Op::exp2:
            return times(apply(Op::multiply, {literal("0.69314718055994531"), id}), d[0]);
        case Op::log: return apply(Op::divide, {d[0], x[0]});
        case Op::log2: return times(literal("1.4426950408889634"), apply(Op::divide, {d[0], x[0]}));
        case Op::sine: return times(apply(Op::cosine, {x[0]}), d[0]);
        case Op::cosine: return minus(times(apply(Op::sine, {x[0]}), d[0]));
        case Op::arc_tangent:
            return apply(Op::divide, {d[0], apply(Op::add, {literal("1"), square(x[0])})});
        case Op::saturate:
            return times(apply(Op::multiply, {apply(Op::step, {literal("0"), x[0]}),
                                              apply(Op::step, {x[0], literal("1")})}),
                         d[0]);
        case Op::add: return plus(d[0], d[1]);
        case Op::subtract: return minus(d[0], d[1]);
        case Op::multiply: return plus(times(x[1], d[0]), times(x[0], d[1]));
        case Op::divide:
            // (a / b)' = (a' - (a / b) b') / b
            return apply(Op::divide, {or_zero(minus(d[0], times(id, d[1]))), x[1]});
        case Op::power:
        case Op::guarded_power: return of_power(x[0], x[1], d[0], d[1]);
        case Op::minimum: return of_minimum(x[0], x[1], d[0], d[1]);
        case Op::maximum: return of_maximum(x[0], x[1], d[0], d[1]);
        case Op::clamp: {
            const ExprId raised = apply(Op::maximum, {x[0], x[1]});
            return of_minimum(raised, x[2], of_maximum(x[0], x[1], d[0], d[1]), d[2]);
        }
        case Op::step: return rising(minus(d[1], d[0]));
        case Op::lerp:
            return plus(blend(d[0], d[1], x[2]), times(apply(Op::subtract, {x[1], x[0]}), d[2]));
        case Op::smoothstep:
        case Op::guarded_smoothstep:
            // Rises with x, falls with either edge.
            return minus(minus(rising(d[2]), rising(d[0])), rising(d[1]));
        case Op::less:
        case Op::less_equal:
        case Op::equal:
        case Op::not_equal:
        case Op::logical_and:
        case Op::logical_or:
        case Op::logical_not: return any_;  // that it depends is all that matters
        case Op::select: return of_select(x[0], d[0], d[1], d[2]);
        case Op::dot: return plus(dot(d[0], x[1]), dot(x[0], d[1]));
        case Op::length: return apply(Op::divide, {dot(x[0], d[0]), id});
        case Op::cross: return plus(cross(d[0], x[1]), cross(x[0], d[1]));
        case Op::normalize:
        case Op::guarded_normalize: return any_;
        case Op::component: return graph_.component(d[0], static_cast<int>(expr.aux));
        case Op::construct: {
            std::vector<ExprId> slopes;
            for (const ExprId operand : all) slopes.push_back(or_zero(slopes_[operand.index]));
            return graph_.construct(expr.type, slopes);
        }
        case Op::call: return any_;
        }
        return any_;
    }

    ExprId seed(const ir::Expr& expr)
    {
        if (expr.aux != with_.input) return {};
        if (expr.type == Type::boolean) return any_;
        if (expr.type == Type::scalar) return literal("1");
        std::vector<ExprId> unit(static_cast<std::size_t>(ir::components(expr.type)), literal("0"));
        unit[static_cast<std::size_t>(with_.component)] = literal("1");
        return graph_.construct(expr.type, unit);
    }
    ExprId square(ExprId x) { return apply(Op::multiply, {x, x}); }
    ExprId dot(ExprId a, ExprId b)
    {
        return a.valid() && b.valid() ? apply(Op::dot, {a, b}) : ExprId{};
    }
    ExprId cross(ExprId a, ExprId b)
    {
        return a.valid() && b.valid() ? apply(Op::cross, {a, b}) : ExprId{};
    }

    Graph& graph_;
    ScalarInput with_;
    ExprId rising_;
    ExprId any_;
    std::vector<ExprId> slopes_;
};

}  // namespace

Flat differentiate(const Flat& flat, ExprId subject, const std::vector<ScalarInput>& wanted)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Flat result;
    result.function = flat.function;
    const auto add = [&](const char* name, double low) {
        const auto index = static_cast<std::uint32_t>(result.function.inputs.size());
        result.function.inputs.push_back({name,
                                          Type::scalar,
                                          ir::Quantity::number,
                                          {low, infinity},
                                          ir::Origin::argument,
                                          index,
                                          {}});
        return index;
    };
    const std::uint32_t rising = add("rising", 0);
    const std::uint32_t any = add("any", -infinity);
    for (const ScalarInput& input : wanted)
        result.roots.push_back(Sweep{result.function.graph, rising, any, input}.run(subject));
    return result;
}

}  // namespace lobe::check
