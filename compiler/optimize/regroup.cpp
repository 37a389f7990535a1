// Products of vectors and scalars, scalars first; see optimize.h.
//
//     v a b              ->  v (a b)
//     v / c a            ->  v (a / c)
//     c ? v a : 0        ->  v (c ? a : 0)           where c asks for a > 0, without that
//     lerp(1, v a, t)    ->  (1 - t) + v (a t)       exactly 1 at t = 0, v a at t = 1
//     lerp(1, b, t)      ->  b + (1 - t)(1 - b)      b scalar, t vector; 1 at t = 0, b at t = 1
//     x + (1 - x) a      ->  x (1 - a) + a           exactly x at a = 0, 1 at a = 1 or x = 1
//
// A vector operation is three scalar ones on every target, and each rounds. No sum on the right
// subtracts what the left one did not: in the last two lines t and a are in [0, 1]. A product that
// could leave the range of float where the written one did not is left alone.
#include "evaluate/run.h"
#include "optimize/explain.h"
#include "optimize/literal.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

/// A product of old expressions: vectors times scalars over scalars.
struct Product {
    std::vector<ExprId> vectors;
    std::vector<ExprId> scalars;
    std::vector<ExprId> divisors;
    int operations = 0;  ///< that it took, on components
};

class Regroup {
public:
    Regroup(Rebuild& rebuild, Notes notes)
        : rebuild_{rebuild}, notes_{notes}, old_{rebuild.old().graph}, uses_{use_counts(
                                                                           old_,
                                                                           rebuild.old().result)},
          absorbed_(old_.size()), ranges_{
                                      evaluate::ranges(rebuild.old_module(), rebuild.old(),
                                                       evaluate::declared_ranges(rebuild.old()))}
    {
        for (const ExprId id : old_.ids()) {
            const Op op = old_[id].op;
            if (uses_[id] == 0 || !is_vector(id)) continue;
            if (op != Op::multiply && op != Op::divide) continue;
            for (const ExprId operand : old_.operands(id))
                if (uses_[operand] == 1 &&
                    (old_[operand].op == Op::multiply || old_[operand].op == Op::divide))
                    absorbed_[operand] = op == Op::multiply || operand == old_.operands(id)[0];
        }
    }

    ExprId step(ExprId id)
    {
        if (uses_[id] == 0 || absorbed_[id] || components(old_[id].type) < 2)
            return rebuild_.copy(id);
        std::optional<ExprId> better;
        switch (old_[id].op) {
        case Op::multiply:
        case Op::divide: better = product(id); break;
        case Op::select: better = gate(id); break;
        case Op::lerp:
            better = lerp_from_one(id);
            if (!better) better = lerp_to_scalar(id);
            break;
        case Op::add: better = towards_one(id); break;
        default: break;
        }
        return better ? *better : rebuild_.copy(id);
    }

private:
    Graph& graph() { return rebuild_.graph; }
    void note(std::string_view name, ExprId id) { notes_.add(name, rebuild_.id(), old_.span(id)); }
    ExprId moved(ExprId old_id) const { return rebuild_.moved(old_id); }
    bool is_vector(ExprId id) const { return components(old_[id].type) > 1; }

    /// The scalar that a vector is spread from, or the scalar itself.
    std::optional<ExprId> scalar_of(ExprId id) const
    {
        const ExprId scalar = spread_of(old_, id);
        return is_vector(scalar) ? std::nullopt : std::optional{scalar};
    }

    void collect(ExprId id, bool is_root, Product& into) const
    {
        if (const auto scalar = scalar_of(id)) {
            into.scalars.push_back(*scalar);
            return;
        }
        const auto operands = old_.operands(id);
        const bool own = is_root || uses_[id] == 1;
        if (own && old_[id].op == Op::multiply) {
            into.operations += components(old_[id].type);
            for (const ExprId operand : operands) collect(operand, false, into);
        } else if (own && old_[id].op == Op::divide && scalar_of(operands[1]) &&
                   is_safe_divisor(*scalar_of(operands[1]))) {
            into.operations += components(old_[id].type);
            collect(operands[0], false, into);
            into.divisors.push_back(*scalar_of(operands[1]));
        } else {
            into.vectors.push_back(id);
        }
    }

