#include "optimize/optimize.h"

#include <cassert>

namespace lobe::optimize {

ir::Module optimize(const ir::Module& module)
{
    constexpr ir::Module (*pipeline[])(const ir::Module&) = {
        simplify,   // so that rules meet x and not x * 1
        stabilize,  // while powers are powers and differences stand as they were written
        simplify,   // what a stable form folds to, and inputs that nothing reads any more
        legalize,   // late: what it proves is about the expressions that will be emitted
        simplify,   // factors of 1 in products, and guards that a sharper range makes needless
    };
    ir::Module current = module;
    for (const auto pass : pipeline) {
        current = pass(current);
        assert(!ir::verify(current));
    }
    return current;
}

}  // namespace lobe::optimize
