// Module to line: calls inlined, vectors taken apart, equal scalars shared.
//
// A line is the tape before slots: values in the order of their computation, each written once.
// tape.cpp gives them slots; fuse.cpp joins neighbors for the fast kernels first.
#pragma once

#include "evaluate/tape.h"

#include <array>
#include <cassert>
#include <initializer_list>
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

/// The values of the components of one expression, at most four.
class Components {
public:
    Components() = default;
    Components(std::initializer_list<Value> values)
    {
        for (const Value value : values) push_back(value);
    }

    void push_back(Value value)
    {
        assert(size_ < values_.size());
        values_[size_++] = value;
    }
    std::size_t size() const { return size_; }
    Value operator[](std::size_t i) const { return values_[i]; }
    const Value* begin() const { return values_.data(); }
    const Value* end() const { return values_.data() + size_; }

private:
    std::array<Value, 4> values_{};
    std::uint32_t size_ = 0;
};

struct Line {
    std::vector<TapeInput> inputs;
    std::vector<ir::Literal> constants;
    std::vector<Step> steps;  ///< indexed by Value
    std::vector<Value> outputs;
    std::vector<std::string> output_names;
    std::vector<Components> values_of;  ///< per expression of the function's own graph, if traced
};

enum class Trace {
    live,
    all
};

/// `Trace::all` keeps every expression of the function's own graph, dead ones too.
Line scalarize(const ir::Module& module, const ir::Function& function, Trace trace);

}  // namespace lobe::evaluate
