// What packings and engines are about: a model, the GBuffer of an engine, the model's parameters.
//
// A model that is imported brings its parameters along, so they are named without an import of
// their own.
#pragma once

#include "check/program.h"

namespace lobe::check {

/// The model and the gbuffer that a block names, and the parameters that the model reads.
struct Subject {
    std::size_t file = 0;  ///< of the block
    const ModelDeclaration* model = nullptr;
    const ir::Gbuffer* gbuffer = nullptr;
    std::vector<std::uint32_t> parameters;  ///< indices into Program::parameters, ascending

    std::string_view model_name() const { return model->node->name.text; }
};

/// Looks both up and notes that they are used. Nothing if either was reported, here (E0301) or
/// where it was declared.
std::optional<Subject> find_subject(Program& program, std::size_t file,
                                    const syntax::Identifier& model,
                                    const syntax::Identifier& gbuffer, Diagnostics& diagnostics);

/// The parameter of the subject's model with this name, which is used now. Nothing if it has none
/// (reported as E0301, or as `unread` where the model does not read it).
std::optional<std::uint32_t> find_parameter(Program& program, const Subject& subject,
                                            const syntax::Identifier& name, Code unread,
                                            Diagnostics& diagnostics);

}  // namespace lobe::check
