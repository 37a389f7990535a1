// A function that gives light, ready to run over many points: its tape, and where each of its
// inputs comes from.
#pragma once

#include "evaluate/tape.h"
#include "ir/module.h"
#include "render/surface.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::render {

/// Points of one shader, column by column; every column has `size` numbers.
struct Batch {
    std::size_t size = 0;
    std::vector<std::vector<float>> values;      ///< in the order of MaterialValues
    std::array<std::vector<float>, 12> frame;    ///< n, x, y, v
    std::array<std::vector<float>, 3> l;         ///< to the light, where a program asks for it
    std::array<std::vector<float>, 11> emitter;  ///< in the order of `emitter_columns`
    std::array<std::vector<float>, 3> result;    ///< of the program that ran last
};

/// What a program may ask of a light, by its columns' names.
inline constexpr std::array<std::string_view, 11> emitter_columns{
    "to_light.x", "to_light.y",  "to_light.z",    "axis.x",    "axis.y",   "axis.z",
    "radius",     "half_length", "inverse_range", "cos_inner", "cos_outer"};

class Program {
public:
    /// A function over vectors, whose result is a color or a number. Every input must be one that a
    /// batch has; nothing else can be named in a model.
    Program(const ir::Module& module, const ir::Function& function, const MaterialValues& values);

    void run(Batch& batch) const;

private:
    enum class Source : std::uint8_t {
        value,
        frame,
        light,
        emitter
    };
    struct Column {
        Source source{};
        std::size_t index = 0;
    };
    evaluate::Tape tape_;
    std::vector<Column> columns_;
};

}  // namespace lobe::render
