// Ratios of polynomials in the place of expressions: Horner's scheme in a graph.
#pragma once

#include "analyze/minimax/fit.h"
#include "ir/module.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe::analyze {

/// Along one input polynomials are in (x - center) / scale, which lies in [-1, 1]. The center is a
/// float, and 0 unless the range is far from 0; the scale is a power of two, so that scaling a
/// coefficient rounds nothing.
struct Axis {
    double center = 0;
    double scale = 1;
};
Axis axis_of(ir::Range range);

/// A shape, and what forms of it are called: `minimax_3`, `minimax_2_2`, `minimax_3x3`.
struct NamedShape {
    std::string name;
    Shape shape;
};
/// Those that are tried for parts of one or two inputs: polynomials up to a (total) degree or with
/// a degree per input, and ratios of two with as much together.
std::vector<NamedShape> shapes(std::size_t inputs, int max_degree);

/// What comes in place of an expression of a function: a ratio of one or two of its inputs.
struct Replacement {
    ir::ExprId root;
    std::vector<std::uint32_t> inputs;
    ir::Range range{};  ///< what the expression was known to lie in
    Shape shape;
    Ratio ratio;  ///< in units of the axes
};

/// A function with some of its expressions replaced. Where intervals do not show that a replacement
/// stays in its range it is held there, so that what was proved of whoever reads it still holds;
/// likewise a denominator is held above half its least value.
ir::Function replaced(const ir::Module& module, const ir::Function& function,
                      const std::vector<Replacement>& replacements);

}  // namespace lobe::analyze
