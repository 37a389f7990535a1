// Can the check fail? Mutants of the emitted text, each held against the same reference as the
// shader it was made from.
//
//   killed      some point is outside its acceptance interval that was inside before
//   rejected    a judge refused the text; that is the judge's merit, not the check's
//   equivalent  proved to be the same function: the optimizer makes the same program of it, or it
//               swaps inputs in which the function is symmetric
//   unchanged   the same bits at every point: no input reaches the difference
//   tolerated   other results, every one of which the contract allows
//
// The kill rate is killed / (killed + unchanged + tolerated).
#pragma once

#include "analyze/agreement/mutation.h"
#include "analyze/verify.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

enum class Fate : std::uint8_t {
    killed,
    rejected,
    equivalent,
    unchanged,
    tolerated
};
std::string_view name(Fate fate);

struct MutantFate {
    std::string term;
    std::string target;
    Mutant mutant;  ///< without its text
    Fate fate{};
    std::string reason;       ///< of an equivalent or tolerated one, in words
    std::size_t outside = 0;  ///< points
    std::size_t changed = 0;  ///< points with other bits than the shader it was made from
};

struct KillOptions {
    std::size_t mutants = 200;   ///< chosen evenly over mutations and functions; 0: all there are
    std::size_t points = 65536;  ///< per function
    std::vector<const emit::Target*> targets;  ///< functions take turns; empty: glsl450, hlsl
    std::string device;
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

struct KillReport {
    std::vector<MutantFate> mutants;  ///< by module, term, place
    std::size_t available = 0;        ///< before the choice
    std::string device;
    std::string no_device;  ///< why nothing was done; empty: it was
    /// Terms whose own text is refused, fails to run or is outside; their mutants are left out.
    std::vector<std::string> unusable;
    double seconds = 0;

    std::size_t count(Fate fate) const;
    /// Of those that could be killed; 1 when there are none.
    double kill_rate() const;
};

/// What is mutated: modules that have been through optimize, with their sources.
struct KillSubject {
    const ir::Module* module = nullptr;
    const Sources* sources = nullptr;
};

KillReport kill(std::span<const KillSubject> subjects, const KillOptions& options);

}  // namespace lobe::analyze
