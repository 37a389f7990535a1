// Scalar expressions as sums of products, which is where cancellation can be seen.
//
// `cos_h^2 * (alpha^2 - 1) + 1` is alpha^2 cos_h^2 - cos_h^2 + 1 however it is spelt. Expansion
// is only a way of looking: nothing is evaluated in expanded form.
#pragma once

#include "evaluate/interval.h"
#include "ir/graph.h"

#include <optional>
#include <tuple>
#include <vector>

namespace lobe::optimize {

/// coefficient * product of factors. Factors are sorted; a square lists its base twice.
struct Monomial {
    double coefficient = 1;
    std::vector<ir::ExprId> factors;

    friend bool operator==(const Monomial&, const Monomial&) = default;
    friend bool operator<(const Monomial& a, const Monomial& b)
    {
        return std::tie(a.factors, a.coefficient) < std::tie(b.factors, b.coefficient);
    }
};

/// Sorted by factors, no two monomials alike, no zero coefficients. Empty is zero.
using Sum = std::vector<Monomial>;

/// Every expression of a graph as a sum of products of other expressions of it. What is no sum,
/// product, lerp or small power of one factor is a factor itself, and so is what would expand to
/// more than eight monomials.
Facts<ir::Expr, Sum> expand_sums(const ir::Graph& graph);

/// sum = constant + slope_of_power * variable^degree, when the variable occurs in no other power.
struct Split {
    Sum constant;
    Sum slope;
};
std::optional<Split> split(const Sum& sum, ir::ExprId variable, int degree);

Sum add(const Sum& a, const Sum& b);
Sum negate(const Sum& sum);
/// Bounds of a sum when its factors lie in these ranges.
evaluate::Interval bounds(const Sum& sum, const Facts<ir::Expr, evaluate::Interval>& ranges);

}  // namespace lobe::optimize
