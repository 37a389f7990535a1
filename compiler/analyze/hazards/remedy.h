// What the compiler does about a hazard: the rule or the guard that the emitted spelling has at the
// place of the expression.
#pragma once

#include "analyze/hazards/hazards.h"
#include "analyze/hazards/line.h"
#include "optimize/stabilize.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// The remedy of a hazard at `expression` of the naive line, if the emitted line has one; without
/// its cycles. `applied` are the rules that stabilizing used in the module.
std::optional<Remedy> remedy_of(const WatchedLine& naive, ir::ExprId expression,
                                const WatchedLine& emitted,
                                std::span<const optimize::Application> applied);

/// The issue cycles that remedies add to a function from vectors on every family.
///
/// Of a guard: against the emitted module without the guards at this place. Of a rule: against the
/// function as written, all of its rules together, because they share the inputs that they ask for
/// and the first one pays. Of products: nothing is said; they are what is written for a power.
class RemedyCosts {
public:
    RemedyCosts(const ir::Module& emitted, const ir::Module& as_written);

    /// Asks for the cycles of a remedy, which stays where it is until `measure` has filled them.
    void ask(ir::FunctionId function, const Span& span, Remedy& remedy);

    void measure(const Sources& sources, const CostOptions& options, const Store& store);

private:
    struct Question {
        Remedy* remedy = nullptr;
        std::size_t with = 0;  ///< indices into subjects_
        std::size_t without = 0;
    };
    std::size_t subject(const std::string& name, const ir::Module& module, ir::FunctionId function);
    const ir::Module& unguarded(const Span& span);

    const ir::Module& emitted_;
    const ir::Module& as_written_;
    std::map<std::string, ir::Module> unguarded_;  ///< by place
    std::map<std::string, std::size_t> known_;     ///< subjects by name
    std::vector<CostSubject> subjects_;
    std::vector<Question> questions_;
};

}  // namespace lobe::analyze
