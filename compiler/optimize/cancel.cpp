// Quotients that meet their divisor again, roots that meet themselves, and angles that are made
// only to be undone; explain.cpp has the table of names.
//
// Each of these is the same function over the real numbers, for every argument at which the written
// one has a value, and removes a rounding and the place where an intermediate result leaves the
// range of float. So no measurement has to decide: none of them can lose. A sum is multiplied out
// only where its terms have one sign, or where the quotient is the greater hazard.
#include "evaluate/run.h"
#include "optimize/explain.h"
#include "optimize/guard.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <memory>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

class Cancel {
public:
    Cancel(Rebuild& rebuild, Notes notes)
        : rebuild_{rebuild}, notes_{notes}, old_{rebuild.old().graph}, uses_{use_counts(
                                                                           old_,
                                                                           rebuild.old().result)},
          ranges_{evaluate::ranges(rebuild.old_module(), rebuild.old(),
                                   evaluate::declared_ranges(rebuild.old()))}
    {
    }

    ExprId step(ExprId id)
    {
        if (uses_[id] == 0) return rebuild_.copy(id);
        std::optional<ExprId> better;
        switch (old_[id].op) {
        case Op::multiply: better = product(id); break;
        case Op::divide: better = quotient(id); break;
        case Op::sine: better = of_angle(id, Op::arc_sine, Op::arc_cosine); break;
        case Op::cosine: better = of_angle(id, Op::arc_cosine, Op::arc_sine); break;
        default: break;
        }
        return better ? *better : rebuild_.copy(id);
    }

private:
    Graph& graph() { return rebuild_.graph; }
    ExprId apply(Op op, std::initializer_list<ExprId> operands)
    {
        return graph().apply(op, operands, span_);
    }
    ExprId moved(ExprId old_id) const { return rebuild_.moved(old_id); }
    ExprId operand(ExprId id, std::size_t i) const { return old_.operands(id)[i]; }
    void note(std::string_view name) { notes_.add(name, rebuild_.id(), span_); }

    std::optional<ExprId> product(ExprId id)
    {
        span_ = old_.span(id);
        const ExprId a = operand(id, 0);
        const ExprId b = operand(id, 1);
        if (a == b && old_[a].op == Op::square_root && ranges_[operand(a, 0)].low >= 0) {
            note("square_of_root");
            return moved(operand(a, 0));
        }
        if (old_[a].type != old_[b].type) return std::nullopt;
        if (meets(a, b) && gains(a, b)) return named_times(a, b);
        if (meets(b, a) && gains(b, a)) return named_times(b, a);
        return std::nullopt;
    }

    /// A sum that may cancel is multiplied out only where the quotient is the greater hazard: where
    /// the divisor comes near to 0.
    bool gains(ExprId id, ExprId x) const
    {
        constexpr double near_zero = 0x1p-10;
        if (old_[id].op == Op::negate) return gains(operand(id, 0), x);
        if (old_[id].op != Op::add && old_[id].op != Op::subtract) return true;
        if (ranges_[x].low < near_zero && ranges_[x].high > -near_zero) return true;
        const Interval a = ranges_[operand(id, 0)];
        const Interval b = ranges_[operand(id, 1)];
        const bool alike = (a.low >= 0 && b.low >= 0) || (a.high <= 0 && b.high <= 0);
        const bool unlike = (a.low >= 0 && b.high <= 0) || (a.high <= 0 && b.low >= 0);
        return old_[id].op == Op::add ? alike : unlike;
    }

    /// True for a quotient by x that nothing else uses, or a sum with one: x times it is simpler.
    bool meets(ExprId id, ExprId x) const
    {
        if (uses_[id] != 1) return false;
        switch (old_[id].op) {
        case Op::divide: return operand(id, 1) == x;
        case Op::select: {
            const auto guard = find_guard(old_, id);
            return guard && uses_[guard->quotient] == 1 && operand(guard->quotient, 1) == x;
        }
        case Op::add:
        case Op::subtract:
            return old_[operand(id, 0)].type == old_[operand(id, 1)].type &&
                   (meets(operand(id, 0), x) || meets(operand(id, 1), x));
        case Op::negate: return meets(operand(id, 0), x);
        default: return false;
        }
    }

    ExprId named_times(ExprId id, ExprId x)
    {
        note(old_[id].op == Op::divide   ? "quotient_times_divisor"
             : old_[id].op == Op::select ? "limit_times_divisor"
                                         : "premultiplied_sum");
        return times(id, x);
    }

    ExprId times(ExprId id, ExprId x)
    {
        if (!meets(id, x)) return apply(Op::multiply, {moved(id), moved(x)});
        switch (old_[id].op) {
        case Op::divide: return moved(operand(id, 0));
        case Op::select: {
            const DivisionGuard guard = *find_guard(old_, id);
            return apply(Op::select, {moved(operand(id, 0)), moved(operand(guard.quotient, 0)),
                                      apply(Op::multiply, {moved(guard.limit), moved(x)})});
        }
        case Op::negate: return apply(Op::negate, {times(operand(id, 0), x)});
        default: break;
        }
        const ExprId left = times(operand(id, 0), x);
        return apply(old_[id].op, {left, times(operand(id, 1), x)});
    }

    std::optional<ExprId> quotient(ExprId id)
    {
        span_ = old_.span(id);
        const ExprId x = operand(id, 0);
        const ExprId root = operand(id, 1);
        // A division without a limit has a divisor that is not 0.
        if (old_[root].op != Op::square_root || operand(root, 0) != x || !(ranges_[x].low > 0))
            return std::nullopt;
        note("quotient_by_root");
        return moved(root);
    }

    /// sin or cos of its own inverse, or of the other one's.
    std::optional<ExprId> of_angle(ExprId id, Op inverse, Op other)
    {
        span_ = old_.span(id);
        const ExprId angle = operand(id, 0);
        if (old_[angle].op != inverse && old_[angle].op != other) return std::nullopt;
        const ExprId x = moved(operand(angle, 0));
        const Interval& range = ranges_[operand(angle, 0)];
        if (range.low < -1 || range.high > 1) return std::nullopt;
        if (old_[angle].op == inverse) {
            note("cosine_of_angle");
            return x;
        }
        note("sine_of_angle");
        ExprId one = graph().literal("1", span_);
        if (graph()[x].type != Type::scalar) one = graph().construct(graph()[x].type, {&one, 1});
        return apply(Op::square_root, {apply(Op::multiply, {apply(Op::subtract, {one, x}),
                                                            apply(Op::add, {one, x})})});
    }

    Rebuild& rebuild_;
    Notes notes_;
    const Graph& old_;
    Facts<Expr, int> uses_;
    Facts<Expr, Interval> ranges_;
    Span span_;
};

bool is_candidate(Op op)
{
    return op == Op::divide || op == Op::square_root || op == Op::arc_sine || op == Op::arc_cosine;
}

}  // namespace

Module cancel(const Module& module, const Notes& notes)
{
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        const Graph& old = rebuild.old().graph;
        if (!any_expression(old, [&](ExprId id) { return is_candidate(old[id].op); })) return {};
        const auto cancelling = std::make_shared<Cancel>(rebuild, notes);
        return [cancelling](ExprId id) { return cancelling->step(id); };
    });
}

Module cancel(const Module& module) { return cancel(module, {}); }

}  // namespace lobe::optimize
