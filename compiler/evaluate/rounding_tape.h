// One output of a tape as a list of values, each with what its users know of its operands.
//
// A division in the arm of a select is computed everywhere and wanted only where the condition
// chose it. So its divisor is known to satisfy the condition, and `b >= k ? a / b : c` is bounded
// by |a| / k. Without that no guarded quotient could be proved finite.
#pragma once

#include "evaluate/interval.h"
#include "evaluate/tape.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lobe::evaluate {

/// What holds for an operand wherever the result is wanted: a bound by another value.
struct Limit {
    enum class Kind : std::uint8_t {
        at_least,   ///< operand >= other
        at_most,    ///< operand <= other
        size_least  ///< |operand| >= other
    };
    Kind kind{};
    std::uint32_t operand = 0;  ///< which of the node's
    std::uint32_t other = 0;    ///< a node
};

struct RoundingNode {
    enum class Kind : std::uint8_t {
        input,
        literal,
        operation
    };
    Kind kind{};
    TapeOp op{};
    std::array<std::uint32_t, 4> operands{};  ///< nodes, as many as the arity
    int arity = 0;
    std::uint32_t input = 0;  ///< index into RoundingTape::inputs
    ir::Literal literal;
    std::vector<Limit> limits;
};

struct RoundingTape {
    std::vector<RoundingNode> nodes;    ///< operands first; the last one is the output
    std::vector<std::uint32_t> inputs;  ///< of the tape, those that the output depends on
};

/// How far operations that machines compute in steps are taken apart.
enum class Detail : std::uint8_t {
    operations,  ///< as on the tape: what `apply` of acceptance.h knows
    steps  ///< clamp, smoothstep, normalized: by single roundings, as the kernels compute them
};

RoundingTape rounding_tape(const Tape& tape, std::size_t output, Detail detail);

/// An operation over the reals. Smoothstep is its polynomial of one operand here.
Interval value_of(TapeOp op, const std::array<Interval, 4>& operands);

/// One line per node. Two outputs with the same text are the same function of their inputs.
std::string dump(const RoundingTape& tape);

}  // namespace lobe::evaluate
