// A compute shader that evaluates functions again and again, so that what one evaluation more
// costs can be told.
//
// The evaluations form chains. Each reads the same inputs, loaded once and different in every
// lane, with some bits of the evaluation before it flipped; the bits are 0 at run time, which no
// compiler knows. So nothing is shared between evaluations, nothing folds, and all inputs stay in
// their ranges.
//
//        x ────┬────────────────────┬──────────────────  ...
//   0 ──▶ x ^ link ─▶ f ─▶ link ─▶ x ^ link ─▶ f ─▶ link  ...     link = max(bits of f) & zero
//
// A link is integer operations: these join with none of f's floating-point ones (a link that
// added would fuse with a multiplication of f), and perturbing by one kind and joining by another
// joins with none of its own. What links cost is measured with `powers` and `product` in place of
// f.
#pragma once

#include "emit/emit.h"
#include "emit/template.h"

#include <string>
#include <vector>

namespace lobe::emit {

/// What every number of an evaluation is. `packed16` does two evaluations at once, in f16vec2.
enum class NumberFormat {
    float32,
    float16,
    packed16
};

/// One evaluation as GLSL 4.50. Its scalars are uints that hold a number's bits.
struct Evaluation {
    std::vector<Record> helpers;    ///< `text`
    std::vector<Record> functions;  ///< `signature`, `statements` of `text`
    std::vector<std::string> statements;
    std::vector<std::string> results;  ///< expressions of the format's scalar type
    int inputs = 0;                    ///< scalars that it may read
};

/// The functions exactly as `emit` writes them for GLSL 4.50, called with what they share given
/// once: the fields that they read or, with `from_vectors`, what makes these. Of two arguments
/// with one name there is one. Inputs are those of the functions in order, each input's components
/// together; from vectors, l, v and n (and x, y where needed) where the first field of the
/// geometry was. For float32 and float16.
Evaluation evaluation(const ir::Module& module, const Sources& sources,
                      const std::vector<ir::FunctionId>& functions, NumberFormat format,
                      bool from_vectors);

/// Evaluations to measure links with: of each number its power, by products (a number that came
/// out as it went in would not pass through the format's registers); and the product of two.
Evaluation powers(int numbers, int exponent, NumberFormat format);
Evaluation product(NumberFormat format);

/// How an evaluation reads the number or the condition that is its input `index`.
std::string read_number(int index, NumberFormat format);
std::string read_condition(int index);

/// The shader: `chains` chains of `copies` evaluations in each invocation. It has the interface of
/// `Harness`, with Evaluation::inputs floats in and one float out per point, but wants a multiple
/// of 64 points.
std::string cost_harness(const Evaluation& evaluation, NumberFormat format, int copies,
                         int chains = 1);

}  // namespace lobe::emit
