#include "ir/insert.h"

namespace lobe::ir {
namespace {

/// New ids by old ones.
class Moved {
public:
    explicit Moved(std::vector<std::size_t> places) : places_(std::move(places)) {}

    void operator()(FunctionId& id) const
    {
        if (id.valid()) id = FunctionId{places_[id.index]};
    }

    /// The same expressions under the same ids: what was different before stays different.
    void operator()(Function& function) const
    {
        (*this)(function.form_of);
        Graph graph;
        for (const ExprId id : function.graph.ids()) {
            const Expr& expr = function.graph[id];
            const auto operands = function.graph.operands(id);
            if (expr.op != Op::call) {
                graph.copy(function.graph, id, operands);
                continue;
            }
            FunctionId callee{expr.aux};
            (*this)(callee);
            graph.set_name(graph.call(callee, expr.type, operands, function.graph.span(id)),
                           function.graph.name_of(id));
        }
        function.graph = std::move(graph);
    }

    void operator()(Model& model) const
    {
        for (ModelOutput& output : model.outputs) (*this)(output.function);
    }

    void operator()(Packing& packing) const
    {
        (*this)(packing.model);
        for (Field& field : packing.fields) {
            (*this)(field.code.encode);
            (*this)(field.code.decode);
            (*this)(field.encode);
            (*this)(field.decode);
        }
        for (auto& channel : packing.channels) (*this)(channel.pack);
        for (auto& parameter : packing.parameters) (*this)(parameter.unpack);
    }

private:
    std::vector<std::size_t> places_;
};

}  // namespace

Module insert_functions(const Module& module, const std::vector<Insertion>& insertions)
{
    Module result = without_functions(module);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        places.push_back(result.functions.size());
        result.functions.push_back(module.functions[i]);
        for (const Insertion& insertion : insertions)
            if (insertion.after == FunctionId{i}) result.functions.push_back(insertion.function);
    }
    const Moved moved{std::move(places)};
    for (Function& function : result.functions) moved(function);
    for (Effect& effect : result.effects) moved(effect.off_when);
    for (Model& model : result.models) moved(model);
    for (Packing& packing : result.packings) moved(packing);
    return result;
}

}  // namespace lobe::ir
