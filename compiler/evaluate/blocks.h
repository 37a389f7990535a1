// Points to blocks: how columns of any length become whole blocks of lanes.
//
// The machinery that the float, double and half runs share. A whole block reads its inputs where
// they are; the last one, when it is short, is copied and padded, so that every kernel always
// computes `block_lanes` results and a point's result does not depend on where it stands.
#pragma once

#include "evaluate/kernels.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lobe::evaluate {

/// The slots of one tape as blocks of lanes. `slot(i)` is where slot i is.
template <class Number>
class Blocks {
public:
    Blocks(std::size_t inputs, std::size_t slots)
        : inputs_{inputs}, lanes_(slots * stride + 64 / sizeof(Number)), slots_(slots)
    {
        // From a cache line on, so that no vector straddles two.
        const auto address = reinterpret_cast<std::uintptr_t>(lanes_.data());
        first_ = lanes_.data() + (64 - address % 64) % 64 / sizeof(Number);
        for (std::size_t i = 0; i < slots; ++i) slots_[i] = first_ + i * stride;
    }

    Number* operator[](std::size_t slot) const { return slots_[slot]; }

    void fill(std::size_t slot, Number value) { std::fill_n(slots_[slot], block_lanes, value); }

    /// Points the input slots at lanes `begin` .. of the columns.
    void enter(Columns<Number> columns, std::size_t begin, std::size_t count)
    {
        for (std::size_t i = 0; i < inputs_; ++i) {
            const Number* const from = columns[i] + begin;
            if (count == block_lanes) {
                // Kernels never write to an input's slot.
                slots_[i] = const_cast<Number*>(from);
                continue;
            }
            slots_[i] = first_ + i * stride;
            std::fill(std::copy_n(from, count, slots_[i]), slots_[i] + block_lanes, from[0]);
        }
    }

    void leave(const std::vector<Slot>& outputs, Results<Number> columns, std::size_t begin,
               std::size_t count) const
    {
        for (std::size_t i = 0; i < outputs.size(); ++i)
            std::copy_n(slots_[outputs[i]], count, columns[i] + begin);
    }

private:
    // Slots follow each other without a gap: lanes of one index are then never just behind each
    // other modulo 4 KiB, where a load would seem to need the store before it.
    static constexpr std::size_t stride = block_lanes;

    std::size_t inputs_;
    std::vector<Number> lanes_;
    Number* first_ = nullptr;
    std::vector<Number*> slots_;
};

}  // namespace lobe::evaluate