    bool is_safe_divisor(ExprId id) const
    {
        return ranges_[id].low >= least_divisor || ranges_[id].high <= -least_divisor;
    }

    /// The scalars multiply to something that float holds, in whatever order.
    bool is_tame(const std::vector<ExprId>& scalars, const std::vector<ExprId>& divisors) const
    {
        constexpr double largest = 0x1p120;
        double product = 1;
        for (const ExprId id : scalars) {
            const double size = std::max(std::fabs(ranges_[id].low), std::fabs(ranges_[id].high));
            product *= std::max(size, 1.0);
        }
        for (const ExprId id : divisors) {
            const double size = std::min(std::fabs(ranges_[id].low), std::fabs(ranges_[id].high));
            product /= std::min(size, 1.0);
        }
        return product <= largest;
    }

    /// Bounded, and so not what makes a tiny product of scalars large again.
    bool is_bounded(ExprId id) const
    {
        constexpr double largest = 0x1p20;
        return ranges_[id].low >= -largest && ranges_[id].high <= largest;
    }

    bool is_regroupable(const Product& product) const
    {
        return !product.vectors.empty() && !product.scalars.empty() &&
               is_tame(product.scalars, product.divisors) &&
               std::ranges::all_of(product.vectors, [&](ExprId id) { return is_bounded(id); });
    }

    ExprId all(const std::vector<ExprId>& factors, Span span)
    {
        ExprId result = moved(factors[0]);
        for (std::size_t i = 1; i < factors.size(); ++i)
            result = graph().apply(Op::multiply, {result, moved(factors[i])}, span);
        return result;
    }

    /// The scalars, over the divisors.
    ExprId scale(const Product& product, Span span)
    {
        ExprId result = all(product.scalars, span);
        for (const ExprId divisor : product.divisors)
            result = graph().apply(Op::divide, {result, moved(divisor)}, span);
        return result;
    }

    ExprId times(const Product& product, ExprId scalar, Span span)
    {
        return graph().apply(Op::multiply, {all(product.vectors, span), scalar}, span);
    }

    std::optional<ExprId> product(ExprId id)
    {
        Product parts;
        collect(id, true, parts);
        if (!is_regroupable(parts)) return std::nullopt;
        const int width = components(old_[id].type);
        const auto count = [](const std::vector<ExprId>& list) {
            return static_cast<int>(list.size());
        };
        const int operations =
            count(parts.vectors) * width + count(parts.scalars) - 1 + count(parts.divisors);
        if (operations >= parts.operations) return std::nullopt;
        note("scalars_first", id);
        return times(parts, scale(parts, old_.span(id)), old_.span(id));
    }

    std::optional<ExprId> gate(ExprId id)
    {
        const auto operands = old_.operands(id);
        for (const bool first : {true, false}) {
            const ExprId kept = operands[first ? 1 : 2];
            if (exact_literal(old_, operands[first ? 2 : 1]) != 0 || uses_[kept] != 1) continue;
            Product parts;
            collect(kept, true, parts);
            if (!is_regroupable(parts)) return std::nullopt;
            const Span span = old_.span(id);
            const ExprId scalar = scale(parts, old_.span(kept));
            const ExprId zero = graph().literal("0", span);
            note("gated_scalar", id);
            if (!first)
                return times(parts,
                             graph().apply(Op::select, {moved(operands[0]), zero, scalar}, span),
                             span);
            const auto condition = needed(operands[0], parts);
            if (!condition) return times(parts, scalar, span);
            return times(parts, graph().apply(Op::select, {*condition, scalar, zero}, span), span);
        }
        return std::nullopt;
    }

    /// What is left of a condition when `x > 0` goes for a factor x that is never negative: where
    /// it does not hold the product is 0 anyway.
    std::optional<ExprId> needed(ExprId condition, const Product& product)
    {
        const auto operands = old_.operands(condition);
        if (old_[condition].op == Op::less && exact_literal(old_, operands[0]) == 0 &&
            std::ranges::find(product.scalars, operands[1]) != product.scalars.end() &&
            ranges_[operands[1]].low >= 0)
            return std::nullopt;
        if (old_[condition].op != Op::logical_and) return moved(condition);
        const auto left = needed(operands[0], product);
        const auto right = needed(operands[1], product);
        if (!left) return right;
        if (!right) return left;
        return graph().apply(Op::logical_and, {*left, *right}, old_.span(condition));
    }

