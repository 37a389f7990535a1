// A function as a straight line of scalar operations: calls inlined, vectors taken apart,
// shared expressions computed once, dead ones absent, slots reused.
//
// One tape is run by every kind of number (see run.h). That is what makes the float kernel, the
// MPFR truth and the acceptance interval the same program.
#pragma once

#include "ir/module.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe::evaluate {

enum class TapeOp : std::uint8_t {
#define LOBE_TAPE_OP(name, arity) name,
#include "evaluate/tape_ops.def"
#undef LOBE_TAPE_OP
};

int arity(TapeOp op);
std::string_view name(TapeOp op);
/// Its result is true or false, as 1 or 0.
bool makes_condition(TapeOp op);

using Slot = std::uint32_t;

struct Instruction {
    TapeOp op{};
    Slot result = 0;
    Slot a = 0;  ///< operands; those past the arity are 0
    Slot b = 0;
    Slot c = 0;
    Slot d = 0;
};

/// An instruction of the float kernels, which join neighbors; see fused.h.
struct FusedInstruction {
    std::uint16_t op = 0;  ///< FusedOp
    Slot result = 0;
    Slot a = 0;
    Slot b = 0;
    Slot c = 0;
    Slot d = 0;
};

/// The same function as the code beside it, with the same inputs and constants in the same slots.
struct FusedCode {
    std::vector<FusedInstruction> code;
    std::vector<Slot> outputs;
    Slot slots = 0;
};

struct Constant {
    Slot slot = 0;
    ir::Literal literal;
};

/// One scalar that goes in: a component of an input of the function. Inputs occupy slots
/// 0 .. inputs.size() - 1 and stay there.
struct TapeInput {
    std::string name;         ///< `roughness`, `f0.r`, `l.x`: also the column name in tables
    std::uint32_t input = 0;  ///< index into Function::inputs
    int component = 0;
};

struct Tape {
    std::vector<TapeInput> inputs;
    std::vector<Constant> constants;  ///< in the slots after the inputs
    std::vector<Instruction> code;
    std::vector<Slot> outputs;              ///< slots of the result's components
    std::vector<std::string> output_names;  ///< `D_GGX`, or `c1.r`, `c1.g`, `c1.b`
    Slot slots = 0;
    FusedCode fused;  ///< for float; empty on a traced tape
};

/// The tape of a function of the module, or of an entry point into it. A boolean result is
/// 0 or 1.
Tape compile(const ir::Module& module, const ir::Function& function);

/// As `compile`, but every expression of the function's own graph keeps its slots: slot of
/// component k of expression e is `slots_of[e.index][k]` in `Traced::slots_of`. For range
/// analysis.
struct Traced {
    Tape tape;
    std::vector<std::vector<Slot>> slots_of;  ///< per expression, one per component
};
Traced compile_traced(const ir::Module& module, const ir::Function& function);

/// `.x .y .z .w`, or `.r .g .b` for colors; empty for scalars.
std::string component_suffix(ir::Type type, ir::Quantity quantity, int component);

/// One line per instruction, for tests and failure messages.
std::string dump(const Tape& tape);

}  // namespace lobe::evaluate
