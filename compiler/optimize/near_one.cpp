// Powers of what is near 1, with exponents that are large: (1 - x)^y as 2^(y log2(1 - x)) with a
// logarithm that knows x.
//
// Blinn's lobe raises cos_h to up to 2^25. A float cosine near 1 is off by 2^-25, so its power by a
// factor of up to e, and a target's logarithm may be off by 2^-21 there ([VulkanSpec] "Precision
// and Operation of SPIR-V Instructions"), which makes a factor of e^11 of it. For x below 1/16 the
// logarithm is x times a polynomial, which has the relative error of x; above it the written one
// does. Where ranges keep y below 2^9 the power is left alone: there what 1 - x lost weighs no more
// than the 2^-23 (3 + 2 |y log2(1 - x)|) that any exponential may be off by.
//
// Over the real numbers the logarithm is another one by less than 2^-31 of itself: a change of
// y log2(1 - x) by 2^-24 where the power is as small as a float can be.
#include "evaluate/run.h"
#include "optimize/complement.h"
#include "optimize/explain.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <array>
#include <cmath>
#include <memory>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

constexpr double large_exponent = 0x1p9;

/// -log2(1 - x) / x for x in [0, 1/16], to a relative 2^-31.3: Remez' algorithm for the relative
/// error, the coefficients rounded to twelve digits.
constexpr const char* end_of_polynomial = "0.0625";
constexpr std::array coefficients{"1.44269504141", "0.721347106882", "0.480950838435",
                                  "0.358356024051", "0.329689472919"};

class NearOne {
public:
    NearOne(Rebuild& rebuild, const Notes& notes)
        : rebuild_{rebuild}, notes_{notes}, old_{rebuild.old().graph}, uses_{use_counts(
                                                                           old_,
                                                                           rebuild.old().result)},
          ranges_{evaluate::ranges(rebuild.old_module(), rebuild.old(),
                                   evaluate::declared_ranges(rebuild.old()))}
    {
    }

    ExprId step(ExprId id)
    {
        if (!is_large_power(id)) return rebuild_.copy(id);
        const ExprId base = old_.operands(id)[0];
        const auto x = complement(base);
        if (!x) return rebuild_.copy(id);
        span_ = old_.span(id);
        notes_.add("power_near_one", rebuild_.id(), span_);
        const ExprId exponent = rebuild_.moved(old_.operands(id)[1]);
        return apply(Op::exp2, {apply(Op::multiply, {exponent, logarithm(*x, base)})});
    }

private:
    Graph& graph() { return rebuild_.graph; }
    ExprId apply(Op op, std::initializer_list<ExprId> operands)
    {
        return graph().apply(op, operands, span_);
    }

    bool is_large_power(ExprId id) const
    {
        const Op op = old_[id].op;
        if (op != Op::power && op != Op::guarded_power) return false;
        if (uses_[id] == 0 || old_[id].type != Type::scalar) return false;
        const Interval& exponent = ranges_[old_.operands(id)[1]];
        return exponent.high > large_exponent || exponent.low < -large_exponent;
    }

    /// One minus the base, where the function can have it without a subtraction.
    std::optional<ExprId> complement(ExprId base)
    {
        if (!(ranges_[base].low >= 0 && ranges_[base].high <= 1)) return std::nullopt;
        if (const auto x = one_minus(old_, base)) return rebuild_.moved(*x);
        if (old_[base].op != Op::input) return std::nullopt;
        const auto field = stable_field(rebuild_.old().inputs[old_[base].aux]);
        return field ? std::optional{rebuild_.input(*field)} : std::nullopt;
    }

    /// log2(1 - x), where 1 - x is the base.
    ExprId logarithm(ExprId x, ExprId base)
    {
        ExprId sum = graph().literal(coefficients.back());
        for (std::size_t i = coefficients.size() - 1; i-- > 0;)
            sum = apply(Op::add, {graph().literal(coefficients[i]), apply(Op::multiply, {x, sum})});
        const ExprId near = apply(Op::negate, {apply(Op::multiply, {x, sum})});
        const ExprId far = apply(Op::log2, {rebuild_.moved(base)});
        const ExprId result = apply(
            Op::select, {apply(Op::less, {x, graph().literal(end_of_polynomial)}), near, far});
        graph().set_name(result, "logarithm");
        return result;
    }

    Rebuild& rebuild_;
    Notes notes_;
    const Graph& old_;
    Facts<Expr, int> uses_;
    Facts<Expr, Interval> ranges_;
    Span span_;
};

}  // namespace

Module near_one(const Module& module, const Notes& notes)
{
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        const Graph& old = rebuild.old().graph;
        const auto is_power = [&](ExprId id) {
            return old[id].op == Op::power || old[id].op == Op::guarded_power;
        };
        if (!any_expression(old, is_power)) return {};
        const auto sharpening = std::make_shared<NearOne>(rebuild, notes);
        return [sharpening](ExprId id) { return sharpening->step(id); };
    });
}

Module near_one(const Module& module) { return near_one(module, {}); }

}  // namespace lobe::optimize
