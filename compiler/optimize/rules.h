// The cancellations that stabilize removes, each with a name.
//
// All are one observation about a sum in which a quantity x in reach of 1 occurs in one power
// only: with s = 1 - x^d,
//
//     P + Q x^d  =  (P + Q) - Q s.
//
// Where P and Q have opposite signs the left side subtracts near x = 1. Where in (P + Q) terms
// cancel on paper and what is left has the sign of -Q, the right side only adds: its relative
// error is that of its parts. So all depends on having s without a subtraction:
//
//     x = cos_h, d = 2    sin2_h             Lagrange's identity, from the vectors
//     x = cos_h, d = 1    one_minus_cos_h    the same over 1 + cos_h
//     x = cos_d, d = 1    one_minus_cos_d    half angles, from the vectors
//     x = cos_d, d = 2    one_minus_cos_d (1 + cos_d)
//     x = v_dot_l, d = 1  2 one_minus_cos_d (1 + cos_d); and 1 + x is 2 cos_d^2
//     x an argument       one_minus_<x>, when a caller has it (see complement.h)
//     x = 1 - y           y (1 + x), y (1 + x + x^2): nothing is left to subtract
//     x anything, d = 2   (1 - x)(1 + x): the subtraction is exact where it cancels, only the
//                         rounding of x^2 before it was not
//
// A scalar x cannot repair its own rounding: float cos_h near 1 knows sin^2 to 6e-8 absolutely,
// and D_GGX at alpha = 0.001 needs it to 1e-7 of 1e-6. That is why the fields exist.
#pragma once

#include "evaluate/interval.h"
#include "ir/module.h"
#include "optimize/sum.h"

#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

namespace lobe::optimize {

/// What 1 - x^d is made from.
enum class Source : std::uint8_t {
    cos_h,
    cos_d,
    v_dot_l,  ///< at both ends of [-1, 1]
    argument,
    complement,  ///< x is written 1 - y
    factored
};

/// Where a replacement may look: what the function has anyway, or also what its callers can make
/// from the vectors, and companions of its arguments.
enum class Inputs : std::uint8_t {
    given,
    from_vectors
};

/// One named rule.
struct Rule {
    std::string_view name;
    Source source{};
    int degree = 0;      ///< of x; 0 for any
    bool blend = false;  ///< something is left beside the multiple of 1 - x^d
    std::string_view pattern;
    std::string_view replacement;
    std::string_view reason;
};

std::span<const Rule> rules();

/// A rule that fits an expression of a function, and the parts to build the replacement from:
/// rest + slope * (1 - variable^degree), or (1 + variable) where it is `mirrored`.
struct Match {
    const Rule* rule = nullptr;
    ir::ExprId variable;
    int degree = 0;
    Sum rest;
    Sum slope;
    bool mirrored = false;
};

/// Everything known about a function before its rules are looked for.
struct Subject {
    const ir::Function* function = nullptr;
    Facts<ir::Expr, Sum> sums;
    Facts<ir::Expr, evaluate::Interval> ranges;  ///< none where there is no sum of two or more
    std::vector<bool> complemented;  ///< by input: an argument whose complement is to be had
    Inputs inputs{};
    /// Stable fields of the geometry that are computed anyway. They stand for 1 - x also where its
    /// cancellation shows nowhere: a subtraction less, and often an x that nothing else reads.
    std::set<ir::GeometryField> at_hand{};
};
Subject subject(const ir::Module& module, const ir::Function& function,
                std::vector<bool> complemented, Inputs inputs = Inputs::from_vectors);

/// The rule for every expression that one fits. A product of sums counts as a sum.
using Matches = Facts<ir::Expr, std::optional<Match>>;
Matches match_rules(const Subject& subject);

}  // namespace lobe::optimize
