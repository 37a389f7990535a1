// From bodies to functions of the module: terms, forms, outputs of models, conditions of effects.
#pragma once

#include "check/draft.h"

namespace lobe::check {

/// What the later parts need of one lowered body.
struct Lowered {
    Draft draft;        ///< with all obligations
    bool good = false;  ///< false when something was reported
    std::size_t file = 0;
};

/// Lowers the body of a callable whose callees are lowered. The function is not yet entered
/// anywhere and has no range.
Lowered lower_callable(Program& program, std::size_t index, const Sources& sources,
                       Diagnostics& diagnostics);

/// One function per output of a model. Lets are shared: what is wrong with them is reported once,
/// and their obligations are those of the first output.
std::vector<Lowered> lower_model(Program& program, const ModelDeclaration& declared,
                                 const Sources& sources, Diagnostics& diagnostics);

/// The condition of an effect, over parameters alone (E0408).
Lowered lower_effect(Program& program, const syntax::EffectItem& effect, std::size_t number,
                     const Sources& sources, Diagnostics& diagnostics);

}  // namespace lobe::check
