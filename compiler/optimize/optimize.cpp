#include "optimize/optimize.h"

#include <cassert>

namespace lobe::optimize {

namespace {

ir::Module checked(ir::Module module)
{
    assert(!ir::verify(module));
    return module;
}

}  // namespace

ir::Module optimize(const ir::Module& module)
{
    // So that rules meet x and not x * 1.
    const ir::Module simple = checked(simplify(module));
    // While powers are powers and differences stand as they were written.
    const ir::Module stable = checked(stabilize(simple));
    // What a stable form folds to, and inputs that nothing reads any more.
    const ir::Module clean = checked(simplify_again(simple, stable));
    // Late: what it proves is about the expressions that will be emitted.
    const ir::Module legal = checked(legalize(clean));
    // Factors of 1 in products, and guards that a sharper range makes needless.
    return checked(simplify_again(clean, legal));
}

}  // namespace lobe::optimize
