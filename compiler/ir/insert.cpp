#include "ir/insert.h"

namespace lobe::ir {
namespace {

/// New ids by old ones; no id for what is gone.
class Moved {
public:
    explicit Moved(std::vector<FunctionId> places) : places_(std::move(places)) {}

    void operator()(FunctionId& id) const
    {
        if (id.valid()) id = places_[id.index];
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

    void operator()(Shading& shading) const
    {
        (*this)(shading.model);
        (*this)(shading.light);
        (*this)(shading.function);
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

    /// Everything of the module.
    void operator()(Module& module) const
    {
        for (Function& function : module.functions) (*this)(function);
        for (Effect& effect : module.effects) (*this)(effect.off_when);
        for (Model& model : module.models) (*this)(model);
        for (Model& light : module.lights) (*this)(light);
        for (Shading& shading : module.shadings) (*this)(shading);
        for (Packing& packing : module.packings) (*this)(packing);
    }

private:
    std::vector<FunctionId> places_;
};

}  // namespace

Module insert_functions(const Module& module, const std::vector<Insertion>& insertions)
{
    Module result = without_functions(module);
    std::vector<FunctionId> places;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        places.emplace_back(result.functions.size());
        result.functions.push_back(module.functions[i]);
        for (const Insertion& insertion : insertions)
            if (insertion.after == FunctionId{i}) result.functions.push_back(insertion.function);
    }
    Moved{std::move(places)}(result);
    return result;
}

Module keep_functions(const Module& module, const std::vector<bool>& kept)
{
    Module result = without_functions(module);
    std::vector<FunctionId> places;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        places.push_back(kept[i] ? FunctionId{result.functions.size()} : FunctionId{});
        if (kept[i]) result.functions.push_back(module.functions[i]);
    }
    Moved{std::move(places)}(result);
    for (Function& function : result.functions)
        if (function.kind == Function::Kind::form && !function.form_of.valid())
            function.kind = Function::Kind::term;
    return result;
}

}  // namespace lobe::ir
