// Forms that the compiler finds itself: best polynomials and ratios of polynomials in the place of
// terms, and of parts of terms, that depend on one or two scalars, over their declared ranges.
//
// Least greatest error, by linear programs with Remez' exchange; coefficients are rounded to float
// and the error is measured again with what they became. What comes out is an ordinary form, with
// its error in its documentation. docs/forms.md tells what is tried, and what is dropped.
#pragma once

#include "analyze/store.h"
#include "ir/module.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::analyze {

struct MinimaxOptions {
    int max_degree = 6;
    unsigned jobs = 0;
};

/// What was found for a term.
struct FoundForm {
    std::string term;
    std::string form;     ///< `minimax_3`, `minimax_2_2`
    double error = 0;     ///< greatest of any component, absolute, with rounded coefficients, over
                          ///< the reals; observed
    double ideal = 0;     ///< the same before they were rounded
    std::string formula;  ///< as a .lobe expression: it can be pasted into a model
};

/// The checked module with found forms added to its terms (and imported ones that it reaches),
/// behind their own. Parts that are no dearer than a polynomial of degree 1 are left alone. The
/// same whatever the number of threads.
struct WithFoundForms {
    ir::Module module;
    std::vector<FoundForm> found;
};
WithFoundForms add_found_forms(const ir::Module& checked, const MinimaxOptions& options,
                               const Store& store);

}  // namespace lobe::analyze
