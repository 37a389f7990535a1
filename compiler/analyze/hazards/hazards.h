// Every operation that can leave its domain, cancel, overflow or underflow, in the naive spelling
// of a function and in the compiler's own, each with an input that does it.
#pragma once

#include "analyze/cost/cost.h"
#include "analyze/store.h"
#include "base/source.h"
#include "evaluate/run.h"
#include "ir/module.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

enum class HazardKind : std::uint8_t {
    domain,        ///< 0/0, pow(0, 0), a root of a negative number
    cancellation,  ///< a sum that keeps less than half of its digits
    overflow,
    underflow  ///< to zero or a subnormal, of what is divided by or taken the logarithm of
};
std::string_view name(HazardKind kind);

/// What the compiler does about it.
struct Remedy {
    enum class Kind : std::uint8_t {
        guard,    ///< a condition or a bound around the operation
        rule,     ///< another formula for it (optimize/rules.h)
        products  ///< products and roots in place of a power
    };

    std::string name;  ///< of a rule or an action of optimize: `blend_h`, `guarded_power`
    std::string text;  ///< `a + (1 - a) sin2_h`
    std::optional<std::array<double, all_families.size()>>
        cycles;  ///< issue cycles that it adds, from vectors
    Kind kind{};
};

struct Hazard {
    HazardKind kind{};
    std::string operation;   ///< `divide`
    std::string expression;  ///< as written, where it has a place in a source
    Span span;
    std::string witness;   ///< inputs that do it
    double share = 0;      ///< of the searched points
    double lost_bits = 0;  ///< cancellation: of the result's significand, at the witness
    std::string result;    ///< what the function returns there, and what it should
    std::optional<Remedy> remedy;
};

struct FunctionHazards {
    std::string function;
    evaluate::Precision precision{};
    std::vector<Hazard> naive;    ///< in the naive spelling, worst first
    std::vector<Hazard> emitted;  ///< left in the emitted one
    double naive_not_finite =
        0;  ///< share of the corner points where the result is NaN or infinite
    double emitted_not_finite = 0;
};

struct HazardOptions {
    std::size_t points = std::size_t{1} << 15;
    bool costs = true;  ///< of remedies
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

std::vector<FunctionHazards> hazards(const ir::Module& checked, const Sources& sources,
                                     const HazardOptions& options, const Store& store);

}  // namespace lobe::analyze
