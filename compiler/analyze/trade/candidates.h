// The ways to compute a term or a whole model: which forms, and in which spelling.
#pragma once

#include "evaluate/tape.h"
#include "ir/module.h"
#include "optimize/forms.h"
#include "optimize/spelling.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A choice of forms in a spelling, and what computes it.
struct Spelled {
    ir::Module module;  ///< through `spell`
    std::vector<ir::FunctionId> outputs;
};

/// What a trade is about: a term and its forms, or a model with all forms of its terms.
class TradeSubject {
public:
    /// A term of a checked module.
    static TradeSubject of_term(const ir::Module& checked, ir::FunctionId term);
    /// A model of a checked module, with the terms that it reaches and that have forms.
    static TradeSubject of_model(const ir::Module& checked, const ir::Model& model);

    const std::string& name() const { return name_; }
    bool is_model() const { return is_model_; }
    /// Checked, without what the subject does not need.
    const ir::Module& module() const { return module_; }
    const std::vector<ir::FunctionId>& outputs() const { return outputs_; }
    const std::vector<optimize::Alternatives>& alternatives() const { return alternatives_; }
    /// It takes directions: what it costs depends on whether they are to be made into fields.
    bool has_geometry() const;

    /// The choices of at most so many forms, fewest first: the definitions, then single forms, …
    std::vector<optimize::Choice> choices(std::size_t forms) const;
    /// How many those are.
    double combinations(std::size_t forms) const;
    /// The chosen forms before they are spelled.
    Spelled chosen(const optimize::Choice& choice) const;
    Spelled spelled(const optimize::Choice& choice, optimize::Spelling spelling) const;

private:
    std::string name_;
    bool is_model_ = false;
    ir::Module module_;
    std::vector<ir::FunctionId> outputs_;
    std::vector<optimize::Alternatives> alternatives_;
};

/// From vectors: the sum of the outputs.
evaluate::Tape tape_of(const Spelled& spelled);

}  // namespace lobe::analyze
