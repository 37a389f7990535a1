// A function whose every value can be watched: over vectors, without calls, each value in a slot of
// its own and each instruction known by the expression it belongs to.
#pragma once

#include "base/source.h"
#include "evaluate/tape.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

struct WatchedLine {
    /// Where an input of the line comes from: a column of the points, one minus it, or a number.
    struct Feed {
        std::size_t column = 0;
        bool complement = false;
        std::optional<double> constant;

        double operator()(std::span<const double> point) const
        {
            if (constant) return *constant;
            return complement ? 1 - point[column] : point[column];
        }
    };

    ir::Function function;  ///< its entry point (see ir::entry_point) with calls inlined
    evaluate::Tape tape;
    std::vector<ir::ExprId> owner;  ///< by instruction: what it computes, or is a step of
    std::vector<Feed> feeds;        ///< by input of the tape
};

/// `columns` are the names of the inputs of the function's entry point as it was written: a pass
/// may have dropped some, or added the complements of some. A power stays one: where a tape would
/// multiply for a whole literal, a shader says pow, and its exponent is an input here.
WatchedLine watch(const ir::Module& module, ir::FunctionId function,
                  std::span<const std::string> columns);

/// What an expression is in the source, on one line; for what an entry point computes from vectors
/// and has no place there, in the same notation: `dot(n, normalize(l + v))`.
std::string text_of(const WatchedLine& line, ir::ExprId expression, const Sources& sources);

}  // namespace lobe::analyze
