// What goes wrong in a traced point, operation by operation.
#pragma once

#include "analyze/hazards/hazards.h"
#include "analyze/hazards/trace.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lobe::analyze {

struct HazardEvent {
    HazardKind kind{};
    std::size_t instruction = 0;
};

/// How far the operands of a step are from leaving the domain of a bare operation: 0 outside it,
/// infinite where it has none. The domains are those of the Vulkan specification, appendix
/// "Precision and Operation of SPIR-V Instructions", and of GLSL 4.50, section 8.
double domain_distance(const evaluate::Instruction& step, const Trace& trace);

/// The error of a result in the units people judge by (see deviation.h): relative, or of 0.18 where
/// the exact value is smaller. Infinite where only the result is not finite.
double scaled_error(double result, double exact);

/// Half of the digits: what a sum must keep, and how good a result must be to be called right.
double tolerance(const Grid& grid);

class HazardJudge {
public:
    explicit HazardJudge(const WatchedLine& line);

    /// What happens at the point that was traced last, with its demand found. `wrong`: the
    /// function's result is off there. Without that only what left its domain is an event: digits
    /// that nothing depends on are no loss.
    void find(const Trace& trace, bool wrong, std::vector<HazardEvent>& events) const;

    /// A cheap test for points at which `find` has nothing to say.
    bool may_find(const Trace& trace, bool wrong) const;

    /// Instructions that may leave their domain, and those that may cancel.
    std::span<const std::size_t> with_domain() const { return with_domain_; }
    std::span<const std::size_t> sums() const { return sums_; }

private:
    bool cancels(const Trace& trace, std::size_t instruction) const;
    bool underflows(const Trace& trace, std::size_t instruction) const;

    const WatchedLine* line_;
    std::vector<std::size_t> with_domain_;
    std::vector<std::size_t> sums_;
    std::vector<std::size_t> divisors_;  ///< whose result is divided by or taken the logarithm of
};

}  // namespace lobe::analyze