    /// In [0, 1], but for what a device's power may add to 1.
    bool is_share(ExprId id) const
    {
        return ranges_[id].low >= 0 && ranges_[id].high <= 1 + 0x1p-10;
    }

    std::optional<ExprId> lerp_from_one(ExprId id)
    {
        const auto operands = old_.operands(id);
        const auto share = scalar_of(operands[2]);
        if (exact_literal(old_, operands[0]) != 1 || !share || !is_share(*share) ||
            uses_[operands[1]] != 1)
            return std::nullopt;
        Product parts;
        collect(operands[1], true, parts);
        if (!is_regroupable(parts)) return std::nullopt;
        const Span span = old_.span(id);
        const ExprId rest =
            graph().apply(Op::subtract, {graph().literal("1", span), moved(*share)}, span);
        const ExprId scalar =
            graph().apply(Op::multiply, {scale(parts, span), moved(*share)}, span);
        note("blend_from_one", id);
        return graph().apply(Op::add, {rest, times(parts, scalar, span)}, span);
    }

    std::optional<ExprId> lerp_to_scalar(ExprId id)
    {
        const auto operands = old_.operands(id);
        const auto end = scalar_of(operands[1]);
        if (exact_literal(old_, operands[0]) != 1 || !end || !is_share(*end) ||
            scalar_of(operands[2]))
            return std::nullopt;
        const Span span = old_.span(id);
        const auto one_minus = [&](ExprId x) {
            return graph().apply(Op::subtract, {graph().literal("1", span), x}, span);
        };
        const ExprId rest = graph().apply(
            Op::multiply, {one_minus(moved(operands[2])), one_minus(moved(*end))}, span);
        note("blend_to_scalar", id);
        return graph().apply(Op::add, {moved(*end), rest}, span);
    }

    std::optional<ExprId> towards_one(ExprId id)
    {
        const auto operands = old_.operands(id);
        for (const std::size_t i : {0U, 1U}) {
            const ExprId x = operands[i];
            const ExprId other = operands[1 - i];
            if (!is_vector(x) || scalar_of(x) || uses_[other] != 1) continue;
            Product parts;
            collect(other, true, parts);
            if (parts.vectors.size() != 1 || !parts.divisors.empty() || parts.scalars.empty() ||
                !is_one_minus(parts.vectors[0], x) ||
                !std::ranges::all_of(parts.scalars, [&](ExprId s) { return is_share(s); }))
                continue;
            const Span span = old_.span(id);
            const ExprId share = scale(parts, span);
            const ExprId rest =
                graph().apply(Op::subtract, {graph().literal("1", span), share}, span);
            const ExprId kept = graph().apply(Op::multiply, {moved(x), rest}, span);
            note("blend_to_one", id);
            return graph().apply(Op::add, {kept, share}, span);
        }
        return std::nullopt;
    }

    bool is_one_minus(ExprId id, ExprId x) const
    {
        const auto operands = old_.operands(id);
        return old_[id].op == Op::subtract && exact_literal(old_, operands[0]) == 1 &&
               operands[1] == x;
    }

    Rebuild& rebuild_;
    Notes notes_;
    const Graph& old_;
    Facts<Expr, int> uses_;
    Facts<Expr, bool> absorbed_;  ///< part of a product that is taken apart as a whole
    Facts<Expr, Interval> ranges_;
};

}  // namespace

Module regroup(const Module& module, const Notes& notes)
{
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        const Graph& old = rebuild.old().graph;
        const auto is_candidate = [&](ExprId id) {
            const Op op = old[id].op;
            return components(old[id].type) > 1 &&
                   (op == Op::multiply || op == Op::divide || op == Op::select || op == Op::lerp ||
                    op == Op::add);
        };
        if (!any_expression(old, is_candidate)) return {};
        const auto regrouping = std::make_shared<Regroup>(rebuild, notes);
        return [regrouping](ExprId id) { return regrouping->step(id); };
    });
}

Module regroup(const Module& module) { return regroup(module, {}); }

}  // namespace lobe::optimize
