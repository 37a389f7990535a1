// Random terms whose values are finite over the ranges of their inputs.
#pragma once

#include "build.h"

#include <random>

namespace lobe::tests {

/// A root with three scalar arguments and a color, of about `size` operations. Literals that
/// simplification looks for (0, 1, -1, 2, 0.5) are as likely as ones it cannot fold (0.1, pi).
/// No operation of it rounds a literal differently from an exact fold.
inline ir::Module random_term(std::mt19937& random, int size)
{
    using ir::Op;
    Term term{"random"};
    std::vector<ir::ExprId> scalars{term.argument("a", 0, 1), term.argument("b", -2, 2),
                                    term.argument("c", 0.5, 3)};
    std::vector<ir::ExprId> vectors{term.argument("v", 0, 1, ir::Type::vec3)};
    for (const char* text : {"0", "1", "-1", "2", "0.5", "0.1", "pi"})
        scalars.push_back(term.number(text));

    const auto choose = [&](const std::vector<ir::ExprId>& from) {
        return from[std::uniform_int_distribution<std::size_t>{0, from.size() - 1}(random)];
    };
    const auto x = [&] { return choose(scalars); };
    // Keeps values small, so that a long chain of products stays finite.
    const auto small = [&] {
        return term.op(Op::clamp, {x(), term.number("-4"), term.number("4")});
    };
    const auto positive = [&] {
        return term.add(term.op(Op::absolute, {small()}), term.number("0.5"));
    };
    const auto either = [&] {
        return std::uniform_int_distribution<int>{0, 1}(random) == 0 ? choose(vectors) : x();
    };
    const auto condition = [&] {
        constexpr Op compare[] = {Op::less, Op::less_equal, Op::equal, Op::not_equal};
        return term.op(compare[std::uniform_int_distribution<int>{0, 3}(random)], {x(), x()});
    };

    for (int i = 0; i < size; ++i) {
        switch (std::uniform_int_distribution<int>{0, 21}(random)) {
        case 0: scalars.push_back(term.add(x(), x())); break;
        case 1: scalars.push_back(term.subtract(x(), x())); break;
        case 2: scalars.push_back(term.multiply(small(), small())); break;
        case 3: scalars.push_back(term.divide(small(), positive())); break;
        case 4: scalars.push_back(term.op(Op::negate, {x()})); break;
        case 5: scalars.push_back(term.op(Op::absolute, {x()})); break;
        case 6: scalars.push_back(term.op(Op::minimum, {x(), x()})); break;
        case 7: scalars.push_back(term.op(Op::maximum, {x(), x()})); break;
        case 8: scalars.push_back(term.op(Op::saturate, {x()})); break;
        case 9: scalars.push_back(term.op(Op::step, {x(), x()})); break;
        case 10: scalars.push_back(term.op(Op::lerp, {small(), small(), small()})); break;
        case 11: scalars.push_back(term.op(Op::select, {condition(), x(), x()})); break;
        case 12:
            scalars.push_back(term.op(
                Op::select,
                {term.op(Op::logical_or, {condition(), term.op(Op::logical_not, {condition()})}),
                 x(), x()}));
            break;
        case 13: scalars.push_back(term.op(Op::square_root, {positive()})); break;
        case 14: scalars.push_back(term.op(Op::sign, {x()})); break;
        case 15: scalars.push_back(term.op(Op::guarded_smoothstep, {x(), x(), x()})); break;
        case 16: {
            const ir::ExprId parts[] = {x(), x(), x()};
            vectors.push_back(term.function.graph.construct(ir::Type::vec3, parts));
            break;
        }
        case 17: scalars.push_back(term.function.graph.component(choose(vectors), i % 3)); break;
        case 18: vectors.push_back(term.add(choose(vectors), either())); break;
        case 20: {  // a division with a limit
            const ir::ExprId divisor = small();
            const ir::ExprId quotient = term.divide(term.op(Op::negate, {small()}), divisor);
            scalars.push_back(
                term.op(Op::select,
                        {term.op(Op::less_equal, {term.function.graph.literal(ir::least_divisor),
                                                  term.op(Op::absolute, {divisor})}),
                         quotient, x()}));
            break;
        }
        case 21: scalars.push_back(term.subtract(term.number("1"), term.multiply(x(), x()))); break;
        case 19: {
            const ir::ExprId weight = term.op(Op::saturate, {x()});
            vectors.push_back(term.op(Op::lerp, {either(), choose(vectors), weight}));
            break;
        }
        }
    }
    return only(term, term.multiply(vectors.back(), scalars.back()));
}

}  // namespace lobe::tests
