// Where codes change: inputs of what packs and unpacks, close to the border between two codes.
//
// A constant that is off by 1e-4 moves a border by a fraction of a code that points all over a
// range hardly ever meet. Comes in: an entry point. Goes out: for each of its scalars the values
// that lie on a border, from which points are placed at distances of every order of magnitude.
#pragma once

#include "analyze/random.h"
#include "ir/module.h"

#include <span>
#include <vector>

namespace lobe::analyze {

class Borders {
public:
    /// Of the function that `entry` calls, if it encodes, packs or unpacks. Else there are none.
    Borders(const ir::Module& module, const ir::Function& entry);

    bool empty() const { return columns_.empty(); }
    /// Moves every scalar that has borders close to one of them. Values may lie outside of a range
    /// by the distance to its end.
    void place(Random& random, std::span<double> values) const;

private:
    void add_field(const ir::Module& module, const ir::Field& field, std::size_t column);
    void add_channel(int bits, std::size_t column);

    std::vector<std::vector<double>> columns_;  ///< borders, per scalar; empty: it has none
};

}  // namespace lobe::analyze
