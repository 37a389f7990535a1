#include "analyze/cost/weight.h"

#include <array>
#include <vector>

namespace lobe::analyze {
namespace {

using evaluate::Instruction;
using evaluate::TapeOp;

int weight(TapeOp op)
{
    switch (op) {
    case TapeOp::negate:
    case TapeOp::absolute:
    case TapeOp::saturate: return 0;
    case TapeOp::divide:
    case TapeOp::square_root:
    case TapeOp::inverse_square_root:
    case TapeOp::exp2:
    case TapeOp::log2: return weight_of_division;
    case TapeOp::exp:
    case TapeOp::log:
    case TapeOp::sine:
    case TapeOp::cosine:
    case TapeOp::normalized: return weight_of_division + 1;
    case TapeOp::power:
    case TapeOp::tangent: return 2 * weight_of_division + 1;
    case TapeOp::smoothstep: return weight_of_division + 5;
    // Polynomials of a target's own.
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine:
    case TapeOp::arc_tangent: return 12;
    case TapeOp::sign:
    case TapeOp::lerp:
    case TapeOp::sum3: return 2;
    case TapeOp::sum4: return 3;
    case TapeOp::floor:
    case TapeOp::square:
    case TapeOp::add:
    case TapeOp::subtract:
    case TapeOp::multiply:
    case TapeOp::minimum:
    case TapeOp::maximum:
    case TapeOp::step:
    case TapeOp::clamp:
    case TapeOp::less:
    case TapeOp::less_equal:
    case TapeOp::equal:
    case TapeOp::not_equal:
    case TapeOp::logical_and:
    case TapeOp::logical_or:
    case TapeOp::logical_not:
    case TapeOp::select: return 1;
    }
    return 0;
}

/// What is in a slot: the result of an operation, an input or a constant.
struct Content {
    int operation = -1;
    bool varies = false;
};

bool is_product(TapeOp op) { return op == TapeOp::multiply || op == TapeOp::square; }
bool is_sum(TapeOp op) { return op == TapeOp::add || op == TapeOp::subtract; }

}  // namespace

int weight(const evaluate::Tape& tape)
{
    std::vector<Content> slots(tape.slots);
    for (std::size_t i = 0; i < tape.inputs.size(); ++i) slots[i].varies = true;

    std::vector<std::array<Content, 4>> operands;
    std::vector<int> uses(tape.code.size(), 0);
    std::vector<bool> varies;
    const auto use = [&](const Content& content) {
        if (content.operation >= 0) ++uses[static_cast<std::size_t>(content.operation)];
        return content;
    };
    for (const Instruction& step : tape.code) {
        const std::array read{step.a, step.b, step.c, step.d};
        std::array<Content, 4> of{};
        bool any = false;
        for (std::size_t i = 0; i < static_cast<std::size_t>(evaluate::arity(step.op)); ++i) {
            of[i] = use(slots[read[i]]);
            any = any || of[i].varies;
        }
        slots[step.result] = {static_cast<int>(operands.size()), any};
        operands.push_back(of);
        varies.push_back(any);
    }
    for (const evaluate::Slot output : tape.outputs) use(slots[output]);

    int result = 0;
    for (std::size_t i = 0; i < tape.code.size(); ++i) {
        if (!varies[i]) continue;
        bool is_fused = false;
        for (const Content& operand : operands[i]) {
            if (!operand.varies || operand.operation < 0) continue;
            const auto from = static_cast<std::size_t>(operand.operation);
            is_fused = is_fused || (is_product(tape.code[from].op) && uses[from] == 1);
        }
        if (is_sum(tape.code[i].op) && is_fused) continue;
        // Division by a constant is a product.
        const bool is_scaling = tape.code[i].op == TapeOp::divide && !operands[i][1].varies;
        result += weight(is_scaling ? TapeOp::multiply : tape.code[i].op);
    }
    return result;
}

}  // namespace lobe::analyze
