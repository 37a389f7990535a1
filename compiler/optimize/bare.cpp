#include "optimize/bare.h"

#include "optimize/guard.h"
#include "optimize/literal.h"
#include "optimize/rewrite.h"

namespace lobe::optimize {

using namespace ir;

namespace {

Step strip(Rebuild& rebuild)
{
    return [&rebuild](ExprId id) {
        const Graph& old = rebuild.old().graph;
        const Span span = old.span(id);
        const auto operands = old.operands(id);
        const auto make = [&](Op op) {
            return rebuild.graph.apply(op, rebuild.moved_operands(id), span);
        };
        switch (old[id].op) {
        case Op::power:
        case Op::guarded_power:
            if (exact_literal(old, operands[1]) == 2 && old[operands[0]].type == old[id].type) {
                const ExprId x = rebuild.moved(operands[0]);
                return rebuild.graph.apply(Op::multiply, {x, x}, span);
            }
            return make(Op::power);
        case Op::guarded_smoothstep: return make(Op::smoothstep);
        case Op::guarded_normalize: return make(Op::normalize);
        case Op::clamp:
            // The language's own, around a cosine of two directions: both are one expression.
            if (old[operands[0]].op == Op::dot && old.span(operands[0]) == span)
                return rebuild.moved(operands[0]);
            return rebuild.copy(id);
        case Op::select:
            if (const auto guard = find_guard(old, id)) return rebuild.moved(guard->quotient);
            return rebuild.copy(id);
        default: return rebuild.copy(id);
        }
    };
}

}  // namespace

Module bare(const Module& module)
{
    Module result = rewrite(module, strip);
    result.bare_geometry = true;
    return result;
}

}  // namespace lobe::optimize
