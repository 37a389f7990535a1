#include "optimize/explain.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace lobe::optimize {

namespace {

using Kind = Action::Kind;

constexpr std::array action_table{
    // cancel.cpp
    Action{"quotient_times_divisor", Kind::rewrite, "(a / x) x", "a",
           "the quotient may overflow or round where the product does neither"},
    Action{"premultiplied_sum", Kind::rewrite, "(a + b / x) x", "a x + b",
           "Proxima's 0.19 / n.l, then times n.l: the quotient overflows half below 3e-6, and "
           "infinity times 0 is NaN"},
    Action{"limit_times_divisor", Kind::rewrite, "(a / x else c) x", "a where x divides, else c x",
           "as quotient_times_divisor; the limit counts where it did"},
    Action{"square_of_root", Kind::rewrite, "sqrt(x) sqrt(x)", "x", "three roundings less"},
    Action{"quotient_by_root", Kind::rewrite, "x / sqrt(x)", "sqrt(x)",
           "a root is right to half a unit; the quotient divides two numbers that both fall to 0"},
    Action{"cosine_of_angle", Kind::rewrite, "cos(acos(x))", "x",
           "a target's acos is off by 4096 units; see the precision table"},
    Action{"sine_of_angle", Kind::rewrite, "sin(acos(x))", "sqrt((1 - x)(1 + x))",
           "the angles of Oren and Nayar: acos near 1 knows its argument to half of its digits"},
    // near_one.cpp
    Action{"power_near_one", Kind::rewrite, "(1 - x)^y", "2^(y log2(1 - x)), by x below 1/16",
           "with an exponent of 2^25 the last digit of cos_h is a factor of e; the logarithm is x "
           "times a polynomial, right to 2^-31"},
    // regroup.cpp
    Action{"scalars_first", Kind::rewrite, "v a b", "v (a b)",
           "one operation in place of one for each component, and as many roundings fewer"},
    Action{"gated_scalar", Kind::rewrite, "c ? v a : 0", "v (c ? a : 0)", "as scalars_first"},
    Action{"blend_from_one", Kind::rewrite, "lerp(1, v a, t)", "(1 - t) + v (a t)",
           "no difference v a - 1 to cancel, and as scalars_first"},
    Action{"blend_to_scalar", Kind::rewrite, "lerp(1, b, t)", "b + (1 - t)(1 - b)",
           "adds where b is small, and 1 - b is the same for all components"},
    Action{"blend_to_one", Kind::rewrite, "x + (1 - x) a", "x (1 - a) + a", "as scalars_first"},
    // legalize.cpp
    Action{"whole_power", Kind::rewrite, "x^5", "(x^2)^2 x",
           "a power rounds like exp2(5 log2 x), and is undefined for x < 0"},
    Action{"half_power", Kind::rewrite, "x^2.5", "x^2 sqrt(x)", "as whole_power"},
    Action{"power_of_two", Kind::rewrite, "2^x", "exp2(x)", "one function instead of two"},
    Action{"joined_powers", Kind::rewrite, "x^a y^b", "2^(a log2 x + b log2 y)",
           "an exponential and a product less, and their roundings; guarded like each of them: x "
           "and y below 2^-126 count as that"},
    Action{"guarded_power", Kind::guard, "x^y", "max(x, 2^-126)^y",
           "x and y can be 0 together, and 0^0 is 1"},
    Action{"power_without_guard", Kind::needless, "x^y", "pow(x, y)",
           "x stays above 0, or y so far above it that 0^y is 0 in float"},
    Action{"held_base", Kind::guard, "x^y", "max(x, 0)^y",
           "x is not negative, but its rounding may be"},
    Action{"guarded_smoothstep", Kind::guard, "smoothstep(a, b, x)",
           "the ramp of (x - a) / max(b - a, 2^-64)", "the edges can meet, and 0 / 0 has no value"},
    Action{"smoothstep_without_guard", Kind::needless, "smoothstep(a, b, x)", "smoothstep(a, b, x)",
           "a stays below b"},
    Action{"guarded_normalize", Kind::guard, "normalize(v)", "v / sqrt(max(v.v, 2^-126))",
           "v can be 0"},
    Action{"normalize_without_guard", Kind::needless, "normalize(v)", "v / |v|", "v is not 0"},
    Action{"guarded_quotient", Kind::guard, "a / b else c", "|b| >= 2^-64 ? a / b : c",
           "b can be 0"},
    Action{"held_divisor", Kind::guard, "a / b", "a / max(b, 2^-126)",
           "b is not 0, but its rounding may be"},
    Action{"held_root", Kind::guard, "sqrt(x)", "sqrt(max(x, 0))",
           "x is not negative, but its rounding may be"},
    Action{"held_logarithm", Kind::guard, "log2(x)", "log2(max(x, 2^-126))",
           "x is above 0, but its rounding may not be"},
    Action{"held_inverse_root", Kind::guard, "inversesqrt(x)", "inversesqrt(max(x, 2^-126))",
           "x is above 0, but its rounding may not be"},
    Action{"held_angle", Kind::guard, "acos(x)", "acos(clamp(x, -1, 1))",
           "x is in [-1, 1], but its rounding may not be"},
};

}  // namespace

std::string_view name(Action::Kind kind)
{
    switch (kind) {
    case Action::Kind::rewrite: return "rewrite";
    case Action::Kind::guard: return "guard";
    case Action::Kind::needless: return "needless guard";
    }
    return {};
}

std::span<const Action> actions() { return action_table; }

const Action& action(std::string_view name)
{
    const auto found = std::ranges::find(action_table, name, &Action::name);
    assert(found != action_table.end());
    return *found;
}

}  // namespace lobe::optimize
