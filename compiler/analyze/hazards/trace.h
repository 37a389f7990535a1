// One point through a watched line, twice: as a device computes it, and exactly.
//
// As a device: every step is rounded to float or half, and a bare operation is what shaders make of
// it: pow(x, y) is exp2(y log2 x), which is NaN for 0^0 and for x < 0, a quotient by 0 is infinite
// or NaN (IEEE 754). Where the Vulkan specification leaves the result of an operation on NaN open
// (min, max, clamp), the operand that is a number comes out, as D3D asks and lavapipe does: that
// makes the naive text look better, not worse. Transcendental functions are rounded correctly.
//
// Exactly: in double, with the total operations of docs/numerics.md; `confirm` repeats that with
// 113 bits.
#pragma once

#include "analyze/grid.h"
#include "analyze/hazards/line.h"
#include "evaluate/run.h"

#include <optional>
#include <span>
#include <vector>

namespace lobe::analyze {

class Trace {
public:
    Trace(const WatchedLine& line, evaluate::Precision precision);

    /// A result to be replaced by the exact one, rounded: what would be without its error.
    using Repair = std::optional<std::size_t>;

    /// `point` has the columns that the line was watched with; numbers of the grid.
    void run(std::span<const double> point, Repair repaired = {});
    /// The exact values again, now with 113 bits.
    void confirm(std::span<const double> point);

    double device(evaluate::Slot slot) const { return device_[slot]; }
    double exact(evaluate::Slot slot) const { return exact_[slot]; }
    bool any_infinite() const { return any_infinite_; }

    /// Whether the result depends on a slot at this point: on no arm that a select does not take.
    /// Computed by `find_demand`.
    void find_demand();
    bool demanded(evaluate::Slot slot) const { return demanded_[slot] != 0; }

    /// How many bits of the significand are right.
    double kept_bits(evaluate::Slot slot) const;

    const WatchedLine& line() const { return *line_; }
    const Grid& grid() const { return *grid_; }

private:
    template <class Rounding>
    void run_as(std::span<const double> point, Repair repaired);

    const WatchedLine* line_;
    const Grid* grid_;
    std::vector<double> device_;
    std::vector<double> exact_;
    std::vector<char> demanded_;
    bool any_infinite_ = false;
};

}  // namespace lobe::analyze
