// A shading model as a host sees it: what it must be given, what it gives back, and its outputs
// over vectors.
#pragma once

#include "emit/listing.h"

namespace lobe::emit {

/// One member of a structure: a parameter or a field of the surface.
struct Member {
    std::string name;  ///< in the structure
    ir::Input input;   ///< as the outputs declare it
};

/// What the outputs of a model read, each once.
struct ModelInputs {
    std::vector<ir::GeometryField> geometry;  ///< in the order of the enumeration
    std::vector<Member> surface;              ///< in the order of the enumeration
    std::vector<Member> parameters;           ///< in the order of their declaration
    std::vector<ir::Input> arguments;         ///< of the model itself, beyond geometry and surface

    bool needs_tangents() const;
};
ModelInputs inputs_of(const ir::Module& module, const ir::Model& model, const Dialect& dialect);

/// A graph under construction whose inputs are texts: `surface.f0`, `Context.NoH`.
class TextGraph {
public:
    ir::Graph graph;
    std::vector<std::string> texts;

    ir::ExprId input(const std::string& text, ir::Type type);
    /// The function's result, its operands given one input at a time.
    template <class Operand>
    ir::ExprId call(const ir::Module& module, ir::FunctionId id, Operand operand)
    {
        std::vector<ir::ExprId> operands;
        for (const ir::Input& input : module[id].inputs) operands.push_back(operand(input));
        return graph.call(id, module[id].type(), operands);
    }
};

/// The members of a structure as records: type, name, value (its default), comment.
std::vector<Record> member_records(const ir::Module& module, const Dialect& dialect,
                                   const std::vector<Member>& members, bool defaults);

/// Documentation of a model as comment lines.
std::vector<Record> model_comment(const ir::Module& module, const ir::Model& model,
                                  const Listing& listing);

}  // namespace lobe::emit
