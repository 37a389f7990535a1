// Module to line: calls inlined, vectors taken apart, equal scalars shared.
//
// A line is the tape before slots: values in the order of their computation, each written once.
// tape.cpp gives them slots; fuse.cpp joins neighbors for the fast kernels first.
#pragma once

#include "evaluate/tape.h"

#include <array>
#include <span>

namespace lobe::evaluate {

using Value = std::uint32_t;  ///< inputs first, then the other values in any topological order

struct Step {
    enum class Kind : std::uint8_t {
        input,
        constant,
        operation
    };
    Kind kind{};
    TapeOp op{};              ///< of an operation
    std::uint8_t count = 0;   ///< of operands
    std::uint32_t index = 0;  ///< of an input or constant
    std::array<Value, 4> operands{};

    std::span<const Value> arguments() const { return std::span{operands}.first(count); }
    friend bool operator==(const Step&, const Step&) = default;
};

struct Line {
    std::vector<TapeInput> inputs;
    std::vector<ir::Literal> constants;
    std::vector<Step> steps;  ///< indexed by Value
    std::vector<Value> outputs;
    std::vector<std::string> output_names;
    /// Per expression of the function's own graph, one value per component. Only when traced.
    std::vector<std::vector<Value>> values_of;
};

enum class Trace {
    live,
    all
};

/// `Trace::all` keeps every expression of the function's own graph, dead ones too.
Line scalarize(const ir::Module& module, const ir::Function& function, Trace trace);

}  // namespace lobe::evaluate
