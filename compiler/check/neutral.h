// Effects and what is stored: the values of a parameter at which an effect is off, and whether it
// still is once they were stored.
#pragma once

#include "check/field_run.h"

#include <optional>
#include <vector>

namespace lobe::check {

/// The condition of an effect, over one component of a parameter while all else is at its default.
class Condition {
public:
    Condition(const ir::Module& module, const ir::Effect& effect);

    /// The values of what a field stores at which the effect is off: its default and the numbers in
    /// the condition are tried.
    std::vector<double> neutral_values(const ir::Field& field) const;
    /// Whether the effect is off, on any device, where what a field stores is read as that.
    bool stays_off(const ir::Field& field, const Acceptance& read) const;

private:
    const ir::Parameter& parameter_of(const evaluate::TapeInput& input) const;
    std::optional<std::size_t> find(const ir::Field& field) const;
    bool is_off(const std::vector<double>& at) const;

    const ir::Module& module_;
    const ir::Function& function_;
    evaluate::Tape tape_;
    std::vector<double> defaults_;  ///< per input of the tape
    std::vector<double> literals_;
};

/// Of every effect of a module, in its order.
std::vector<Condition> conditions_of(const ir::Module& module);

}  // namespace lobe::check
