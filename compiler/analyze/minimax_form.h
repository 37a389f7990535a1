// A ratio of polynomials as a form of a term: Horner's scheme in the graph, and the same as text
// that can be pasted into a model.
#pragma once

#include "analyze/fit.h"
#include "ir/module.h"

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
/// Those that are tried for terms of one or two inputs, cheapest first: polynomials up to a (total)
/// degree or with a degree per input, and ratios.
std::vector<NamedShape> shapes(std::size_t inputs, int max_degree);

/// The form of a term that computes a ratio whose coefficients are floats. Where intervals do not
/// show that it stays within the term's range, it is held there, so that whatever was proved of
/// those who call the term holds with the form; likewise the denominator is held above its least
/// value. Its documentation, and what it is proved to be in, are still to be written.
ir::Function minimax_form(const ir::Module& module, ir::FunctionId term, const NamedShape& shape,
                          const Ratio& ratio);

}  // namespace lobe::analyze
