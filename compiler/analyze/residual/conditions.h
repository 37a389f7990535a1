// Whether the effects of a module can be on, given what its parameters can be.
#pragma once

#include "analyze/residual/facts.h"
#include "evaluate/tape.h"

#include <map>

namespace lobe::analyze {

class Conditions {
public:
    explicit Conditions(const ir::Module& module);

    /// Parameters that the condition of an effect reads, by name.
    const std::vector<std::string>& parameters_of(std::size_t effect) const
    {
        return effects_[effect].parameters;
    }

    /// False where the condition, `off when`, is proved to hold whatever the parameters are within
    /// these facts: intervals prove it, or, for constants, exact arithmetic on what they read as.
    /// `facts` has what is not at its default.
    bool can_be_on(std::size_t effect, const std::map<std::string, InputFact>& facts,
                   const std::map<std::string, InputFact>& defaults);

private:
    struct Condition {
        std::vector<std::string> parameters;
        ir::Module alone;  ///< a module of this one function, without calls
        evaluate::Tape tape;
        /// What was asked before, by the ranges of the parameters' components.
        std::map<std::vector<double>, bool> known;
    };
    static bool decide(const Condition& condition, const std::vector<double>& ends);

    std::vector<Condition> effects_;
};

}  // namespace lobe::analyze
