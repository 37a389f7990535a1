// The promise `legal`: what emit may rely on.
#pragma once

#include "evaluate/interval.h"
#include "ir/module.h"

#include <optional>
#include <string>

namespace lobe::optimize {

/// The first place where a reachable function could leave the domain of a bare operation over its
/// declared input ranges, in words; nothing when there is none. Legal means:
///
///   power                base > 0, or base >= 0 and exponent > 0; the exponent is no literal
///                        that products and square roots can spell
///   smoothstep           edge0 < edge1
///   normalize            the vector is not 0
///   divide               the divisor is not 0, or the division is the arm of a select that
///                        its divisor's being 0 does not take
///   square_root          argument >= 0
///   inverse_square_root  argument > 0
///   log, log2            argument > 0
///   arc_sine, arc_cosine argument in [-1, 1]
///
/// "Is" means: by the ranges of evaluate, which hold for float32 evaluation too.
std::optional<std::string> illegal(const ir::Module& module);

/// The whole-number or half-number exponent that products and square roots spell: the double of
/// it. Nothing for other exponents.
std::optional<int> spelled_halves(const ir::Graph& graph, ir::ExprId exponent,
                                  const evaluate::Interval& base);

/// True when a power needs no guard.
bool is_safe_power(const evaluate::Interval& base, const evaluate::Interval& exponent);

/// True when a vector whose components have this hull, or that is this input, is not 0.
bool is_not_zero(const ir::Function& function, ir::ExprId vector, const evaluate::Interval& hull);

}  // namespace lobe::optimize
