// Over the whole declared box of a function: is every result finite, and how far can it be off?
//
// Intervals that carry an absolute and a relative error go through the tape, by the rules of the
// CPU (IEEE 754, the kernels' own exp2 and log2) or of any Vulkan device; the box is divided until
// the bound is sharp or the budget spent. Inputs are what the function is given: its arguments,
// parameters and fields, exact. How well the fields themselves are computed from vectors is proved
// of them, as functions of their own (`field_proofs`).
#pragma once

#include "analyze/store.h"
#include "analyze/verify.h"
#include "evaluate/interval.h"
#include "ir/module.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lobe::analyze {

/// A part of the inputs' box, by the names of the tape's inputs.
struct NamedBox {
    std::vector<std::pair<std::string, evaluate::Interval>> sides;
};
std::string describe(const NamedBox& box);

/// A proved bound beside the worst that was observed. It holds wherever rounding turns no decision
/// (see `jump`).
struct ErrorBound {
    double absolute = 0;  ///< infinite: none was found
    double relative = 0;  ///< of results of at least `Proof::floor`; of smaller ones, of the floor
    double observed_absolute = 0;
    double observed_relative = 0;
    std::string at;  ///< of the greater observed one
    /// What is added to the absolute error where a condition holds for what was computed and not
    /// for what was meant, a divisor underflowed, or a result overflowed; 0: that is nowhere.
    double jump = 0;
    double observed_jump = 0;

    /// The smaller of both bounds' ratios to what was observed; 1 where both are 0.
    double ratio() const;
    /// A bound so many times what was observed says nothing, and no budget makes it better.
    static constexpr double useless = 1e6;
};

struct Proof {
    std::string function;
    evaluate::Precision precision{};
    bool finite = false;         ///< proved, on any Vulkan device, over `over`
    std::vector<NamedBox> open;  ///< where it is not; at most 16, largest first
    std::size_t open_count = 0;
    std::size_t open_tested = 0;      ///< points in open boxes that were evaluated
    std::size_t open_not_finite = 0;  ///< and gave NaN or an infinity
    std::optional<NamedBox> over;     ///< for half: the part of the declared box that was proved
    std::string refused;              ///< for half: why no part could be
    double floor = 0;                 ///< what errors are relative to at least
    ErrorBound ieee;                  ///< CPU float, or half
    ErrorBound vulkan;                ///< on any device; observed: as above
    std::size_t boxes = 0;
    double seconds = 0;  ///< never kept
};

struct ProofOptions {
    std::vector<evaluate::Precision> precisions{evaluate::Precision::float32,
                                                evaluate::Precision::float16};
    std::size_t boxes = std::size_t{1} << 17;  ///< budget of a bound: how often it is computed
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

/// One per checked function of an optimized module (`checked_functions`) and precision, by name.
std::vector<Proof> proofs(const ir::Module& module, const ProofOptions& options,
                          const Store& store);

/// The same for these functions, in this order.
std::vector<Proof> proofs_of(const ir::Module& module, const std::vector<ir::FunctionId>& functions,
                             const ProofOptions& options, const Store& store);

/// The same for the fields that the module's functions read, as functions of unit vectors.
std::vector<Proof> field_proofs(const ir::Module& module, const ProofOptions& options,
                                const Store& store);

}  // namespace lobe::analyze
